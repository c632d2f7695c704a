// Builds raw Android epochs whose travel times are known.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/android_measurement.h"

namespace lodemark {

inline constexpr std::int32_t kTowState = 1 | 2 | 4 | 8;
inline constexpr std::int32_t kGlonassTodState = 1 | 2 | 32 | 64 | 128;

// Metres that light covers in the given nanoseconds.
inline double LightMeters(double nanoseconds) { return kSpeedOfLight_mps * 1e-9 * nanoseconds; }

// A phone whose clock reads time_ns when GPS time is gps_time_ns.
struct AndroidScene {
  explicit AndroidScene(std::int64_t gps_time_ns) {
    epoch.clock.time_ns = 5 * kSecond_ns;
    epoch.clock.full_bias_ns = epoch.clock.time_ns - gps_time_ns;
    epoch.clock.present = kClockHasFullBias;
  }

  std::int64_t gps_time_ns() const { return epoch.clock.time_ns - epoch.clock.full_bias_ns; }

  // A signal that left travel_ns before reception; what the phone knows of it modulo period_ns.
  AndroidMeasurement& Add(std::int32_t constellation, std::int32_t svid, std::int32_t state,
                          std::int64_t travel_ns, std::int64_t period_ns = kWeek_ns) {
    std::int64_t system_offset_ns = 0;
    if (constellation == 5) system_offset_ns = 14 * kSecond_ns;
    if (constellation == 3) system_offset_ns = (18 - 3 * 3600) * kSecond_ns;
    AndroidMeasurement raw;
    raw.constellation_type = constellation;
    raw.svid = svid;
    raw.state = state;
    raw.received_sv_time_ns = FloorModulo(gps_time_ns() - system_offset_ns - travel_ns, period_ns);
    raw.received_sv_time_uncertainty_ns = 20;
    raw.pseudorange_rate_uncertainty_mps = 0.1;
    raw.cn0_dbhz = 40.0;
    raw.present = kMeasurementHasReceivedTimeUncertainty | kMeasurementHasRangeRate |
                  kMeasurementHasRangeRateUncertainty | kMeasurementHasCn0;
    epoch.measurements.push_back(raw);
    return epoch.measurements.back();
  }

  // The same phone a while later; its oscillator is exact.
  void Advance(std::int64_t elapsed_ns) {
    epoch.clock.time_ns += elapsed_ns;
    epoch.measurements.clear();
  }

  AndroidEpoch epoch;
};

}  // namespace lodemark
