#include "core/logs/boot_clock.h"

#include <gtest/gtest.h>

#include <limits>

namespace lodemark {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kBoot_gps_ns = 1'380'000'000 * kSecond;

TEST(BootClock, KnowsNothingBeforeTheFirstEpoch) {
  EXPECT_FALSE(BootClock().GpsTime(5 * kSecond).has_value());
}

TEST(BootClock, TakesTheEpochThatCameSoonest) {
  BootClock clock;
  const int late_ms[] = {80, 30, 120, 45, 200, 31};
  for (int i = 0; i < 6; ++i) {
    const std::int64_t since_boot_ns = (100 + i) * kSecond;
    clock.Learn(since_boot_ns + late_ms[i] * kMillisecond, kBoot_gps_ns + since_boot_ns);
  }
  // 30 ms late, less what the clock may have drifted in the four seconds since.
  const std::int64_t error_ns = *clock.GpsTime(110 * kSecond) - (kBoot_gps_ns + 110 * kSecond);
  EXPECT_LE(error_ns, -30 * kMillisecond);
  EXPECT_GE(error_ns, -30 * kMillisecond - 4 * 50'000);
}

TEST(BootClock, FollowsADriftingClockForAnHour) {
  BootClock clock;
  constexpr double kDrift = 20e-6;
  for (std::int64_t i = 0; i < 3600; ++i) {
    const auto drifted_ns = static_cast<std::int64_t>(static_cast<double>(i * kSecond) * kDrift);
    clock.Learn(i * kSecond + drifted_ns, kBoot_gps_ns + i * kSecond);
  }
  const std::int64_t at_ns = 3599 * kSecond + static_cast<std::int64_t>(3599e9 * kDrift);
  EXPECT_NEAR(static_cast<double>(*clock.GpsTime(at_ns) - (kBoot_gps_ns + 3599 * kSecond)), 0.0,
              100'000.0);
}

TEST(BootClock, BeginsAnewWithAnotherBoot) {
  BootClock clock;
  clock.Learn(1000 * kSecond, kBoot_gps_ns);
  clock.Learn(10 * kSecond, kBoot_gps_ns + 60 * kSecond);
  EXPECT_EQ(clock.GpsTime(11 * kSecond), kBoot_gps_ns + 61 * kSecond);
}

TEST(BootClock, StandsAnyTime) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  BootClock clock;
  for (const std::int64_t a : {kFirst, kLast, std::int64_t{0}, 4 * kBoot_gps_ns / 2}) {
    for (const std::int64_t b : {kFirst, kLast, std::int64_t{0}, -kBoot_gps_ns}) clock.Learn(a, b);
  }
  EXPECT_FALSE(clock.GpsTime(kFirst).has_value());
  EXPECT_FALSE(clock.GpsTime(kLast).has_value());
}

}  // namespace
}  // namespace lodemark
