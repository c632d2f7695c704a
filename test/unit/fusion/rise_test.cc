#include "core/fusion/rise.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "test/unit/fusion/motion_scene.h"

namespace lodemark::test {
namespace {

const Eigen::Vector3d Up() { return EcefFromEnu().col(2); }

StepKnowledge Known() {
  StepKnowledge known;
  known.mean << EcefFromEnu() * Eigen::Vector3d(9.0, -4.0, 0.3),
      EcefFromEnu() * Eigen::Vector3d(9.5, -4.2, 0.2);
  StepMatrix root;
  Random random(2);
  for (int i = 0; i < 36; ++i) root.data()[i] = random.Gaussian();
  known.covariance = root * root.transpose() + 0.1 * StepMatrix::Identity();
  return known;
}

TEST(Rise, IsHeardAsTheSumOfInformationSays) {
  const StepKnowledge known = Known();
  StepKnowledge heard = known;
  const Rise rise = {1.1, 0.4};
  const double square = HearRise(rise, Up(), &heard);
  StepVector slope = StepVector::Zero();
  slope.head<3>() = Up();
  const StepMatrix information =
      known.covariance.inverse() + slope * slope.transpose() / (rise.sigma_m * rise.sigma_m);
  EXPECT_TRUE(heard.covariance.isApprox(information.inverse(), 1e-9));
  // 9.8 m along the ground: the earth falls away by 8 micrometres.
  const StepVector right = known.covariance.inverse() * known.mean +
                           slope * (rise.rise_m / (rise.sigma_m * rise.sigma_m));
  EXPECT_LT((heard.mean - information.inverse() * right).norm(), 2e-5);
  const double expected_m2 = slope.dot(known.covariance * slope) + rise.sigma_m * rise.sigma_m;
  EXPECT_NEAR(square, std::pow(rise.rise_m - 0.3, 2) / expected_m2, 1e-4);
}

TEST(Rise, FollowsTheCurvedEarth) {
  StepKnowledge known;
  // 5 km to the north of a place, at the same height.
  Geodetic there = kMotionPlace;
  there.latitude_rad += 5000.0 / 6.38e6;
  known.mean.head<3>() = EcefFromGeodetic(there) - MotionStart();
  known.covariance *= 1e-6;
  EXPECT_LT(std::sqrt(HearRise({0.0, 1.0}, Up(), &known)), 0.02);
  EXPECT_NEAR(Up().dot(known.mean.head<3>()), -1.96, 0.02);
}

TEST(Rise, FarFromWhatIsKnownIsNotHeard) {
  const StepKnowledge known = Known();
  for (const double rise_m : {300.0, -300.0, 1e300, std::nan("")}) {
    StepKnowledge heard = known;
    EXPECT_FALSE(HearRise({rise_m, 0.4}, Up(), &heard) < 9.0);
    EXPECT_EQ(heard.mean, known.mean);
    EXPECT_EQ(heard.covariance, known.covariance);
  }
}

// Lifts up for a minute, and nothing else is measured.
TEST(Rise, CarriesTheHeightOfAMotionFilter) {
  MotionFilter filter;
  filter.Start(MotionStart(), 1e-6 * Eigen::Matrix3d::Identity());
  MotionVerdicts verdicts;
  Random random(6);
  constexpr double kSigma_m = 0.1;
  for (int second = 1; second <= 60; ++second) {
    filter.Advance(1.0, {}, {}, MotionModel(), &verdicts,
                   Rise{0.5 + kSigma_m * random.Gaussian(), kSigma_m});
    ASSERT_TRUE(verdicts.rise_square.has_value());
  }
  const double risen_m = Up().dot(filter.position_in_ecef() - MotionStart());
  const double sigma_m = std::sqrt(filter.PositionCovarianceEnu()(2, 2));
  EXPECT_NEAR(sigma_m, kSigma_m * std::sqrt(60.0), 0.1);
  EXPECT_NEAR(risen_m, 30.0, 3.0 * sigma_m);
  EXPECT_NEAR(std::sqrt(filter.VelocityCovarianceEnu()(2, 2)), 0.1, 0.1);
  filter.Advance(1.0, {}, {}, MotionModel(), &verdicts);
  EXPECT_FALSE(verdicts.rise_square.has_value());
}

}  // namespace
}  // namespace lodemark::test
