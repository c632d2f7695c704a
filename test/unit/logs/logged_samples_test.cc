#include "core/logs/logged_samples.h"

#include <gtest/gtest.h>

#include <vector>

namespace lodemark {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kSecond_ns = 1'000 * kMillisecond_ns;
constexpr std::int64_t kBoot_gps_ns = 1'400'000'000 * kSecond_ns;

using Kind = LoggedSensor::Kind;

// Three values that tell the time, and a bias that tells the axis.
LoggedSensor SensorAt(std::int64_t elapsed_ns, Kind kind, bool uncalibrated = false) {
  LoggedSensor sensor;
  sensor.kind = kind;
  sensor.elapsed_realtime_ns = elapsed_ns;
  sensor.uncalibrated = uncalibrated;
  sensor.count = kind == Kind::kPressure ? 1 : 3;
  for (int i = 0; i < sensor.count; ++i) {
    sensor.values[i] = 1e-9 * static_cast<double>(elapsed_ns) + i;
  }
  if (uncalibrated) sensor.biases[2] = 0.25;
  return sensor;
}

AndroidEpoch EpochAt(std::int64_t elapsed_ns, std::uint32_t present) {
  AndroidEpoch epoch;
  epoch.clock.present = present;
  epoch.clock.elapsed_realtime_ns = elapsed_ns;
  epoch.clock.time_ns = elapsed_ns;
  epoch.clock.full_bias_ns = -kBoot_gps_ns;
  return epoch;
}
constexpr std::uint32_t kBothTimes = kClockHasFullBias | kClockHasElapsedRealtime;

std::vector<LoggedSample> All(LoggedSamples* samples) {
  std::vector<LoggedSample> all;
  for (LoggedSample sample; samples->Next(&sample);) all.push_back(sample);
  return all;
}

TEST(LoggedSamples, WaitForAnEpochThatTellsBothTimes) {
  LoggedSamples samples;
  samples.Take(SensorAt(5 * kSecond_ns, Kind::kTurnRate));
  samples.Take(EpochAt(6 * kSecond_ns, kClockHasFullBias));
  samples.Take(EpochAt(6 * kSecond_ns, kClockHasElapsedRealtime));
  EXPECT_TRUE(All(&samples).empty());
  samples.Take(EpochAt(6 * kSecond_ns, kBothTimes));
  const std::vector<LoggedSample> all = All(&samples);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].kind, Kind::kTurnRate);
  EXPECT_EQ(all[0].elapsed_realtime_ns, 5 * kSecond_ns);
  EXPECT_EQ(all[0].time_gps_ns, kBoot_gps_ns + 5 * kSecond_ns);
  EXPECT_DOUBLE_EQ(all[0].value[1], 6.0);
  EXPECT_TRUE(All(&samples).empty());
}

TEST(LoggedSamples, AreLessTheBiasThatThePhoneStates) {
  LoggedSamples samples;
  samples.Take(SensorAt(kSecond_ns, Kind::kAcceleration, true));
  samples.Take(EpochAt(kSecond_ns, kBothTimes));
  const std::vector<LoggedSample> all = All(&samples);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_DOUBLE_EQ(all[0].value[0], 1.0);
  EXPECT_DOUBLE_EQ(all[0].value[2], 2.75);
}

TEST(LoggedSamples, OfASensorThatIsLoggedTwiceAreThoseThatCameFirst) {
  LoggedSamples samples;
  samples.Take(SensorAt(1, Kind::kAcceleration, true));
  samples.Take(SensorAt(2, Kind::kAcceleration));
  samples.Take(SensorAt(3, Kind::kTurnRate));
  samples.Take(SensorAt(4, Kind::kTurnRate, true));
  samples.Take(EpochAt(kSecond_ns, kBothTimes));
  const std::vector<LoggedSample> all = All(&samples);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].elapsed_realtime_ns, 1);
  EXPECT_EQ(all[1].elapsed_realtime_ns, 3);
}

TEST(LoggedSamples, AreOfNoOtherSensor) {
  LoggedSamples samples;
  for (const Kind kind : {Kind::kMagneticField, Kind::kOrientation, Kind::kGameRotation}) {
    samples.Take(SensorAt(1, kind));
  }
  samples.Take(SensorAt(1, Kind::kPressure));
  samples.Take(EpochAt(kSecond_ns, kBothTimes));
  const std::vector<LoggedSample> all = All(&samples);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].kind, Kind::kPressure);
}

TEST(LoggedSamples, AfterTheLastEpochHaveItsTime) {
  LoggedSamples samples;
  samples.Take(EpochAt(kSecond_ns, kBothTimes));
  samples.Take(SensorAt(2 * kSecond_ns, Kind::kTurnRate));
  EXPECT_TRUE(All(&samples).empty());
  samples.End();
  EXPECT_EQ(All(&samples).size(), 1U);
  EXPECT_EQ(samples.without_time(), 0);
}

TEST(LoggedSamples, WithoutATimeAreCountedAndNotKeptForEver) {
  LoggedSamples samples;
  const auto most = static_cast<std::int64_t>(LoggedSamples::kMostWaiting);
  for (std::int64_t i = 0; i < most + 3; ++i) samples.Take(SensorAt(i, Kind::kTurnRate));
  EXPECT_EQ(samples.without_time(), 3);
  samples.End();
  EXPECT_TRUE(All(&samples).empty());
  EXPECT_EQ(samples.without_time(), most + 3);
}

}  // namespace
}  // namespace lodemark
