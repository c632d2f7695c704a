#include "core/session/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

const EnuFrame kFrame({0.8, 0.3, 150.0});

SessionEstimate FixAt(double time_s, const Eigen::Vector3d& place_in_enu, double sigma_m) {
  SessionEstimate estimate;
  estimate.status = EstimateStatus::kFix;
  estimate.time_ns = std::llround(time_s * 1e9);
  estimate.position_in_ecef = kFrame.ToEcef(place_in_enu);
  estimate.position = GeodeticFromEcef(estimate.position_in_ecef);
  estimate.covariance_enu_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  return estimate;
}

void LearnPlace(double time_s, const Eigen::Vector3d& place_in_enu, double sigma_m,
                Motion* motion) {
  motion->LearnPlace(std::llround(time_s * 1e9), kFrame.ToEcef(place_in_enu),
                     sigma_m * sigma_m * Eigen::Matrix3d::Identity());
}

Eigen::Vector3d MovedInEnu(const Displacement& moved) {
  return EnuFromEcefRotation({0.8, 0.3, 150.0}) * moved.in_ecef_m;
}

std::int64_t Nanoseconds(double time_s) { return std::llround(time_s * 1e9); }

TEST(Motion, WithoutAVelocityItMayBeACar) {
  const Displacement moved = Motion().Between(0, Nanoseconds(0.5));
  EXPECT_EQ(moved.in_ecef_m, Eigen::Vector3d::Zero());
  // 50 km/h across half a second are within two sigmas.
  EXPECT_GT(2.0 * std::sqrt(moved.covariance_enu_m2(0, 0)), 50.0 / 3.6 * 0.5);
}

TEST(Motion, CarriesDopplersVelocityOnAndForgetsItInSeconds) {
  Motion motion;
  SessionEstimate estimate = FixAt(10.0, {0, 0, 0}, 5.0);
  estimate.has_velocity = true;
  estimate.velocity_enu_mps = {3.0, -4.0, 0.5};
  estimate.velocity_covariance_enu_m2ps2 = 0.01 * Eigen::Matrix3d::Identity();
  motion.Learn(estimate);
  const Displacement soon = motion.Between(Nanoseconds(10.0), Nanoseconds(10.4));
  EXPECT_NEAR((MovedInEnu(soon) - Eigen::Vector3d(1.2, -1.6, 0.2)).norm(), 0.0, 1e-6);
  EXPECT_LT(std::sqrt(soon.covariance_enu_m2(0, 0)), 0.4 * 0.5);
  const Displacement back = motion.Between(Nanoseconds(10.0), Nanoseconds(9.6));
  EXPECT_NEAR((MovedInEnu(back) + MovedInEnu(soon)).norm(), 0.0, 1e-6);
  const Displacement late = motion.Between(Nanoseconds(17.0), Nanoseconds(17.4));
  EXPECT_EQ(late.in_ecef_m, Eigen::Vector3d::Zero());
}

TEST(Motion, TwoPhotographsMakeAVelocity) {
  Motion motion;
  LearnPlace(20.0, {0, 0, 0}, 0.3, &motion);
  LearnPlace(21.0, {9.0, 2.0, 0.0}, 0.3, &motion);
  const Displacement moved = motion.Between(Nanoseconds(21.0), Nanoseconds(21.1));
  EXPECT_NEAR((MovedInEnu(moved) - Eigen::Vector3d(0.9, 0.2, 0.0)).norm(), 0.0, 1e-3);
  // Two places of 0.3 m, a second apart, and what changed since their middle.
  const double expected_mps = std::sqrt(2 * 0.3 * 0.3 + 0.5 * 0.5 + 0.1 * 0.1);
  EXPECT_NEAR(std::sqrt(moved.covariance_enu_m2(0, 0)), 0.1 * expected_mps, 1e-9);
}

TEST(Motion, KeepsDopplerForTwoSeconds) {
  Motion motion;
  SessionEstimate doppler = FixAt(21.0, {0, 0, 0}, 5.0);
  doppler.has_velocity = true;
  doppler.velocity_enu_mps = {1.0, 0.0, 0.0};
  doppler.velocity_covariance_enu_m2ps2 = 0.01 * Eigen::Matrix3d::Identity();
  motion.Learn(doppler);
  LearnPlace(21.5, {0, 0, 0}, 0.1, &motion);
  LearnPlace(22.5, {8.0, 0, 0}, 0.1, &motion);
  EXPECT_NEAR(MovedInEnu(motion.Between(Nanoseconds(22.5), Nanoseconds(22.6))).x(), 0.1, 1e-6);
  LearnPlace(23.5, {16.0, 0, 0}, 0.1, &motion);
  EXPECT_NEAR(MovedInEnu(motion.Between(Nanoseconds(23.5), Nanoseconds(23.6))).x(), 0.8, 1e-4);
}

// Two photographs that hardly know where they are say less than a velocity of a second ago.
TEST(Motion, TakesNoWorseVelocityFromPhotographs) {
  Motion motion;
  LearnPlace(20.0, {0, 0, 0}, 0.1, &motion);
  LearnPlace(21.0, {5.0, 0, 0}, 0.1, &motion);
  LearnPlace(22.0, {30.0, 0, 0}, 9.0, &motion);
  EXPECT_NEAR(MovedInEnu(motion.Between(Nanoseconds(22.0), Nanoseconds(22.1))).x(), 0.5, 1e-4);
}

TEST(Motion, PlacesTooNearOrTooFarInTimeMakeNone) {
  for (const double apart_s : {0.05, 6.0}) {
    Motion motion;
    LearnPlace(20.0, {0, 0, 0}, 0.1, &motion);
    LearnPlace(20.0 + apart_s, {1.0, 0, 0}, 0.1, &motion);
    const double now_s = 20.0 + apart_s;
    EXPECT_EQ(motion.Between(Nanoseconds(now_s), Nanoseconds(now_s + 0.1)).in_ecef_m,
              Eigen::Vector3d::Zero());
  }
}

// Of a car whose speed wanders by 1 m/s in a second, what is said of the next half second holds.
TEST(Motion, ItsCovarianceHolds) {
  Random random(7);
  double squares = 0.0;
  constexpr int kDraws = 2'000;
  for (int i = 0; i < kDraws; ++i) {
    Motion motion;
    const Eigen::Vector2d start_mps(random.Gaussian(10.0, 3.0), random.Gaussian(0.0, 3.0));
    const Eigen::Vector2d change_mps2(random.Gaussian(0.0, 1.0), random.Gaussian(0.0, 1.0));
    const auto place = [&](double time_s) -> Eigen::Vector3d {
      const Eigen::Vector2d at = start_mps * time_s + 0.5 * time_s * time_s * change_mps2;
      return {at.x(), at.y(), 0.0};
    };
    for (const double time_s : {0.0, 1.0}) {
      Eigen::Vector3d fixed = place(time_s);
      for (int k = 0; k < 3; ++k) fixed[k] += random.Gaussian(0.0, 0.5);
      LearnPlace(time_s, fixed, 0.5, &motion);
    }
    const Displacement moved = motion.Between(Nanoseconds(1.0), Nanoseconds(1.5));
    const Eigen::Vector2d error = (MovedInEnu(moved) - (place(1.5) - place(1.0))).head<2>();
    const Eigen::Matrix2d covariance = moved.covariance_enu_m2.topLeftCorner<2, 2>();
    squares += error.dot(covariance.inverse() * error) / 2.0;
  }
  EXPECT_GT(squares / kDraws, 0.5);
  EXPECT_LT(squares / kDraws, 1.2);
}

}  // namespace
}  // namespace lodemark
