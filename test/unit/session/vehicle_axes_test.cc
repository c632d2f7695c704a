#include "core/session/vehicle_axes.h"

#include <gtest/gtest.h>

#include <vector>

namespace lodemark {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

// Speeds up by 1 m/s each second while it turns left by 0.1 rad/s.
SensorBuffer Vehicle(std::initializer_list<double> seconds) {
  SensorBuffer sensors;
  for (const double at : seconds) {
    sensors.Prepare(SensorKind::kVehicle);
    EXPECT_TRUE(sensors.Push(
        {SensorKind::kVehicle, static_cast<std::int64_t>(at * 1e9), {5.0 + at, 0.1, 0.0}}));
  }
  return sensors;
}

TEST(VehicleAxes, FeelForcesOfSpeedAndBend) {
  const SensorBuffer sensors = Vehicle({0.0, 0.5, 1.0, 1.5, 2.0});
  std::vector<InertialSample> felt;
  ASSERT_TRUE(FeltInVehicle(sensors, kSecond / 4, 7 * kSecond / 4, &felt));
  ASSERT_EQ(felt.size(), 5U);
  EXPECT_EQ(felt.front().time_ns, kSecond / 4);
  EXPECT_EQ(felt.back().time_ns, 7 * kSecond / 4);
  for (const InertialSample& sample : felt) {
    const double speed_mps = 5.0 + 1e-9 * static_cast<double>(sample.time_ns);
    EXPECT_LT((sample.turn_rate_radps - Eigen::Vector3d(0.0, 0.0, 0.1)).norm(), 1e-12);
    EXPECT_LT((sample.specific_force_mps2 - Eigen::Vector3d(1.0, 0.1 * speed_mps, 9.81)).norm(),
              1e-9);
  }
}

TEST(VehicleAxes, AreNothingWhereTheVehicleIsSilent) {
  std::vector<InertialSample> felt;
  EXPECT_FALSE(FeltInVehicle(SensorBuffer(), 0, kSecond, &felt));
  EXPECT_FALSE(FeltInVehicle(Vehicle({0.0}), 0, kSecond, &felt));
  // From before the first, over a gap, and long after the last.
  EXPECT_FALSE(FeltInVehicle(Vehicle({0.5, 1.0}), 0, kSecond, &felt));
  EXPECT_FALSE(FeltInVehicle(Vehicle({0.0, 1.5}), 0, kSecond, &felt));
  EXPECT_FALSE(FeltInVehicle(Vehicle({0.0, 0.5}), 0, 2 * kSecond, &felt));
  EXPECT_FALSE(FeltInVehicle(Vehicle({0.0, 0.5, 1.0}), kSecond, kSecond, &felt));
  EXPECT_TRUE(felt.empty());
}

}  // namespace
}  // namespace lodemark
