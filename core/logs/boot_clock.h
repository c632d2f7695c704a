// GPS time of what a phone stamped with the time since boot, as its epochs tell.
#pragma once

#include <cstdint>
#include <optional>

namespace lodemark {

// An epoch's time since boot is late by as much as it took to be delivered or written, so the
// smallest difference from GPS time counts; it ages, since the boot clock drifts.
class BootClock {
 public:
  // An epoch, which has both times.
  void Learn(std::int64_t since_boot_ns, std::int64_t time_gps_ns);
  // None before the first epoch, or if the sum is no time.
  std::optional<std::int64_t> GpsTime(std::int64_t since_boot_ns) const;

 private:
  bool known_ = false;
  std::int64_t learned_at_ns_ = 0;  // since boot, of the latest epoch
  std::int64_t boot_gps_ns_ = 0;    // GPS time when the boot clock was zero
};

}  // namespace lodemark
