#include "core/fusion/velocity_adjustment.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

const Eigen::Vector3d kVelocity_mps(12.0, -7.0, 3.0);
constexpr double kDrift_mps = 95.0;

// The rate of a range: how fast the receiver's motion changes it, plus its clock.
std::vector<RangeRateObservation> Rates(int count, double sigma_mps = 0.2) {
  RangeScene scene;
  scene.AddSky(count);
  std::vector<RangeRateObservation> rates;
  for (const RangeObservation& range : scene.ranges) {
    RangeRateObservation rate;
    rate.direction_in_ecef = (range.point_in_ecef - scene.truth_in_ecef).normalized();
    // A second later by differences of the ranges themselves.
    constexpr double kStep_s = 1e-3;
    const double later_m =
        (range.point_in_ecef - scene.truth_in_ecef - kStep_s * kVelocity_mps).norm();
    const double earlier_m =
        (range.point_in_ecef - scene.truth_in_ecef + kStep_s * kVelocity_mps).norm();
    rate.rate_mps = (later_m - earlier_m) / (2.0 * kStep_s) + kDrift_mps;
    rate.sigma_mps = sigma_mps;
    rates.push_back(rate);
  }
  return rates;
}

struct Adjusted {
  bool good = false;
  VelocityEstimate estimate;
  std::vector<RateVerdict> verdicts;
};

Adjusted Adjust(const std::vector<RangeRateObservation>& rates) {
  Adjusted adjusted;
  adjusted.good = AdjustVelocity(rates, &adjusted.estimate, &adjusted.verdicts);
  return adjusted;
}

TEST(AdjustVelocity, FindsVelocityAndDrift) {
  for (const int count : {4, 5, 8, 20}) {
    const Adjusted adjusted = Adjust(Rates(count));
    ASSERT_TRUE(adjusted.good) << count;
    EXPECT_LT((adjusted.estimate.velocity_in_ecef_mps - kVelocity_mps).norm(), 1e-4);
    EXPECT_NEAR(adjusted.estimate.clock_drift_mps, kDrift_mps, 1e-4);
    EXPECT_EQ(adjusted.estimate.used, count);
    EXPECT_EQ(adjusted.verdicts.size(), static_cast<std::size_t>(count));
  }
}

TEST(AdjustVelocity, LeavesOutWildRates) {
  for (const double off_mps : {5.0, 40.0, -300.0, 2e4}) {
    std::vector<RangeRateObservation> rates = Rates(13);
    rates[2].rate_mps += off_mps;
    rates[6].rate_mps -= 0.7 * off_mps;
    const Adjusted adjusted = Adjust(rates);
    ASSERT_TRUE(adjusted.good) << off_mps;
    EXPECT_LT((adjusted.estimate.velocity_in_ecef_mps - kVelocity_mps).norm(), 0.05) << off_mps;
    EXPECT_LT(adjusted.verdicts[2].weight, 0.1);
    EXPECT_NEAR(adjusted.verdicts[2].residual_mps, off_mps, 0.1);
    EXPECT_EQ(adjusted.estimate.used, 11);
  }
}

TEST(AdjustVelocity, CovarianceIsTheScatter) {
  Random random(5);
  double nees = 0.0;
  constexpr int kTrials = 1000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<RangeRateObservation> rates = Rates(10);
    for (RangeRateObservation& rate : rates) rate.rate_mps += random.Gaussian(0.0, rate.sigma_mps);
    const Adjusted adjusted = Adjust(rates);
    ASSERT_TRUE(adjusted.good);
    const Eigen::Vector3d error = adjusted.estimate.velocity_in_ecef_mps - kVelocity_mps;
    nees += error.dot(adjusted.estimate.covariance_ecef_m2ps2.ldlt().solve(error)) / kTrials;
  }
  // Of three components; half as much again on the safe side is allowed.
  EXPECT_GT(nees, 2.0);
  EXPECT_LT(nees, 3.25);
}

TEST(AdjustVelocity, WidensWhereRatesScatterMoreThanStated) {
  Random random(6);
  double stated = 0.0;
  double wide = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<RangeRateObservation> rates = Rates(12);
    for (RangeRateObservation& rate : rates) rate.rate_mps += random.Gaussian(0.0, 0.2);
    stated += Adjust(rates).estimate.covariance_ecef_m2ps2.trace();
    for (RangeRateObservation& rate : rates) rate.rate_mps += random.Gaussian(0.0, 0.4);
    wide += Adjust(rates).estimate.covariance_ecef_m2ps2.trace();
  }
  EXPECT_GT(wide, 2.0 * stated);
}

TEST(AdjustVelocity, SaysWhereRatesDoNotFixIt) {
  EXPECT_FALSE(Adjust({}).good);
  EXPECT_FALSE(Adjust(Rates(3)).good);
  std::vector<RangeRateObservation> alike = Rates(8);
  for (RangeRateObservation& rate : alike) rate = alike[0];
  EXPECT_FALSE(Adjust(alike).good);
  std::vector<RangeRateObservation> nonsense = Rates(6);
  for (std::size_t i = 0; i < nonsense.size(); ++i) {
    nonsense[i].rate_mps = static_cast<double>((7919 * i) % 13) * 500.0;
  }
  EXPECT_FALSE(Adjust(nonsense).good) << "any four agree";
  std::vector<RangeRateObservation> poisoned = Rates(6);
  poisoned[1].rate_mps = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Adjust(poisoned).good);
}

}  // namespace
}  // namespace lodemark
