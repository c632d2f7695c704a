#include "core/fusion/density_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/fusion/range_error.h"

namespace lodemark {
namespace {

// Where the tail is cut: six late scales and six sigma behind zero.
double EndOf(const RangeErrorModel& model) {
  return 6.0 * model.sigma_m + 6.0 * model.late_scale_m;
}

void ForEveryModel(void (*check)(const RangeErrorModel&, const DensityTable&)) {
  DensityTable table;
  for (double sigma_m = 0.3; sigma_m <= 30.0; sigma_m *= 1.47) {
    for (const double scale_m : {8.0, 15.0, 30.0, 60.0}) {
      for (const double late : {0.0, 0.01, 0.3, 0.9}) {
        const RangeErrorModel model = {sigma_m, late, scale_m};
        table.Fill(model);
        check(model, table);
      }
    }
  }
}

// A chord of a normal density over a quarter sigma is off by 0.8 % at the top.
TEST(DensityTable, IsTheDensityWithinAHundredthOfItsPeak) {
  ForEveryModel([](const RangeErrorModel& model, const DensityTable& table) {
    double peak = 0.0;
    double worst = 0.0;
    for (double error_m = -8.0 * model.sigma_m; error_m < EndOf(model);
         error_m += 0.05 * model.sigma_m) {
      const double density = RangeErrorDensity(model, error_m);
      peak = std::max(peak, density);
      const auto tabulated = static_cast<double>(table(static_cast<float>(error_m)));
      worst = std::max(worst, std::abs(tabulated - density));
    }
    EXPECT_LT(worst, 0.01 * peak) << model.sigma_m << " " << model.late_probability << " "
                                  << model.late_scale_m;
  });
}

// Weights are products of densities, so the ratio counts, in the core and along the tail. The
// chord's ratio grows with the square of the distance: 12 % at 4 sigma, a sixth at 5.
TEST(DensityTable, IsTheDensityWithinASixthUpToTheEndOfTheTail) {
  ForEveryModel([](const RangeErrorModel& model, const DensityTable& table) {
    double worst = 0.0;
    for (double error_m = -5.0 * model.sigma_m; error_m < 0.96 * EndOf(model);
         error_m += 0.05 * model.sigma_m) {
      const double density = RangeErrorDensity(model, error_m);
      const auto tabulated = static_cast<double>(table(static_cast<float>(error_m)));
      worst = std::max(worst, std::abs(tabulated / density - 1.0));
    }
    EXPECT_LT(worst, 0.18) << model.sigma_m << " " << model.late_probability << " "
                           << model.late_scale_m;
  });
}

TEST(DensityTable, IsFlatBeyondItsEnds) {
  ForEveryModel([](const RangeErrorModel& model, const DensityTable& table) {
    const auto flat = static_cast<float>(GrossErrorDensity());
    for (const double error_m : {-1e9, -1e4, -6.01 * model.sigma_m, EndOf(model) + 1.0, 1e4, 1e9}) {
      EXPECT_EQ(table(static_cast<float>(error_m)), flat) << error_m;
    }
  });
}

TEST(DensityTable, IsNeverBelowTheFlatPart) {
  ForEveryModel([](const RangeErrorModel& model, const DensityTable& table) {
    for (double error_m = -8.0 * model.sigma_m; error_m < EndOf(model) + 10.0;
         error_m += 0.31 * model.sigma_m) {
      EXPECT_GE(table(static_cast<float>(error_m)),
                0.999f * static_cast<float>(GrossErrorDensity()));
    }
  });
}

}  // namespace
}  // namespace lodemark
