// Raw Android measurements turned into code, phase and Doppler observations.
#pragma once

#include <cstdint>
#include <vector>

#include "core/gnss/android_measurement.h"
#include "core/gnss/android_signal.h"
#include "core/gnss/android_tracking.h"
#include "core/gnss/observation.h"

namespace lodemark {

struct RawOutcome {
  std::size_t measurement = 0;  // index into AndroidEpoch::measurements
  RawVerdict verdict = RawVerdict::kGood;
};

// Holds the phone's clock bias and the carrier phase state of every signal from epoch to epoch.
//
// The first bias is held, so that ranges drift with the hardware clock and with nothing else,
// until the hardware clock is discontinuous or its time runs backwards; until the phone's estimate
// of the bias steps by more than a clock can drift, as it does when a cold start gets its first
// fix; or until the held bias is 10 ms from the current one. An epoch that begins a new hold says
// clock_discontinuity.
//
// A clock that the decoded times of week of three or more satellites show to be off by more than
// a travel time explains, as phones report before their first fix, is set by whole milliseconds.
class AndroidObservables {
 public:
  AndroidObservables();

  // Replaces *epoch and *outcomes (one per measurement). False if the clock gives no time at all;
  // then the epoch is empty. Allocates only while the vectors grow.
  //
  // A measurement without a usable pseudorange still gives its Doppler and phase if it tracks the
  // code. A pseudorange whose time of transmission is known only modulo some period is resolved
  // where exactly one multiple makes a possible travel time, or from another signal of the same
  // satellite, or from the epochs before.
  bool Convert(const AndroidEpoch& raw, ObservationEpoch* epoch, std::vector<RawOutcome>* outcomes);

  // What is known about GLONASS channels; kept by Reset.
  GlonassChannels& glonass_channels() { return glonass_channels_; }

  void Reset();

 private:
  // One measurement on its way through Convert.
  struct Work {
    AndroidSignal signal;
    RawVerdict verdict = RawVerdict::kGood;
    bool tracking = false;
    std::int64_t period_ns = 0;
    // Reception by the held clock minus transmission, modulo the period, and its fraction.
    std::int64_t elapsed_ns = 0;
    double fraction_ns = 0.0;
    double pseudorange_m = 0.0;
    bool has_range = false;
    bool resolved_by_us = false;
  };

  // The phone's own reading of GPS time, as corrected; what ambiguities are resolved against.
  std::int64_t CurrentTime(const AndroidClock& clock) const;
  bool FollowClock(const AndroidClock& clock);
  void Hold(const AndroidClock& clock);
  void Identify(const AndroidEpoch& raw);
  bool CorrectClock(const AndroidEpoch& raw);
  void MeasureTravel(const AndroidMeasurement& raw, Work* work) const;
  void ResolveFromNeighbours(const AndroidEpoch& raw);
  static void AddRange(const Work& work, const AndroidMeasurement& measurement,
                       SignalObservation* observation);
  void Emit(const AndroidEpoch& raw, ObservationEpoch* epoch);

  GlonassChannels glonass_channels_;

  bool holding_ = false;
  std::int64_t hold_count_ = 0;
  std::int64_t held_bias_ns_ = 0;   // corrected full bias, whole nanoseconds
  double held_fraction_ns_ = 0.0;   // 0 <= fraction < 1, to be added to GPS time
  std::int64_t correction_ns_ = 0;  // our correction of the phone's GPS time
  std::int64_t last_time_ns_ = 0;
  std::int64_t last_full_bias_ns_ = 0;
  std::int32_t discontinuity_count_ = 0;

  std::int64_t epoch_count_ = 0;
  std::int64_t current_gps_ns_ = 0;  // CurrentTime of the epoch at hand
  std::int64_t held_minus_current_ns_ = 0;
  std::int64_t margin_ns_ = 0;  // how far current_gps_ns_ may be off
  bool clock_checked_ = false;  // current_gps_ns_ is good to margin_ns_
  int leap_seconds_ = 0;

  std::vector<Work> work_;
  AndroidTracks tracks_;
  std::vector<PhaseStep> phase_steps_;
  std::vector<double> scratch_;
};

}  // namespace lodemark
