// Raw Android epochs of any content, converted and repaired: what comes out is always usable.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/units.h"
#include "core/gnss/android_observables.h"
#include "core/gnss/millisecond_jump.h"
#include "test/fuzz/bytes.h"

namespace {

using namespace lodemark;

using test::Bytes;
using test::Require;

// Any field of any value.
AndroidMeasurement AnyMeasurement(Bytes* bytes) {
  AndroidMeasurement raw;
  raw.svid = bytes->Take<std::int32_t>();
  raw.constellation_type = bytes->Take<std::int8_t>();
  raw.state = bytes->Take<std::int32_t>();
  raw.accumulated_delta_range_state = bytes->Take<std::int8_t>();
  raw.present = bytes->Take<std::uint32_t>();
  raw.received_sv_time_ns = bytes->Take<std::int64_t>();
  raw.received_sv_time_uncertainty_ns = bytes->Take<std::int16_t>();
  raw.time_offset_ns = bytes->Take<double>();
  raw.cn0_dbhz = bytes->Take<double>();
  raw.pseudorange_rate_mps = bytes->Take<double>();
  raw.pseudorange_rate_uncertainty_mps = bytes->Take<double>();
  raw.accumulated_delta_range_m = bytes->Take<double>();
  raw.accumulated_delta_range_uncertainty_m = bytes->Take<double>();
  raw.carrier_frequency_hz = bytes->Take<double>();
  raw.given_pseudorange_m = bytes->Take<double>();
  raw.code_type[0] = bytes->Take<char>();
  return raw;
}

// A satellite in view, nearly as a phone would see it.
AndroidMeasurement LikelyMeasurement(Bytes* bytes, std::int64_t gps_time_ns) {
  constexpr std::int64_t kPeriods_ns[] = {kWeek_ns, kDay_ns, 100 * kMillisecond_ns,
                                          kMillisecond_ns};
  AndroidMeasurement raw;
  raw.svid = bytes->Take<std::uint8_t>();
  raw.constellation_type = 1 + bytes->Take<std::uint8_t>() % 7;
  raw.state = bytes->Take<std::int32_t>() | 1;
  const std::int64_t travel_ns = bytes->Take<std::uint32_t>() % 200'000'000;
  raw.received_sv_time_ns =
      (gps_time_ns - travel_ns) % kPeriods_ns[bytes->Take<std::uint8_t>() % 4];
  raw.received_sv_time_uncertainty_ns = bytes->Take<std::uint8_t>();
  raw.pseudorange_rate_mps = bytes->Take<std::int16_t>();
  raw.accumulated_delta_range_m = bytes->Take<std::int16_t>();
  raw.accumulated_delta_range_state = bytes->Take<std::uint8_t>();
  raw.time_offset_ns = bytes->Take<std::int16_t>();
  raw.present = kMeasurementHasRangeRate | kMeasurementHasAccumulatedDeltaRange |
                kMeasurementHasReceivedTimeUncertainty;
  return raw;
}

void CheckEpoch(const ObservationEpoch& epoch) {
  Require(epoch.time_fraction_ns >= 0.0 && epoch.time_fraction_ns < 1.0);
  Require(epoch.boot_time_ns >= 0);
  for (const SignalObservation& signal : epoch.signals) {
    Require(signal.satellite.number >= 1);
    Require(signal.satellite.number <= LargestSatelliteNumber(signal.satellite.system));
    Require(signal.frequency_hz > 1e9 && signal.frequency_hz < 3e9);
    Require((signal.present & (kHasPseudorange | kHasCarrierPhase | kHasDoppler)) != 0);
    Require(signal.pseudorange_m == 0.0 ||
            (signal.pseudorange_m > 0.0 && signal.pseudorange_m < 80e6));
    Require(std::isfinite(signal.carrier_phase_cycles) && std::isfinite(signal.doppler_hz));
    Require(signal.cn0_dbhz >= 0.0 && signal.cn0_dbhz <= 65.0);
    Require(signal.pseudorange_sigma_m >= 0.0 && signal.pseudorange_sigma_m < 200.0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  AndroidObservables observables;
  MillisecondJumpRepair repair;
  AndroidEpoch raw;
  raw.clock.full_bias_ns = -1'300'000'000 * kSecond_ns;
  raw.clock.time_ns = 100 * kSecond_ns;
  raw.clock.present = kClockHasFullBias;
  ObservationEpoch epoch;
  std::vector<RawOutcome> outcomes;
  while (!bytes.empty()) {
    const auto kind = bytes.Take<std::uint8_t>();
    __builtin_add_overflow(raw.clock.time_ns, kSecond_ns, &raw.clock.time_ns);  // may wrap
    if ((kind & 1) != 0) raw.clock.time_ns = bytes.Take<std::int64_t>();
    if ((kind & 2) != 0) raw.clock.full_bias_ns = bytes.Take<std::int64_t>();
    if ((kind & 4) != 0) {
      __builtin_add_overflow(raw.clock.full_bias_ns, bytes.Take<std::int32_t>(),
                             &raw.clock.full_bias_ns);
    }
    if ((kind & 8) != 0) raw.clock.hardware_clock_discontinuity_count++;
    if ((kind & 16) != 0) {
      raw.clock.bias_ns = bytes.Take<double>();
      raw.clock.bias_uncertainty_ns = bytes.Take<double>();
      raw.clock.leap_second = bytes.Take<std::int32_t>();
      raw.clock.elapsed_realtime_ns = bytes.Take<std::int64_t>();
      raw.clock.present = bytes.Take<std::uint8_t>() | kClockHasFullBias;
    }
    raw.measurements.clear();
    for (int left = bytes.Take<std::uint8_t>() % 12; left > 0; --left) {
      std::int64_t gps_time_ns = 0;
      if (__builtin_sub_overflow(raw.clock.time_ns, raw.clock.full_bias_ns, &gps_time_ns) ||
          gps_time_ns < kSecond_ns) {
        gps_time_ns = kSecond_ns;
      }
      raw.measurements.push_back((kind & 32) != 0 ? AnyMeasurement(&bytes)
                                                  : LikelyMeasurement(&bytes, gps_time_ns));
    }
    const bool usable = observables.Convert(raw, &epoch, &outcomes);
    Require(outcomes.size() == raw.measurements.size());
    Require(usable || epoch.signals.empty());
    CheckEpoch(epoch);
    if (usable) repair.Repair(&epoch);
  }
  return 0;
}
