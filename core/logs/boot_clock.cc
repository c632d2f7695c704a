#include "core/logs/boot_clock.h"

#include <algorithm>

namespace lodemark {
namespace {

// Drift of a phone's crystal against GPS time, generously.
constexpr std::int64_t kDrift_nsps = 50'000;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

// More than any delivery takes: the phone was started anew, or its GPS time was wrong.
constexpr std::int64_t kLargestStep_ns = 5 * kSecond_ns;

constexpr std::int64_t kLargestTime_ns = 4'000'000'000'000'000'000;

bool IsTime(std::int64_t time_ns) {
  return time_ns >= -kLargestTime_ns && time_ns <= kLargestTime_ns;
}

}  // namespace

void BootClock::Learn(std::int64_t since_boot_ns, std::int64_t time_gps_ns) {
  if (!IsTime(since_boot_ns) || !IsTime(time_gps_ns)) return;
  const std::int64_t boot_gps_ns = time_gps_ns - since_boot_ns;
  if (!IsTime(boot_gps_ns)) return;
  const std::int64_t age_ns = since_boot_ns - learned_at_ns_;
  const std::int64_t step_ns = boot_gps_ns - boot_gps_ns_;
  const bool goes_on = known_ && age_ns >= 0 && age_ns < 3'600 * kSecond_ns &&
                       step_ns > -kLargestStep_ns && step_ns < kLargestStep_ns;
  if (goes_on) {
    const std::int64_t aged_ns = boot_gps_ns_ - age_ns / kSecond_ns * kDrift_nsps;
    boot_gps_ns_ = std::max(aged_ns, boot_gps_ns);
  } else {
    boot_gps_ns_ = boot_gps_ns;
  }
  known_ = true;
  learned_at_ns_ = since_boot_ns;
}

std::optional<std::int64_t> BootClock::GpsTime(std::int64_t since_boot_ns) const {
  if (!known_ || !IsTime(since_boot_ns)) return std::nullopt;
  const std::int64_t time_gps_ns = boot_gps_ns_ + since_boot_ns;
  return IsTime(time_gps_ns) ? std::optional(time_gps_ns) : std::nullopt;
}

}  // namespace lodemark
