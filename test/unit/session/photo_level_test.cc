#include "core/session/photo_level.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr std::int64_t kExposure_ns = 5 * kSecond_ns;

// The accelerometer at 100 Hz around the exposure, swinging by so much in x.
SensorBuffer Around(const Eigen::Vector3d& force_mps2, double swing_mps2) {
  SensorBuffer sensors;
  for (int i = -20; i <= 20; ++i) {
    const Eigen::Vector3d swing(i % 2 == 0 ? swing_mps2 : -swing_mps2, 0.0, 0.0);
    sensors.Push(
        {SensorKind::kAccelerometer, kExposure_ns + i * 10 * kMillisecond_ns, force_mps2 + swing});
  }
  return sensors;
}

// Of a back camera: SENSOR_ORIENTATION as Android states it.
Eigen::Quaterniond BackCamera(double orientation_deg) {
  const double half_rad = 0.5 * orientation_deg * kRadiansPerDegree;
  return Eigen::Quaterniond(0.0, std::cos(half_rad), -std::sin(half_rad), 0.0);
}

// Portrait, the phone's upper edge up: the sensor behind it lies on its side, its image's right
// edge is down. Of a phone held across, left side up, the image is upright.
TEST(PhotoLevel, TurnsWhatIsUpIntoTheAxesOfABackCamera) {
  const SensorBuffer portrait = Around({0.0, 9.81, 0.0}, 0.0);
  const auto of_portrait = LevelAt(portrait, kExposure_ns, BackCamera(90.0));
  ASSERT_TRUE(of_portrait.has_value());
  EXPECT_NEAR((of_portrait->up_in_camera - Eigen::Vector3d(-1.0, 0.0, 0.0)).norm(), 0.0, 1e-12);
  const SensorBuffer across = Around({9.81, 0.0, 0.0}, 0.0);
  const auto of_across = LevelAt(across, kExposure_ns, BackCamera(90.0));
  ASSERT_TRUE(of_across.has_value());
  EXPECT_NEAR((of_across->up_in_camera - Eigen::Vector3d(0.0, -1.0, 0.0)).norm(), 0.0, 1e-12);
  // Lying on its back, the camera looks down and up is behind it.
  const SensorBuffer lying = Around({0.0, 0.0, 9.81}, 0.0);
  const auto of_lying = LevelAt(lying, kExposure_ns, BackCamera(90.0));
  ASSERT_TRUE(of_lying.has_value());
  EXPECT_NEAR((of_lying->up_in_camera - Eigen::Vector3d(0.0, 0.0, -1.0)).norm(), 0.0, 1e-12);
}

TEST(PhotoLevel, IsAsSureAsTheSamplesAreSteady) {
  const auto still = LevelAt(Around({0.0, 9.81, 0.0}, 0.0), kExposure_ns, BackCamera(0.0));
  const auto shaken = LevelAt(Around({0.0, 9.81, 0.0}, 1.5), kExposure_ns, BackCamera(0.0));
  ASSERT_TRUE(still.has_value() && shaken.has_value());
  EXPECT_NEAR(still->sigma_rad, 2.0 * kRadiansPerDegree, 1e-12);
  // 21 samples of +-1.5 scatter by 1.5 sqrt(21 / 20) less their mean of 1.5 / 21.
  EXPECT_NEAR(shaken->sigma_rad, std::atan(1.5334 / 9.81), 1e-3);
}

TEST(PhotoLevel, IsNoneWhereItWouldBeWrong) {
  const SensorBuffer steady = Around({0.0, 9.81, 0.0}, 0.0);
  EXPECT_FALSE(LevelAt(SensorBuffer(), kExposure_ns, BackCamera(0.0)).has_value());
  EXPECT_FALSE(LevelAt(steady, kExposure_ns + kSecond_ns, BackCamera(0.0)).has_value());
  EXPECT_FALSE(LevelAt(Around({0.0, 0.0, 0.0}, 0.0), kExposure_ns, BackCamera(0.0)).has_value());
  EXPECT_FALSE(LevelAt(Around({0.0, 12.0, 0.0}, 0.0), kExposure_ns, BackCamera(0.0)).has_value());
}

}  // namespace
}  // namespace lodemark
