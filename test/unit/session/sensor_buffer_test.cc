#include "core/session/sensor_buffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace lodemark {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

void PushForce(SensorBuffer* buffer, std::int64_t time_ns, double x, double y = 0.0,
               double z = 9.8) {
  EXPECT_TRUE(buffer->Push({SensorKind::kAccelerometer, time_ns, Eigen::Vector3d(x, y, z)}));
}

void PushTurn(SensorBuffer* buffer, std::int64_t time_ns, double z) {
  EXPECT_TRUE(buffer->Push({SensorKind::kGyroscope, time_ns, Eigen::Vector3d(0.0, 0.0, z)}));
}

// The gyroscope every 10 ms, the accelerometer every 16 ms and 3 ms later, each with a signal that
// is linear in time, so that linear interpolation is exact.
double TurnAt(std::int64_t time_ns) { return 0.1 + 2e-9 * static_cast<double>(time_ns); }
double ForceAt(std::int64_t time_ns) { return -1.0 + 3e-9 * static_cast<double>(time_ns); }

SensorBuffer Linear(std::int64_t from_ns, std::int64_t to_ns) {
  SensorBuffer buffer;
  for (std::int64_t t = from_ns; t <= to_ns; t += 10 * kMillisecond)
    PushTurn(&buffer, t, TurnAt(t));
  for (std::int64_t t = from_ns + 3 * kMillisecond; t <= to_ns; t += 16 * kMillisecond) {
    PushForce(&buffer, t, ForceAt(t));
  }
  return buffer;
}

double TrapezoidalTurn(std::span<const InertialSample> samples) {
  double angle = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step_s = 1e-9 * static_cast<double>(samples[i].time_ns - samples[i - 1].time_ns);
    angle += 0.5 * step_s * (samples[i].turn_rate_radps.z() + samples[i - 1].turn_rate_radps.z());
  }
  return angle;
}

TEST(SensorBuffer, GivesBothSensorsAtTheGyroscopesTimesAndAtTheEnds) {
  const SensorBuffer buffer = Linear(0, 1'000 * kMillisecond);
  const std::int64_t from_ns = 203'400'000;
  const std::int64_t to_ns = 471'250'000;
  bool complete = false;
  const auto samples = buffer.Between(from_ns, to_ns, &complete);
  EXPECT_TRUE(complete);
  ASSERT_EQ(samples.size(), 27U + 2U);  // 210, 220 .. 470 ms
  EXPECT_EQ(samples.front().time_ns, from_ns);
  EXPECT_EQ(samples.back().time_ns, to_ns);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(samples[i - 1].time_ns, samples[i].time_ns);
    }
    EXPECT_NEAR(samples[i].turn_rate_radps.z(), TurnAt(samples[i].time_ns), 1e-12);
    EXPECT_NEAR(samples[i].specific_force_mps2.x(), ForceAt(samples[i].time_ns), 1e-12);
  }
}

TEST(SensorBuffer, GivesNoSampleTwiceWhereAnEndIsOne) {
  const SensorBuffer buffer = Linear(0, 1'000 * kMillisecond);
  bool complete = false;
  const auto samples = buffer.Between(200 * kMillisecond, 250 * kMillisecond, &complete);
  EXPECT_TRUE(complete);
  EXPECT_EQ(samples.size(), 6U);
}

TEST(SensorBuffer, IntervalsSideBySideIntegrateToTheWhole) {
  SensorBuffer buffer;
  for (int i = 0; i < 200; ++i) {
    PushTurn(&buffer, i * 10 * kMillisecond, std::sin(0.7 * i));
    PushForce(&buffer, i * 10 * kMillisecond + 1, 0.0);
  }
  bool complete = false;
  const std::int64_t cuts_ns[] = {3'000'000, 404'000'000, 404'500'000, 1'233'456'789,
                                  1'990'000'000};
  double parts = 0.0;
  for (int i = 1; i < 5; ++i) {
    parts += TrapezoidalTurn(buffer.Between(cuts_ns[i - 1], cuts_ns[i], &complete));
    EXPECT_TRUE(complete);
  }
  // By hand: whole steps between samples, and the parts of steps at the first end.
  const auto value = [](double t) {
    const double i = std::floor(t);
    return std::sin(0.7 * i) + (t - i) * (std::sin(0.7 * (i + 1.0)) - std::sin(0.7 * i));
  };
  double whole = 0.01 * 0.7 * 0.5 * (value(0.3) + value(1.0));
  for (int i = 1; i < 199; ++i) whole += 0.01 * 0.5 * (value(i) + value(i + 1.0));
  EXPECT_NEAR(parts, whole, 1e-12);
}

TEST(SensorBuffer, HoldsTheLastValueForSixtyMilliseconds) {
  const SensorBuffer buffer = Linear(0, 1'000 * kMillisecond);  // forces 3 .. 995 ms
  bool complete = false;
  const std::int64_t end_ns = 1'050 * kMillisecond;
  const auto samples = buffer.Between(900 * kMillisecond, end_ns, &complete);
  EXPECT_TRUE(complete);
  EXPECT_DOUBLE_EQ(samples.back().turn_rate_radps.z(), TurnAt(1'000 * kMillisecond));
  EXPECT_DOUBLE_EQ(samples.back().specific_force_mps2.x(), ForceAt(995 * kMillisecond));

  // Forces end 61 ms before, turn rates do not.
  const auto later = buffer.Between(900 * kMillisecond, 1'056 * kMillisecond, &complete);
  EXPECT_FALSE(complete);
  EXPECT_EQ(later.back().time_ns, 1'056 * kMillisecond);
  EXPECT_TRUE(buffer.Between(1'061 * kMillisecond, 1'070 * kMillisecond, &complete).empty());
  EXPECT_FALSE(complete);
  EXPECT_GT(buffer.Between(-50 * kMillisecond, 100 * kMillisecond, &complete).size(), 0U);
  EXPECT_TRUE(complete);
  buffer.Between(-58 * kMillisecond, 100 * kMillisecond, &complete);
  EXPECT_FALSE(complete);
}

TEST(SensorBuffer, TellsAGapOfEitherSensor) {
  for (const bool of_gyroscope : {true, false}) {
    for (const std::int64_t gap : {60, 61}) {
      SensorBuffer buffer;
      for (std::int64_t i = 0; i < 100; ++i) {
        const std::int64_t t = i * 10 * kMillisecond;
        const std::int64_t late = t + (i >= 50 ? (gap - 10) * kMillisecond : 0);
        PushTurn(&buffer, of_gyroscope ? late : t, 0.1);
        PushForce(&buffer, of_gyroscope ? t : late, 0.1);
      }
      bool complete = false;
      buffer.Between(400 * kMillisecond, 700 * kMillisecond, &complete);
      EXPECT_EQ(complete, gap == 60);
      buffer.Between(100 * kMillisecond, 480 * kMillisecond, &complete);
      EXPECT_TRUE(complete);
      // Within the gap.
      buffer.Between(500 * kMillisecond, 510 * kMillisecond, &complete);
      EXPECT_EQ(complete, gap == 60);
    }
  }
}

TEST(SensorBuffer, GivesNothingWithoutEitherSensorOrInterval) {
  SensorBuffer buffer;
  bool complete = true;
  EXPECT_TRUE(buffer.Between(0, 1'000, &complete).empty());
  EXPECT_FALSE(complete);
  PushTurn(&buffer, 0, 0.1);
  EXPECT_TRUE(buffer.Between(0, 1'000, &complete).empty());
  PushForce(&buffer, 0, 0.1);
  EXPECT_EQ(buffer.Between(0, 1'000, &complete).size(), 2U);
  EXPECT_TRUE(complete);
  EXPECT_TRUE(buffer.Between(1'000, 1'000, &complete).empty());
  EXPECT_FALSE(complete);
  EXPECT_TRUE(buffer.Between(1'000, 0, &complete).empty());
}

TEST(SensorBuffer, DropsWhatIsNotLaterOfTheSameSensor) {
  SensorBuffer buffer;
  PushTurn(&buffer, 100, 1.0);
  PushForce(&buffer, 50, 1.0);  // another sensor's time is its own
  EXPECT_FALSE(buffer.Push({SensorKind::kGyroscope, 100, Eigen::Vector3d::Zero()}));
  EXPECT_FALSE(buffer.Push({SensorKind::kGyroscope, 99, Eigen::Vector3d::Zero()}));
  PushTurn(&buffer, 101, 2.0);
  bool complete = false;
  const auto samples = buffer.Between(100, 101, &complete);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_DOUBLE_EQ(samples[0].turn_rate_radps.z(), 1.0);
  EXPECT_DOUBLE_EQ(samples[1].turn_rate_radps.z(), 2.0);
}

TEST(SensorBuffer, FollowsAClockThatWasSetBack) {
  SensorBuffer buffer;
  const std::int64_t day_ns = 86'400'000'000'000;
  ASSERT_TRUE(buffer.Push({SensorKind::kBarometer, day_ns, Eigen::Vector3d(1000.0, 0.0, 0.0)}));
  int dropped = 0;
  for (std::int64_t t = 0; t <= 3'000 * kMillisecond; t += 100 * kMillisecond) {
    if (!buffer.Push({SensorKind::kBarometer, t, Eigen::Vector3d(900.0, 0.0, 0.0)})) ++dropped;
  }
  EXPECT_EQ(dropped, 11);  // 0 .. 1000 ms
  EXPECT_TRUE(buffer.PressuresBetween(day_ns, day_ns).empty());
  EXPECT_EQ(buffer.PressuresBetween(0, day_ns).size(), 20U);
}

TEST(SensorBuffer, TheOldestGiveWay) {
  SensorBuffer buffer;
  const std::int64_t count = 3 * static_cast<std::int64_t>(SensorBuffer::kMostPressureSamples) + 7;
  for (std::int64_t t = 0; t < count; ++t) {
    ASSERT_TRUE(buffer.Push(
        {SensorKind::kBarometer, t, Eigen::Vector3d(static_cast<double>(t), 0.0, 0.0)}));
  }
  const auto held = buffer.PressuresBetween(0, count);
  ASSERT_EQ(held.size(), SensorBuffer::kMostPressureSamples);
  for (std::size_t i = 0; i < held.size(); ++i) {
    const std::int64_t time_ns = count - static_cast<std::int64_t>(held.size() - i);
    ASSERT_EQ(held[i].time_ns, time_ns);
    ASSERT_DOUBLE_EQ(held[i].pressure_hpa, static_cast<double>(time_ns));
  }
}

TEST(SensorBuffer, WhatIsDroppedWasNotNeeded) {
  SensorBuffer buffer = Linear(0, 1'000 * kMillisecond);
  const SensorBuffer whole = buffer;
  const std::int64_t cut_ns = 505 * kMillisecond;
  buffer.DropBefore(cut_ns);
  bool complete = false;
  const auto kept = buffer.Between(cut_ns, 900 * kMillisecond, &complete);
  EXPECT_TRUE(complete);
  const auto before = whole.Between(cut_ns, 900 * kMillisecond, &complete);
  ASSERT_EQ(kept.size(), before.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].time_ns, before[i].time_ns);
    EXPECT_EQ(kept[i].turn_rate_radps, before[i].turn_rate_radps);
    EXPECT_EQ(kept[i].specific_force_mps2, before[i].specific_force_mps2);
  }
  buffer.Between(400 * kMillisecond, 900 * kMillisecond, &complete);
  EXPECT_FALSE(complete);
}

TEST(SensorBuffer, GivesMeanAndScatterOfTheForce) {
  SensorBuffer buffer;
  PushForce(&buffer, 0, 100.0);
  PushForce(&buffer, 10, 1.0, 2.0, 9.0);
  PushForce(&buffer, 20, 3.0, 2.0, 10.0);
  PushForce(&buffer, 30, 5.0, 2.0, 11.0);
  EXPECT_FALSE(buffer.MeanForceBetween(5, 15).has_value());
  const auto mean = buffer.MeanForceBetween(10, 30);
  ASSERT_TRUE(mean.has_value());
  EXPECT_EQ(mean->samples, 3);
  EXPECT_EQ(mean->mean_mps2, Eigen::Vector3d(3.0, 2.0, 10.0));
  EXPECT_NEAR((mean->scatter_mps2 - Eigen::Vector3d(2.0, 0.0, 1.0)).norm(), 0.0, 1e-12);
}

TEST(SensorBuffer, GivesTheVehiclesSamples) {
  SensorBuffer buffer;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(buffer.Push({SensorKind::kVehicle, i * 100, Eigen::Vector3d(i, 0.1 * i, 0.0)}));
  }
  const auto samples = buffer.VehicleBetween(150, 300);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_DOUBLE_EQ(samples[1].forward_speed_mps, 3.0);
  EXPECT_DOUBLE_EQ(samples[1].left_yaw_rate_radps, 0.1 * 3);
}

TEST(SensorBuffer, ForgetsAll) {
  SensorBuffer buffer = Linear(0, 1'000 * kMillisecond);
  buffer.Forget();
  bool complete = true;
  EXPECT_TRUE(buffer.Between(0, 500 * kMillisecond, &complete).empty());
  EXPECT_FALSE(buffer.MeanForceBetween(0, 500 * kMillisecond).has_value());
  PushTurn(&buffer, 0, 1.0);  // earlier than what was forgotten
}

TEST(SensorBuffer, StandsAnyTime) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  SensorBuffer buffer;
  for (const std::int64_t time_ns : {kFirst, kFirst + 1, std::int64_t{0}, kLast}) {
    PushTurn(&buffer, time_ns, 1.0);
    PushForce(&buffer, time_ns, 1.0);
  }
  bool complete = true;
  const auto samples = buffer.Between(kFirst, kLast, &complete);
  EXPECT_FALSE(complete);
  EXPECT_EQ(samples.size(), 4U);
  const std::int64_t nowhere_ns = kLast / 2;
  EXPECT_TRUE(buffer.Between(nowhere_ns, nowhere_ns + 1, &complete).empty());
  EXPECT_FALSE(complete);
  EXPECT_FALSE(buffer.Push({SensorKind::kGyroscope, kFirst, Eigen::Vector3d::Zero()}));
}

}  // namespace
}  // namespace lodemark
