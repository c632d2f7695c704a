// How a phone in a bending car is turned: against the car's path.
#include "core/session/device_attitude.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <vector>

#include "core/session/inertial_carrier.h"
#include "test/unit/fusion/inertial_scene.h"

namespace lodemark::test {
namespace {

constexpr std::int64_t kBegin_ns = 1'000 * kSecond_ns;

class DeviceAttitudeTest : public ::testing::Test {
 protected:
  static std::int64_t At(double seconds) { return kBegin_ns + std::llround(1e9 * seconds); }

  void Feel(int from_s) {
    std::vector<InertialSample> felt = scene_.Felt(from_s, from_s + 1);
    felt.pop_back();
    for (const InertialSample& sample : felt) {
      Eigen::Vector3d force = sample.specific_force_mps2 + Eigen::Vector3d(0.1, -0.1, 0.05);
      Eigen::Vector3d rate = sample.turn_rate_radps + Eigen::Vector3d(0.02, -0.01, 0.01);
      for (int axis = 0; axis < 3; ++axis) {
        force[axis] += random_.Gaussian(0.0, 0.1);
        rate[axis] += random_.Gaussian(0.0, 0.003);
      }
      sensors_.Push({SensorKind::kAccelerometer, kBegin_ns + sample.time_ns, force});
      sensors_.Push({SensorKind::kGyroscope, kBegin_ns + sample.time_ns, rate});
    }
  }

  // So many seconds with Doppler.
  void Drive(int seconds) {
    MotionVerdicts verdicts;
    motion_.Start(scene_.PlaceAt(0.0), 4.0 * Eigen::Matrix3d::Identity());
    for (int s = 0; s < seconds; ++s) {
      Feel(s);
      const std::vector<RangeRateObservation> rates = scene_.RatesAt(s + 1.0, 0.05, &random_);
      if (carrier_.carries()) {
        EXPECT_TRUE(carrier_.Advance(At(s), At(s + 1.0), rates, {}, &barometer_, &verdicts));
      } else {
        motion_.Advance(1.0, rates, {}, MotionModel(), &verdicts);
        carrier_.Note(At(s + 1.0), motion_, true);
      }
    }
    Feel(seconds);
  }

  // By which small turn about east, north and up it is off.
  Eigen::Vector3d Error(const DeviceAttitude& attitude, double seconds) const {
    const Eigen::Quaterniond enu_from_device =
        Eigen::Quaterniond(EnuFromEcefRotation(GeodeticFromEcef(scene_.PlaceAt(seconds)))) *
        scene_.EcefFromSensor(seconds);
    return TurnOf(enu_from_device * attitude.device_from_enu);
  }

  InertialScene scene_;
  Random random_{23};
  SensorBuffer sensors_;
  Barometer barometer_{nullptr};
  InertialCarrier carrier_{&sensors_};
  MotionFilter motion_;
};

TEST_F(DeviceAttitudeTest, IsAsFarOffAsItSays) {
  double squares = 0.0;
  int count = 0;
  for (const int seconds : {25, 32, 40, 48, 55}) {
    carrier_.Forget();
    sensors_.Forget();
    Drive(seconds);
    ASSERT_TRUE(carrier_.carries());
    const std::optional<DeviceAttitude> attitude = carrier_.AttitudeAt(At(seconds), At(seconds));
    ASSERT_TRUE(attitude.has_value());
    const Eigen::Vector3d error_rad = Error(*attitude, seconds);
    EXPECT_LT(error_rad.norm(), 3.0 * kRadiansPerDegree) << seconds;
    EXPECT_LT(attitude->covariance_enu_rad2.diagonal().cwiseSqrt().maxCoeff(),
              5.0 * kRadiansPerDegree);
    squares += error_rad.dot(attitude->covariance_enu_rad2.ldlt().solve(error_rad));
    count += 3;
  }
  EXPECT_LT(squares / count, 2.0);
  EXPECT_GT(squares / count, 0.05);
}

TEST_F(DeviceAttitudeTest, FollowsTheGyroscopeToMomentsAround) {
  Drive(50);
  ASSERT_TRUE(carrier_.carries());
  const DeviceAttitude now = *carrier_.AttitudeAt(At(50.0), At(50.0));
  const Eigen::Vector3d error_rad = Error(now, 50.0);
  for (const double seconds : {47.5, 49.93, 50.35, 50.9}) {
    const std::optional<DeviceAttitude> then = carrier_.AttitudeAt(At(50.0), At(seconds));
    ASSERT_TRUE(then.has_value()) << seconds;
    // As much off as now; the car turned by 0.1 rad a second.
    EXPECT_LT((Error(*then, seconds) - error_rad).norm(), 0.01) << seconds;
    EXPECT_GT(then->covariance_enu_rad2.trace(), now.covariance_enu_rad2.trace());
  }
  EXPECT_GT(
      (now.device_from_enu * carrier_.AttitudeAt(At(50.0), At(47.5))->device_from_enu.conjugate())
          .vec()
          .norm(),
      0.03);
}

TEST_F(DeviceAttitudeTest, IsNoneWhereItIsNotKnown) {
  EXPECT_FALSE(carrier_.AttitudeAt(At(0.0), At(0.0)).has_value());
  Drive(30);
  ASSERT_TRUE(carrier_.carries());
  EXPECT_FALSE(carrier_.AttitudeAt(At(30.0), At(31.5)).has_value());  // not felt yet
  EXPECT_FALSE(carrier_.AttitudeAt(At(30.0), At(20.0)).has_value());  // long ago
  EXPECT_FALSE(carrier_.AttitudeAt(At(30.0), INT64_MAX / 2).has_value());
}

}  // namespace
}  // namespace lodemark::test
