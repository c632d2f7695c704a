// Errors drawn from the model itself, again and again: what is stated of them must hold.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/adjustment/distributions.h"
#include "core/fusion/point_adjustment.h"
#include "test/unit/fusion/adjusted.h"

namespace lodemark {
namespace {

constexpr int kTrials = 800;

struct Mixture {
  RangeErrorModel error;
  double gross_probability = 0.0;
  int systems = 1;
  bool biases_known = true;
  double integrity_risk = 1e-5;
};

struct Found {
  double nees = 0.0;          // mean over the trials, of three components
  double within_68 = 0.0;     // share of horizontal errors inside the 68 % ellipse
  double beyond_level = 0.0;  // share outside the protection level
  double median_level_m = 0.0;
  double rms_m = 0.0;
  int solved = 0;
};

// A new sky and new errors in every trial.
Found Simulate(const Mixture& mixture) {
  Random random(2024);
  PointAdjustment adjustment;
  PointEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  PointOptions options;
  options.integrity_risk = mixture.integrity_risk;
  Found found;
  const double quantile_68 = ChiSquareQuantile(0.68, 2.0);
  std::vector<double> levels_m;
  for (int trial = 0; trial < kTrials; ++trial) {
    RangeScene scene;
    ClockBiases biases;
    for (int i = 0; i < 12; ++i) {
      const int group = i % mixture.systems;
      const double bias_m = -300.0 * group;
      scene.AddSatellite(30.0 * i + random.Uniform(-15.0, 15.0),
                         i % 3 == 0 ? random.Uniform(40.0, 90.0) : random.Uniform(10.0, 60.0),
                         group, kClock_m + bias_m, mixture.error);
      scene.ranges.back().range_m += DrawError(mixture.error, mixture.gross_probability, &random);
      if (mixture.biases_known) biases.Set(group, {bias_m + random.Gaussian(0.0, 1.0), 1.0});
    }
    const PointStatus status = adjustment.Solve(scene.ranges, scene.Beside({300.0, 200.0, 100.0}),
                                                biases, options, &estimate, &verdicts);
    if (status != PointStatus::kGood) continue;
    ++found.solved;
    const Eigen::Vector3d error = scene.ErrorInEnu(estimate.position_in_ecef);
    found.nees += error.dot(estimate.covariance_enu_m2.ldlt().solve(error));
    const Eigen::Matrix2d horizontal = estimate.covariance_enu_m2.topLeftCorner<2, 2>();
    const Eigen::Vector2d plan = error.head<2>();
    if (plan.dot(horizontal.ldlt().solve(plan)) < quantile_68) found.within_68 += 1.0;
    if (plan.norm() > estimate.protection_level_m) found.beyond_level += 1.0;
    found.rms_m += plan.squaredNorm();
    levels_m.push_back(estimate.protection_level_m);
  }
  found.nees /= found.solved;
  found.within_68 /= found.solved;
  found.beyond_level /= found.solved;
  found.rms_m = std::sqrt(found.rms_m / found.solved);
  std::sort(levels_m.begin(), levels_m.end());
  found.median_level_m = levels_m[levels_m.size() / 2];
  return found;
}

// Half-width of the 99.9 % band of a mean of chi-square values with three degrees of freedom. Which
// numbers are drawn depends on the order in which a compiler evaluates arguments.
double NeesBand(int trials) { return 3.29 * std::sqrt(6.0 / trials); }

// Half-width of the 99.9 % band of a share.
double ShareBand(double share, int trials) {
  return 3.29 * std::sqrt(share * (1.0 - share) / trials);
}

TEST(PointAdjustmentConsistency, NormalErrorsScatterAsTheCovarianceSays) {
  const Found found = Simulate({{4.0, 0.0, 30.0}});
  ASSERT_EQ(found.solved, kTrials);
  EXPECT_NEAR(found.nees, 3.0, NeesBand(kTrials));
  EXPECT_NEAR(found.within_68, 0.68, ShareBand(0.68, kTrials));
}

TEST(PointAdjustmentConsistency, HoldsWithBiasesKnownAndNot) {
  for (const bool known : {true, false}) {
    Mixture mixture = {{4.0, 0.0, 30.0}};
    mixture.systems = 3;
    mixture.biases_known = known;
    const Found found = Simulate(mixture);
    ASSERT_EQ(found.solved, kTrials);
    EXPECT_NEAR(found.nees, 3.0, NeesBand(kTrials)) << known;
    EXPECT_NEAR(found.within_68, 0.68, ShareBand(0.68, kTrials)) << known;
  }
}

// Reflections widen the covariance by up to 1 + 3 times their share beyond what independent errors
// ask for, since real ones come in families: safe, and not more than that.
TEST(PointAdjustmentConsistency, MixturesScatterLessThanTheCovarianceSaysAndNotMuchLess) {
  for (const double late : {0.1, 0.3, 0.5}) {
    for (const int systems : {1, 3}) {
      Mixture mixture = {{4.0, late, 30.0}, 0.005};
      mixture.systems = systems;
      const Found found = Simulate(mixture);
      EXPECT_GE(found.solved, 0.99 * kTrials);
      const double widest = 1.0 + 3.0 * late;
      EXPECT_LT(found.nees, 3.0 + NeesBand(found.solved)) << late << " " << systems;
      EXPECT_GT(found.nees, 3.0 / widest - NeesBand(found.solved)) << late << " " << systems;
      EXPECT_GT(found.within_68, 0.68 - ShareBand(0.68, found.solved)) << late << " " << systems;
    }
  }
}

// Four ranges a system, none of whose biases is known, and every third range late: too little to
// tell them apart. The sampling holds the differences of the clocks and so sees one peak of
// several; the share inside the 68 % ellipse falls, and this is how far.
TEST(PointAdjustmentConsistency, UnknownBiasesAmongReflectionsCostSomeHonesty) {
  Mixture mixture = {{4.0, 0.3, 30.0}, 0.005};
  mixture.systems = 3;
  mixture.biases_known = false;
  EXPECT_GT(Simulate(mixture).within_68, 0.58);
}

TEST(PointAdjustmentConsistency, ProtectionLevelsAreExceededLessThanAllowed) {
  constexpr double kRisk = 0.01;
  for (const double late : {0.0, 0.1, 0.3, 0.5}) {
    Mixture mixture = {{4.0, late, 30.0}, 0.005};
    mixture.integrity_risk = kRisk;
    const Found found = Simulate(mixture);
    EXPECT_LE(found.beyond_level, kRisk) << late;
    EXPECT_LT(found.median_level_m, 12.0 * found.rms_m) << "a bound that bounds nothing";
  }
}

}  // namespace
}  // namespace lodemark
