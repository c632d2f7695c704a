// Physical constants and unit factors that several modules share.
#pragma once

#include <cstdint>
#include <numbers>

namespace lodemark {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kRadiansPerDegree = kPi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / kPi;

inline constexpr double kSpeedOfLight_mps = 299'792'458.0;

inline constexpr std::int64_t kMicrosecond_ns = 1'000;
inline constexpr std::int64_t kMillisecond_ns = 1'000'000;
inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr std::int64_t kDay_ns = 86'400 * kSecond_ns;
inline constexpr std::int64_t kWeek_ns = 7 * kDay_ns;

}  // namespace lodemark
