#include "core/fusion/inertial_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/geo/rotation.h"
#include "test/unit/fusion/inertial_scene.h"

namespace lodemark::test {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

Matrix6 Motion(double position_m, double velocity_mps) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(position_m), Eigen::Vector3d::Constant(velocity_mps);
  return sigmas.cwiseAbs2().asDiagonal();
}

Matrix9 Attitude(double turn_rad, double turn_rate_radps, double force_mps2) {
  Eigen::Matrix<double, 9, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(turn_rad), Eigen::Vector3d::Constant(turn_rate_radps),
      Eigen::Vector3d::Constant(force_mps2);
  return sigmas.cwiseAbs2().asDiagonal();
}

double ErrorOf(const InertialFilter& filter, const InertialScene& scene, double seconds) {
  return (filter.state().position_in_ecef - scene.PlaceAt(seconds)).norm();
}

class InertialFilterTest : public ::testing::Test {
 protected:
  // With Doppler of eight satellites each second, after what the samples became.
  void Drive(int from_s, int to_s, bool satellites, double late_s = 0.0) {
    for (int s = from_s; s < to_s && filter_.started(); ++s) {
      const auto rates =
          satellites ? scene_.RatesAt(s + 1, 0.05, &random_) : std::vector<RangeRateObservation>();
      filter_.Advance(scene_.Felt(s, s + 1, late_s), rates, {}, &verdicts_);
    }
  }

  InertialScene scene_;
  Random random_{3};
  InertialFilter filter_;
  MotionVerdicts verdicts_;
};

// Gravity, the earth's rotation and the attitude are all in it: a minute without any other help.
TEST_F(InertialFilterTest, FindsItsWayBySensorsThatDoNotErr) {
  filter_.Start(scene_.StateAt(0.0), Motion(0.1, 0.01), Attitude(0.01, 1e-4, 0.01));
  Drive(0, 60, false);
  ASSERT_TRUE(filter_.started());
  EXPECT_LT(ErrorOf(filter_, scene_, 60.0), 0.3);
  EXPECT_LT(
      TurnOf(filter_.state().ecef_from_sensor * scene_.EcefFromSensor(60.0).conjugate()).norm(),
      1e-3);
}

TEST_F(InertialFilterTest, LearnsAttitudeAndBiases) {
  InertialState wrong = scene_.StateAt(0.0);
  const Eigen::Vector3d turn = 5.0 * kRadiansPerDegree * Eigen::Vector3d(1.0, -1.0, 1.0);
  wrong.ecef_from_sensor = Turn(turn) * wrong.ecef_from_sensor;
  wrong.biases.turn_rate_radps = {0.01, -0.01, 0.005};
  filter_.Start(wrong, Motion(1.0, 0.1), Attitude(0.09, 0.01, 0.05));
  Drive(0, 60, true);
  ASSERT_TRUE(filter_.started());
  const Eigen::Vector3d left =
      TurnOf(filter_.state().ecef_from_sensor * scene_.EcefFromSensor(60.0).conjugate());
  EXPECT_LT(left.norm(), 1.5 * kRadiansPerDegree);
  EXPECT_LT(filter_.state().biases.turn_rate_radps.norm(), 0.002);
}

TEST_F(InertialFilterTest, FindsHowLateTheSamplesAre) {
  filter_.Start(scene_.StateAt(0.0), Motion(1.0, 0.1), Attitude(0.02, 0.001, 0.02));
  Drive(0, 90, true, 0.15);
  ASSERT_TRUE(filter_.started());
  EXPECT_NEAR(filter_.state().late_s, 0.15, 0.04);
}

// Samples of another drive: what Doppler tells is believed, and the sensor is not.
TEST_F(InertialFilterTest, StopsWhereTheSensorMovesOtherwise) {
  filter_.Start(scene_.StateAt(0.0), Motion(1.0, 0.1), Attitude(0.02, 0.001, 0.02));
  for (int s = 0; s < 30 && filter_.started(); ++s) {
    std::vector<InertialSample> other = scene_.Felt(s, s + 1);
    for (InertialSample& sample : other) sample.turn_rate_radps.reverseInPlace();
    filter_.Advance(other, scene_.RatesAt(s + 1, 0.05, &random_), {}, &verdicts_);
  }
  EXPECT_FALSE(filter_.started());
}

TEST_F(InertialFilterTest, StopsWhereNumbersRunOut) {
  filter_.Start(scene_.StateAt(0.0), Motion(1.0, 0.1), Attitude(0.02, 0.001, 0.02));
  std::vector<InertialSample> absurd = scene_.Felt(0.0, 1.0);
  absurd[50].specific_force_mps2.x() = 1e300;
  absurd[51].specific_force_mps2.x() = 1e300;
  filter_.Advance(absurd, {}, {}, &verdicts_);
  EXPECT_FALSE(filter_.started());
}

// An increase of knowledge that is heard as what it is: position and covariance by hand.
TEST_F(InertialFilterTest, HearsAStatementAsAKalmanFilterDoes) {
  filter_.Start(scene_.StateAt(0.0), Motion(2.0, 0.1), Attitude(0.02, 0.001, 0.02));
  PositionStatement said = filter_.Place();
  EXPECT_NEAR(said.information_pm2(0, 0), 0.25, 1e-9);
  said.information_pm2 = Eigen::Vector3d(0.25, 0.0, 0.0).asDiagonal();
  said.pull_pm = Eigen::Vector3d(0.25 * 3.0, 0.0, 0.0);  // 3 m to the east, 2 m of sigma
  filter_.Hear(said);
  const Eigen::Vector3d moved = EnuFromEcefRotation(GeodeticFromEcef(scene_.PlaceAt(0.0))) *
                                (filter_.state().position_in_ecef - scene_.PlaceAt(0.0));
  EXPECT_LT((moved - Eigen::Vector3d(1.5, 0.0, 0.0)).norm(), 1e-3);
  EXPECT_NEAR(filter_.PositionCovarianceEnu()(0, 0), 2.0, 1e-6);
  EXPECT_NEAR(filter_.PositionCovarianceEnu()(1, 1), 4.0, 1e-6);
}

TEST_F(InertialFilterTest, StandsStillWhereItIsTold) {
  InertialState state = scene_.StateAt(0.0);
  state.velocity_in_ecef_mps = Eigen::Vector3d(0.1, 0.0, 0.0);
  state.biases.turn_rate_radps = Eigen::Vector3d(0.0, 0.01, 0.0);
  filter_.Start(state, Motion(1.0, 0.2), Attitude(0.02, 0.02, 0.02));
  EXPECT_TRUE(filter_.HearVelocity(Eigen::Vector3d::Zero(), 0.02));
  EXPECT_LT(filter_.state().velocity_in_ecef_mps.norm(), 0.005);
  EXPECT_TRUE(filter_.HearStill(Eigen::Vector3d::Zero(), 0.001));
  EXPECT_LT(filter_.state().biases.turn_rate_radps.norm(), 0.001);
  // At 20 m/s nobody stands.
  state.velocity_in_ecef_mps = Eigen::Vector3d(20.0, 0.0, 0.0);
  filter_.Start(state, Motion(1.0, 0.2), Attitude(0.02, 0.02, 0.02));
  EXPECT_FALSE(filter_.HearVelocity(Eigen::Vector3d::Zero(), 0.02));
  EXPECT_EQ(filter_.state().velocity_in_ecef_mps.x(), 20.0);
}

TEST_F(InertialFilterTest, AVehicleMovesForward) {
  filter_.Start(scene_.StateAt(0.0), Motion(1.0, 0.05), Attitude(0.02, 0.001, 0.02));
  filter_.Mount();
  const double speed_mps = scene_.VelocityAt(0.0).norm();
  EXPECT_LT((filter_.VelocityInVehicle() - Eigen::Vector3d(speed_mps, 0.0, 0.0)).norm(), 1e-9);
  // The mounting is that of the scene, as the car looks where it goes.
  EXPECT_LT(TurnOf(filter_.state().sensor_from_vehicle * scene_.vehicle_from_sensor()).norm(),
            1e-3);
  for (int s = 0; s < 20; ++s) {
    filter_.Advance(scene_.Felt(s, s + 1), scene_.RatesAt(s + 1, 0.05, &random_), {}, &verdicts_);
    EXPECT_TRUE(filter_.HearVehicle({0.0, 0.0, 0.0}, {1e4, 0.3, 0.3})) << s;
  }
  const double variance = filter_.VelocityCovarianceEnu().trace();
  // Without satellites it keeps to its axis and to what its wheels say.
  for (int s = 20; s < 35; ++s) {
    filter_.Advance(scene_.Felt(s, s + 1), {}, {}, &verdicts_);
    EXPECT_TRUE(filter_.HearVehicle({scene_.VelocityAt(s + 1).norm(), 0.0, 0.0}, {0.1, 0.3, 0.3}));
  }
  EXPECT_LT(filter_.VelocityCovarianceEnu().trace(), 4.0 * variance + 0.1);
  EXPECT_LT(ErrorOf(filter_, scene_, 35.0), 5.0);
  EXPECT_FALSE(filter_.HearVehicle({0.0, 9.0, 0.0}, {1e4, 0.3, 0.3}));
}

// Thirty drives with noise, biases and a turn drawn from what is stated: half a minute with
// satellites, fifteen seconds without. The errors are as large as they are said to be.
TEST_F(InertialFilterTest, ErrsAsItSays) {
  const InertialNoise noise;
  const double turn_rate_noise = noise.turn_rate_radps_sqrt_s / std::sqrt(0.01);
  const double force_noise = noise.specific_force_mps2_sqrt_s / std::sqrt(0.01);
  double squares = 0.0;
  constexpr int kDrives = 30;
  const auto drawn = [&](double sigma) {
    Eigen::Vector3d vector;
    for (int axis = 0; axis < 3; ++axis) vector[axis] = random_.Gaussian(0.0, sigma);
    return vector;
  };
  for (int drive = 0; drive < kDrives; ++drive) {
    const Eigen::Vector3d turn_rate_bias = drawn(0.005);
    const Eigen::Vector3d force_bias = drawn(0.05);
    InertialState state = scene_.StateAt(0.0);
    state.position_in_ecef += drawn(1.0);
    state.velocity_in_ecef_mps += drawn(0.1);
    state.ecef_from_sensor = Turn(drawn(0.03)) * state.ecef_from_sensor;
    filter_.Start(state, Motion(1.0, 0.1), Attitude(0.03, 0.005, 0.05));
    for (int s = 0; s < 45; ++s) {
      std::vector<InertialSample> samples = scene_.Felt(s, s + 1);
      for (InertialSample& sample : samples) {
        sample.turn_rate_radps += turn_rate_bias + drawn(turn_rate_noise);
        sample.specific_force_mps2 += force_bias + drawn(force_noise);
      }
      const auto rates =
          s < 30 ? scene_.RatesAt(s + 1, 0.05, &random_) : std::vector<RangeRateObservation>();
      filter_.Advance(samples, rates, {}, &verdicts_);
    }
    ASSERT_TRUE(filter_.started()) << drive;
    const Eigen::Vector3d error = filter_.state().position_in_ecef - scene_.PlaceAt(45.0);
    const Eigen::Matrix3d covariance = filter_.covariance().topLeftCorner<3, 3>();
    squares += error.dot(covariance.ldlt().solve(error)) / (3.0 * kDrives);
  }
  // Stated wider than drawn: imperfect axes and biases that wander are allowed for and not drawn.
  EXPECT_GT(squares, 0.15);
  EXPECT_LT(squares, 1.35);
}

}  // namespace
}  // namespace lodemark::test
