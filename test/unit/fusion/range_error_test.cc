#include "core/fusion/range_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kFlatReach_m = 1000.0;  // the flat part is uniform within it

std::vector<RangeErrorModel> Models() {
  std::vector<RangeErrorModel> models;
  for (const double sigma_m : {0.3, 1.0, 3.0, 10.0, 30.0, 300.0}) {
    for (const double scale_m : {8.0, 30.0, 60.0}) {
      for (const double late : {0.0, 0.05, 0.5, 0.9}) models.push_back({sigma_m, late, scale_m});
    }
  }
  return models;
}

std::string Name(const RangeErrorModel& model, double error_m) {
  return "sigma " + std::to_string(model.sigma_m) + " late " +
         std::to_string(model.late_probability) + " scale " + std::to_string(model.late_scale_m) +
         " error " + std::to_string(error_m);
}

// The density by brute force: the exponential convolved with the normal, Simpson's rule.
double ByConvolution(const RangeErrorModel& model, double error_m) {
  const auto normal = [&](double x) {
    const double u = x / model.sigma_m;
    return std::exp(-0.5 * u * u) / (model.sigma_m * std::sqrt(2.0 * kPi));
  };
  // The extra path e contributes where the noise, error_m - e, is within ten sigma.
  const double low = std::max(0.0, error_m - 10.0 * model.sigma_m);
  const double high = error_m + 10.0 * model.sigma_m;
  double late = 0.0;
  if (high > low) {
    constexpr int kIntervals = 2000;
    const double step = (high - low) / kIntervals;
    for (int i = 0; i <= kIntervals; ++i) {
      const double extra = low + i * step;
      const double factor = i == 0 || i == kIntervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      late += factor * std::exp(-extra / model.late_scale_m) * normal(error_m - extra);
    }
    late *= step / 3.0 / model.late_scale_m;
  }
  const double gross = 2.0 * kFlatReach_m * GrossErrorDensity();
  return (1.0 - gross - model.late_probability) * normal(error_m) + model.late_probability * late +
         GrossErrorDensity();
}

TEST(RangeError, DensityIsTheMixtureItSaysItIs) {
  for (const RangeErrorModel& model : Models()) {
    for (double u = -7.0; u <= 12.0; u += 0.61) {
      const double error_m = u * model.sigma_m;
      const double expected = ByConvolution(model, error_m);
      EXPECT_NEAR(RangeErrorDensity(model, error_m), expected, 1e-4 * expected)
          << Name(model, error_m);
    }
  }
}

TEST(RangeError, DensityIntegratesToOne) {
  for (const RangeErrorModel& model : Models()) {
    if (model.sigma_m > 100.0) continue;  // reaches beyond the flat part
    const double step_m = 0.02 * model.sigma_m;
    double sum = 0.0;
    for (double error_m = -kFlatReach_m; error_m < kFlatReach_m; error_m += step_m) {
      sum += step_m * RangeErrorDensity(model, error_m);
    }
    EXPECT_NEAR(sum, 1.0, 2e-5) << Name(model, 0.0);
  }
}

TEST(RangeError, SlopeIsTheDerivativeOfTheLogarithm) {
  for (const RangeErrorModel& model : Models()) {
    const double step_m = 1e-3 * model.sigma_m;
    for (double u = -8.0; u <= 30.0; u += 0.37) {
      const double error_m = u * model.sigma_m;
      const double slope_pm = EvaluateRangeError(model, error_m).slope_pm;
      const double numeric_pm = -(std::log(RangeErrorDensity(model, error_m + step_m)) -
                                  std::log(RangeErrorDensity(model, error_m - step_m))) /
                                (2.0 * step_m);
      EXPECT_NEAR(slope_pm, numeric_pm, 1e-3 / model.sigma_m) << Name(model, error_m);
    }
  }
}

TEST(RangeError, SharesAndTheFlatRestAreAllThereIs) {
  for (const RangeErrorModel& model : Models()) {
    for (double error_m = -900.0; error_m <= 900.0; error_m += 13.7) {
      const RangeErrorTerms terms = EvaluateRangeError(model, error_m);
      const double gross_share = GrossErrorDensity() / terms.density_pm;
      EXPECT_NEAR(terms.core_share + terms.late_share + gross_share, 1.0, 1e-12);
      EXPECT_GE(terms.core_share, 0.0);
      EXPECT_GE(terms.late_share, 0.0);
      EXPECT_EQ(terms.density_pm, RangeErrorDensity(model, error_m));
    }
  }
}

TEST(RangeError, IsSymmetricWithoutReflections) {
  const RangeErrorModel model = {4.0, 0.0, 30.0};
  for (double error_m = 0.0; error_m < 100.0; error_m += 0.7) {
    const RangeErrorTerms late = EvaluateRangeError(model, error_m);
    const RangeErrorTerms early = EvaluateRangeError(model, -error_m);
    EXPECT_DOUBLE_EQ(late.density_pm, early.density_pm);
    EXPECT_DOUBLE_EQ(late.slope_pm, -early.slope_pm);
    EXPECT_EQ(late.late_share, 0.0);
  }
}

TEST(RangeError, LateErrorsAreMoreProbableThanEarlyOnes) {
  for (const RangeErrorModel& model : Models()) {
    if (model.late_probability == 0.0) continue;
    for (double u = 0.5; u < 6.0; u += 0.5) {
      const double error_m = u * model.sigma_m;
      EXPECT_GT(RangeErrorDensity(model, error_m), RangeErrorDensity(model, -error_m))
          << Name(model, error_m);
    }
  }
}

TEST(RangeError, FarAwayNothingPulls) {
  const RangeErrorModel model = {3.0, 0.3, 20.0};
  for (const double error_m : {-5e2, -1e5, -1e12, 2e3, 1e5, 1e12}) {
    const RangeErrorTerms terms = EvaluateRangeError(model, error_m);
    EXPECT_NEAR(terms.density_pm, GrossErrorDensity(), 1e-9);
    EXPECT_NEAR(terms.slope_pm, 0.0, 1e-9);
    EXPECT_LT(terms.core_share, 1e-6);
  }
}

// Drawn errors fall into each bin as often as the density says: a chi-square test.
TEST(RangeError, IsTheDensityOfDrawnErrors) {
  const RangeErrorModel model = {3.0, 0.4, 25.0};
  constexpr int kDraws = 200'000;
  constexpr int kBins = 60;
  constexpr double kLow_m = -10.0;
  constexpr double kWidth_m = 2.0;
  Random random(7);
  std::vector<double> found(kBins, 0.0);
  const double gross = 2.0 * kFlatReach_m * GrossErrorDensity();
  for (int i = 0; i < kDraws; ++i) {
    const double lot = random.Uniform();
    double error_m = random.Gaussian(0.0, model.sigma_m);
    if (lot < gross) {
      error_m = random.Uniform(-kFlatReach_m, kFlatReach_m);
    } else if (lot < gross + model.late_probability) {
      error_m += random.Exponential(model.late_scale_m);
    }
    const double bin = std::floor((error_m - kLow_m) / kWidth_m);
    if (bin >= 0.0 && bin < kBins) ++found[static_cast<std::size_t>(bin)];
  }
  double chi_square = 0.0;
  for (int b = 0; b < kBins; ++b) {
    double expected = 0.0;
    for (int s = 0; s < 100; ++s) {
      expected += RangeErrorDensity(model, kLow_m + kWidth_m * (b + (s + 0.5) / 100.0));
    }
    expected *= kDraws * kWidth_m / 100.0;
    const double off = found[static_cast<std::size_t>(b)] - expected;
    chi_square += off * off / expected;
  }
  EXPECT_LT(chi_square, 99.6);  // 99.9 % of 60 degrees of freedom
}

}  // namespace
}  // namespace lodemark
