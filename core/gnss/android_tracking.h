// How a phone tracks each signal from epoch to epoch: range rates, carrier phases and their slips.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/gnss/android_measurement.h"
#include "core/gnss/observation.h"

namespace lodemark {

// True for a range rate and an uncertainty that a satellite and a crystal can have.
bool HasUsableRangeRate(const AndroidMeasurement& raw);

// Metres to add to a range measured TimeOffsetNanos after the epoch to have it at the epoch; 0
// without a range rate.
double RangeMovedToEpoch(const AndroidMeasurement& raw);

// What the epochs before leave of one signal.
struct AndroidTrack {
  SatelliteId satellite;
  SignalCode signal;
  std::int64_t epoch = 0;          // count of the last epoch it was in
  std::int64_t range_time_ns = 0;  // hardware clock
  double range_m = 0.0;
  std::int64_t range_hold = -1;  // count of the clock hold it belongs to, -1: no range
  std::int64_t phase_time_ns = 0;
  double phase_m = 0.0;
  double rate_mps = 0.0;
  double rate_sigma_mps = 0.0;
  bool phase_valid = false;
};

// The tracks of all signals, a bounded number of them.
class AndroidTracks {
 public:
  AndroidTrack* Find(SatelliteId satellite, SignalCode signal);
  // The one unused for longest makes room once there are too many.
  AndroidTrack* FindOrAdd(SatelliteId satellite, SignalCode signal);
  void ForgetBefore(std::int64_t epoch);
  // The next phase of every signal has lost lock.
  void BreakPhases();

 private:
  std::vector<AndroidTrack> tracks_;
};

// A phase against its range rates since the epoch before.
struct PhaseStep {
  std::size_t signal = 0;  // index into ObservationEpoch::signals
  double mismatch_m = 0.0;
  double tolerance_m = 0.0;
};

// Adds the carrier phase, if valid, to the observation and updates the track. kLossOfLock where
// the phone says so, after a gap, and where nothing came before; else the step to be judged by
// FlagSlips, its signal still unset.
std::optional<PhaseStep> AddPhase(const AndroidMeasurement& raw, std::int64_t time_ns,
                                  AndroidTrack* track, SignalObservation* observation);

// Sets kLossOfLock where a step disagrees with its range rates by more than its tolerance. What
// all signals share is the clock's, and how the phone derives its rates: it is no slip.
void FlagSlips(const std::vector<PhaseStep>& steps, std::vector<double>* scratch,
               std::vector<SignalObservation>* signals);

}  // namespace lodemark
