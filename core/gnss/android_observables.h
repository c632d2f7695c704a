// Raw Android measurements turned into code, phase and Doppler observations.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/gnss/android_measurement.h"
#include "core/gnss/observation.h"

namespace lodemark {

// Why a raw measurement gave no pseudorange.
enum class RawVerdict : std::uint8_t {
  kGood,
  kUnknownConstellation,
  kUnknownSatellite,
  kUnknownSignal,       // carrier frequency of no known signal
  kNotTracking,         // state without a usable code lock
  kTimeAmbiguous,       // week, day or millisecond could not be resolved
  kTimeUncertain,       // receivedSvTime uncertainty too large
  kImplausibleRange,
  kClockUnusable,       // the epoch's clock has no full bias
};

struct RawOutcome {
  std::size_t measurement = 0;  // index into AndroidEpoch::measurements
  RawVerdict verdict = RawVerdict::kGood;
};

// Holds the first FullBiasNanos until the hardware clock is discontinuous, and the carrier phase
// state of every signal.
class AndroidObservables {
 public:
  AndroidObservables();

  // Replaces *epoch and *outcomes (one per measurement). False if the clock gives no time at all;
  // then the epoch is empty. Allocates only while the vectors grow.
  bool Convert(const AndroidEpoch& raw, ObservationEpoch* epoch, std::vector<RawOutcome>* outcomes);

  void Reset();

 private:
  struct PhaseTrack {
    SatelliteId satellite;
    SignalCode signal;
    std::int64_t time_ns = 0;
    double delta_range_m = 0.0;
    double rate_mps = 0.0;
    bool valid = false;
  };

  bool has_bias_ = false;
  std::int64_t full_bias_ns_ = 0;
  double bias_ns_ = 0.0;
  std::int32_t discontinuity_count_ = 0;
  std::int64_t last_time_ns_ = 0;
  std::vector<PhaseTrack> tracks_;
};

}  // namespace lodemark
