// What a receiver measures: code, phase and Doppler of every signal, grouped by epoch.
#pragma once

#include <cstdint>
#include <vector>

#include "core/gnss/signal.h"

namespace lodemark {

// Which fields of a SignalObservation hold a value.
enum ObservationField : std::uint32_t {
  kHasPseudorange = 1u << 0,
  kHasCarrierPhase = 1u << 1,
  kHasDoppler = 1u << 2,
  kHasCn0 = 1u << 3,
  kHasPseudorangeSigma = 1u << 4,
  kHasCarrierPhaseSigma = 1u << 5,
  kHasRangeRateSigma = 1u << 6,
  kHasBasebandCn0 = 1u << 7,
  kHasAgc = 1u << 8,
};

// What the receiver says about a measurement.
enum ObservationFlag : std::uint32_t {
  kLossOfLock = 1u << 0,          // the phase may have slipped since the epoch before
  kHalfCycleAmbiguous = 1u << 1,  // the phase may be off by half a cycle
  kMultipathDetected = 1u << 2,
  kSignalTimeUncertain = 1u << 3,  // the whole-millisecond part of the range was resolved by us
};

// One signal of one satellite at one epoch. All values are finite and plausible; a field counts
// only if its bit in present is set.
struct SignalObservation {
  SatelliteId satellite;
  SignalCode signal;
  std::int8_t glonass_channel = kUnknownGlonassChannel;
  std::uint32_t present = 0;  // ObservationField bits
  std::uint32_t flags = 0;    // ObservationFlag bits
  double frequency_hz = 0.0;  // carrier; 0 if not known (GLONASS without a channel)

  double pseudorange_m = 0.0;         // c (reception - transmission), receiver clock included
  double carrier_phase_cycles = 0.0;  // grows with the range, arbitrary origin
  double doppler_hz = 0.0;            // positive when the satellite approaches
  double cn0_dbhz = 0.0;              // at the antenna
  double baseband_cn0_dbhz = 0.0;
  double agc_db = 0.0;
  double pseudorange_sigma_m = 0.0;  // as the receiver states it
  double carrier_phase_sigma_m = 0.0;
  double range_rate_sigma_mps = 0.0;

  bool Has(std::uint32_t fields) const { return (present & fields) == fields; }
};

// All signals measured at one instant of the receiver clock.
struct ObservationEpoch {
  std::int64_t time_gps_ns = 0;   // the receiver's reading, the tag the pseudoranges refer to
  double time_fraction_ns = 0.0;  // to be added to time_gps_ns
  std::int64_t boot_time_ns = 0;  // since boot, 0 if unknown
  // The receiver clock was reset or steered since the epoch before: its bias may have jumped.
  bool clock_discontinuity = false;
  std::vector<SignalObservation> signals;
};

}  // namespace lodemark
