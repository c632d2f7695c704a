#include "core/fusion/motion_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "test/unit/fusion/motion_scene.h"

namespace lodemark::test {
namespace {

const Eigen::Matrix3d kSmall_m2 = 1e-6 * Eigen::Matrix3d::Identity();

MotionFilter StartedAt(const Eigen::Matrix3d& covariance_enu_m2) {
  MotionFilter filter;
  filter.Start(MotionStart(), covariance_enu_m2);
  return filter;
}

// One that knows its velocity to some centimetres a second.
MotionFilter Driving(const Eigen::Vector3d& velocity_mps) {
  MotionFilter filter = StartedAt(Eigen::Vector3d(4.0, 4.0, 9.0).asDiagonal());
  Random random(3);
  MotionVerdicts verdicts;
  filter.Advance(1.0, RatesOf(SkyDirections(12), velocity_mps, 80.0, 0.05, 0.5, &random), {},
                 MotionModel(), &verdicts);
  return filter;
}

double Sigma(const MotionFilter& filter) { return std::sqrt(filter.PositionCovarianceEnu()(0, 0)); }

TEST(MotionFilter, AloneItGrowsAsWhiteAccelerationDoes) {
  const MotionModel model{{1.3, 0.7, 0.05}};
  MotionVerdicts verdicts;
  for (const double seconds : {0.02, 1.0, 30.0}) {
    MotionFilter filter = Driving({8.0, -3.0, 1.0});
    const MotionVector before = StateOf(filter);
    const MotionMatrix transition = MotionTransition(seconds);
    const MotionMatrix expected =
        transition * CovarianceOf(filter) * transition.transpose() + MotionNoise(model, seconds);
    filter.Advance(seconds, {}, {}, model, &verdicts);
    EXPECT_LT((StateOf(filter) - transition * before).norm(), 1e-5);
    EXPECT_TRUE(CovarianceOf(filter).isApprox(expected, 1e-4)) << seconds;
    EXPECT_FALSE(verdicts.rates_agree);
    EXPECT_FALSE(verdicts.changes_agree);
  }
}

TEST(MotionFilter, TwoStepsAreOneOfTheirLength) {
  MotionVerdicts verdicts;
  MotionFilter once = Driving({8.0, -3.0, 1.0});
  MotionFilter twice = once;
  once.Advance(3.0, {}, {}, MotionModel(), &verdicts);
  twice.Advance(1.2, {}, {}, MotionModel(), &verdicts);
  twice.Advance(1.8, {}, {}, MotionModel(), &verdicts);
  EXPECT_LT((StateOf(once) - StateOf(twice)).norm(), 1e-5);
  EXPECT_TRUE(CovarianceOf(once).isApprox(CovarianceOf(twice), 1e-4));
}

// A circle of 20 m at 2 m/s, which no model of straight motion foresees.
Eigen::Vector3d OnCircle(double seconds) {
  const Eigen::Vector3d enu_m(20.0 * std::sin(0.1 * seconds), 20.0 - 20.0 * std::cos(0.1 * seconds),
                              0.0);
  return MotionStart() + EcefFromEnu() * enu_m;
}

TEST(MotionFilter, PhaseAloneCarriesAPlaceForAMinuteToCentimetres) {
  Random random(11);
  const std::vector<Eigen::Vector3d> sky = SkyDirections(10);
  MotionVerdicts verdicts;
  MotionFilter filter = StartedAt(kSmall_m2);
  for (int second = 1; second <= 60; ++second) {
    const Eigen::Vector3d moved_m = OnCircle(second) - OnCircle(second - 1);
    filter.Advance(1.0, {}, ChangesOf(sky, moved_m, 75.0, 0.008, 1.0, &random), MotionModel(),
                   &verdicts);
    ASSERT_TRUE(verdicts.changes_agree);
  }
  const Eigen::Vector3d off_m =
      EcefFromEnu().transpose() * (filter.position_in_ecef() - OnCircle(60.0));
  // Sixty independent displacements of about the noise of one phase.
  EXPECT_LT(off_m.head<2>().norm(), 0.15);
  EXPECT_LT(Sigma(filter), 0.07);
  EXPECT_GT(Sigma(filter), 0.02);
}

TEST(MotionFilter, OneSlippedPhaseMovesItByLessThanASigma) {
  const std::vector<Eigen::Vector3d> sky = SkyDirections(9);
  const Eigen::Vector3d velocity_mps(8.0, -3.0, 1.0);
  MotionVerdicts verdicts;
  for (const double slip_m : {0.095, 0.19, -0.57, 5.0, -4e4}) {
    MotionFilter whole = Driving(velocity_mps);
    MotionFilter slipped = whole;
    Random random(5);
    std::vector<RangeChangeObservation> changes =
        ChangesOf(sky, velocity_mps, 75.0, 0.01, 0.7, &random);
    whole.Advance(1.0, {}, changes, MotionModel(), &verdicts);
    changes[4].change_m += slip_m;
    slipped.Advance(1.0, {}, changes, MotionModel(), &verdicts);
    EXPECT_TRUE(verdicts.changes_agree);
    EXPECT_LT(verdicts.changes[4].weight, 0.1) << slip_m;
    EXPECT_NEAR(verdicts.changes[4].residual, slip_m, 0.05);
    // The displacement's own sigma is near a phase's.
    EXPECT_LT((slipped.position_in_ecef() - whole.position_in_ecef()).norm(), 0.02) << slip_m;
  }
}

TEST(MotionFilter, OneFalseRateMovesItByLessThanASigma) {
  const std::vector<Eigen::Vector3d> sky = SkyDirections(9);
  const Eigen::Vector3d velocity_mps(8.0, -3.0, 1.0);
  MotionVerdicts verdicts;
  for (const double false_mps : {1.0, -5.0, 60.0, -3e4}) {
    MotionFilter whole = Driving(velocity_mps);
    MotionFilter misled = whole;
    Random random(5);
    std::vector<RangeRateObservation> rates = RatesOf(sky, velocity_mps, 80.0, 0.1, 0.7, &random);
    whole.Advance(1.0, rates, {}, MotionModel(), &verdicts);
    rates[4].rate_mps += false_mps;
    misled.Advance(1.0, rates, {}, MotionModel(), &verdicts);
    EXPECT_TRUE(verdicts.rates_agree);
    EXPECT_LT(verdicts.rates[4].weight, 0.1);
    const double sigma_mps = std::sqrt(whole.VelocityCovarianceEnu().trace());
    EXPECT_LT((misled.velocity_in_ecef_mps() - whole.velocity_in_ecef_mps()).norm(), sigma_mps);
    EXPECT_NEAR(misled.clock_drift_mps(), 80.0, 0.5);
  }
}

TEST(MotionFilter, PhasesThatAgreeOnNothingAreAsGoodAsNone) {
  const std::vector<Eigen::Vector3d> sky = SkyDirections(10);
  const Eigen::Vector3d velocity_mps(8.0, -3.0, 1.0);
  Random random(8);
  MotionVerdicts verdicts;
  MotionFilter with = Driving(velocity_mps);
  MotionFilter without = with;
  const std::vector<RangeRateObservation> rates =
      RatesOf(sky, velocity_mps, 80.0, 0.05, 1.0, &random);
  std::vector<RangeChangeObservation> changes =
      ChangesOf(sky, velocity_mps, 75.0, 0.01, 1.0, &random);
  for (RangeChangeObservation& change : changes) change.change_m += random.Uniform(-40.0, 40.0);
  with.Advance(1.0, rates, changes, MotionModel(), &verdicts);
  EXPECT_FALSE(verdicts.changes_agree);
  EXPECT_TRUE(verdicts.rates_agree);
  for (const MotionVerdict& verdict : verdicts.changes) EXPECT_EQ(verdict.weight, 0.0);
  without.Advance(1.0, rates, {}, MotionModel(), &verdicts);
  EXPECT_EQ(StateOf(with), StateOf(without));
  EXPECT_EQ(CovarianceOf(with), CovarianceOf(without));
}

TEST(MotionFilter, TwoSatellitesHelpWithTheirRatesAndNeverBreakIt) {
  const Eigen::Vector3d velocity_mps(8.0, -3.0, 1.0);
  const std::vector<Eigen::Vector3d> two = {SkyDirections(10)[0], SkyDirections(10)[1]};
  Random random(8);
  MotionVerdicts verdicts;
  MotionFilter with = Driving(velocity_mps);
  MotionFilter without = with;
  Eigen::Vector3d place = with.position_in_ecef();
  for (int second = 0; second < 20; ++second) {
    place += velocity_mps;
    // Their phases alone could not show a slip: they stay unused, and so does a false one.
    std::vector<RangeChangeObservation> changes =
        ChangesOf(two, velocity_mps, 75.0, 0.01, 1.0, &random);
    changes[0].change_m += 30.0;
    with.Advance(1.0, RatesOf(two, velocity_mps, 80.0, 0.05, 1.0, &random), changes, MotionModel(),
                 &verdicts);
    EXPECT_FALSE(verdicts.changes_agree);
    without.Advance(1.0, {}, {}, MotionModel(), &verdicts);
  }
  const Eigen::Vector3d between = (two[0] - two[1]).normalized();
  const MotionMatrix known = CovarianceOf(with);
  const MotionMatrix unknown = CovarianceOf(without);
  EXPECT_LT(between.dot(known.topLeftCorner<3, 3>() * between),
            0.01 * between.dot(unknown.topLeftCorner<3, 3>() * between));
  const Eigen::Vector3d off_m = with.position_in_ecef() - place;
  EXPECT_LT(std::abs(between.dot(off_m)),
            4.0 * std::sqrt(between.dot(known.topLeftCorner<3, 3>() * between)));
  EXPECT_GT(Eigen::LLT<MotionMatrix>(known).matrixLLT().diagonal().minCoeff(), 0.0);
}

TEST(MotionFilter, WhatOneAxisIsToldTheOthersDoNotHear) {
  MotionFilter filter = StartedAt(Eigen::Vector3d(4.0, 9.0, 25.0).asDiagonal());
  filter.Hear(StatedAt(filter, MotionStart() + EcefFromEnu() * Eigen::Vector3d(3.0, 50.0, -70.0),
                       Eigen::Vector3d(0.25, 0.0, 0.0).asDiagonal()));
  const Eigen::Vector3d moved_m =
      EcefFromEnu().transpose() * (filter.position_in_ecef() - MotionStart());
  EXPECT_TRUE(moved_m.isApprox(Eigen::Vector3d(1.5, 0.0, 0.0), 1e-6)) << moved_m.transpose();
  const Eigen::Matrix3d expected = Eigen::Vector3d(2.0, 9.0, 25.0).asDiagonal();
  EXPECT_TRUE(filter.PositionCovarianceEnu().isApprox(expected, 1e-6));
}

TEST(MotionFilter, HearingTwoStatementsIsTheirWeightedMean) {
  const Eigen::Matrix3d prior = Eigen::Vector3d(4.0, 9.0, 25.0).asDiagonal();
  Eigen::Matrix3d first;
  first << 0.5, 0.1, 0.0, 0.1, 0.3, -0.05, 0.0, -0.05, 0.2;
  const Eigen::Matrix3d second = Eigen::Vector3d(0.02, 0.7, 0.1).asDiagonal();
  const Eigen::Vector3d first_enu_m(3.0, -2.0, 5.0);
  const Eigen::Vector3d second_enu_m(-4.0, 1.0, 2.0);
  MotionFilter filter = StartedAt(prior);
  MotionFilter at_once = filter;
  at_once.Hear(Together(StatedAt(filter, MotionStart() + EcefFromEnu() * first_enu_m, first),
                        StatedAt(filter, MotionStart() + EcefFromEnu() * second_enu_m, second)));
  filter.Hear(StatedAt(filter, MotionStart() + EcefFromEnu() * first_enu_m, first));
  filter.Hear(StatedAt(filter, MotionStart() + EcefFromEnu() * second_enu_m, second));
  const Eigen::Matrix3d covariance = (prior.inverse() + first + second).inverse();
  const Eigen::Vector3d mean = covariance * (first * first_enu_m + second * second_enu_m);
  for (const MotionFilter& heard : {filter, at_once}) {
    const Eigen::Vector3d moved_m =
        EcefFromEnu().transpose() * (heard.position_in_ecef() - MotionStart());
    EXPECT_LT((moved_m - mean).norm(), 1e-5);
    EXPECT_TRUE(heard.PositionCovarianceEnu().isApprox(covariance, 1e-5));
  }
}

TEST(MotionFilter, ItsPlaceIsAStatementOfItself) {
  MotionFilter filter = Driving({8.0, -3.0, 1.0});
  const PositionStatement place = filter.Place();
  EXPECT_EQ(place.around_in_ecef, filter.position_in_ecef());
  EXPECT_EQ(place.pull_pm, Eigen::Vector3d::Zero());
  const Eigen::Matrix3d identity = place.information_pm2 * filter.PositionCovarianceEnu();
  EXPECT_TRUE(identity.isIdentity(1e-9));
}

}  // namespace
}  // namespace lodemark::test
