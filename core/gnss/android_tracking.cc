#include "core/gnss/android_tracking.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

// Satellites make 1.1 km/s, a crystal 10 ppm off 3 km/s.
constexpr double kLargestRate_mps = 5e3;
constexpr double kLargestRateSigma_mps = 20.0;
constexpr double kLargestTimeOffset_ns = 1e9;
constexpr double kLargestPhase_m = 1e12;
constexpr double kLargestPhaseSigma_m = 1.0;

// The mean of two Dopplers leaves what the acceleration changes by in between.
constexpr std::int64_t kPhaseGap_ns = 10 * kSecond_ns;
constexpr double kPhaseNoise_m = 0.5;
constexpr double kAcceleration_mps2 = 2.5;
constexpr std::size_t kFewestSharing = 4;

constexpr std::size_t kMostTracks = 1024;

// GnssMeasurement.ADR_STATE_*.
constexpr std::int32_t kAdrValid = 1;
constexpr std::int32_t kAdrReset = 2;
constexpr std::int32_t kAdrCycleSlip = 4;
constexpr std::int32_t kAdrHalfCycleResolved = 8;
constexpr std::int32_t kAdrHalfCycleReported = 16;

}  // namespace

bool HasUsableRangeRate(const AndroidMeasurement& raw) {
  if (!raw.Has(kMeasurementHasRangeRate)) return false;
  if (!(std::abs(raw.pseudorange_rate_mps) <= kLargestRate_mps)) return false;
  return !raw.Has(kMeasurementHasRangeRateUncertainty) ||
         std::abs(raw.pseudorange_rate_uncertainty_mps) <= kLargestRateSigma_mps;
}

double RangeMovedToEpoch(const AndroidMeasurement& raw) {
  if (!HasUsableRangeRate(raw) || !(std::abs(raw.time_offset_ns) <= kLargestTimeOffset_ns)) {
    return 0.0;
  }
  return -raw.pseudorange_rate_mps * 1e-9 * raw.time_offset_ns;
}

AndroidTrack* AndroidTracks::Find(SatelliteId satellite, SignalCode signal) {
  for (AndroidTrack& track : tracks_) {
    if (track.satellite == satellite && track.signal == signal) return &track;
  }
  return nullptr;
}

AndroidTrack* AndroidTracks::FindOrAdd(SatelliteId satellite, SignalCode signal) {
  if (AndroidTrack* found = Find(satellite, signal)) return found;
  AndroidTrack* track = nullptr;
  if (tracks_.size() < kMostTracks) {
    track = &tracks_.emplace_back();
  } else {
    const auto older = [](const AndroidTrack& a, const AndroidTrack& b) {
      return a.epoch < b.epoch;
    };
    track = &*std::min_element(tracks_.begin(), tracks_.end(), older);
    *track = AndroidTrack();
  }
  track->satellite = satellite;
  track->signal = signal;
  return track;
}

void AndroidTracks::ForgetBefore(std::int64_t epoch) {
  std::erase_if(tracks_, [&](const AndroidTrack& track) { return track.epoch < epoch; });
}

void AndroidTracks::BreakPhases() {
  for (AndroidTrack& track : tracks_) track.phase_valid = false;
}

std::optional<PhaseStep> AddPhase(const AndroidMeasurement& raw, std::int64_t time_ns,
                                  AndroidTrack* track, SignalObservation* observation) {
  const bool has_rate = HasUsableRangeRate(raw);
  const double rate_mps = has_rate ? raw.pseudorange_rate_mps : 0.0;
  const double rate_sigma_mps = has_rate && raw.Has(kMeasurementHasRangeRateUncertainty)
                                    ? std::abs(raw.pseudorange_rate_uncertainty_mps)
                                    : 0.0;
  const std::int32_t state = raw.accumulated_delta_range_state;
  const bool valid = raw.Has(kMeasurementHasAccumulatedDeltaRange) && (state & kAdrValid) != 0 &&
                     std::abs(raw.accumulated_delta_range_m) <= kLargestPhase_m;
  std::optional<PhaseStep> step;
  if (valid) {
    const double phase_m = raw.accumulated_delta_range_m + RangeMovedToEpoch(raw);
    observation->present |= kHasCarrierPhase;
    observation->carrier_phase_cycles = phase_m * observation->frequency_hz / kSpeedOfLight_mps;
    const double sigma_m = raw.accumulated_delta_range_uncertainty_m;
    if (sigma_m > 0.0 && sigma_m <= kLargestPhaseSigma_m) {
      observation->present |= kHasCarrierPhaseSigma;
      observation->carrier_phase_sigma_m = sigma_m;
    }
    if ((state & kAdrHalfCycleReported) != 0 && (state & kAdrHalfCycleResolved) == 0) {
      observation->flags |= kHalfCycleAmbiguous;
    }
    const std::int64_t elapsed_ns = time_ns - track->phase_time_ns;
    const bool continues = track->phase_valid && (state & (kAdrReset | kAdrCycleSlip)) == 0 &&
                           elapsed_ns > 0 && elapsed_ns <= kPhaseGap_ns;
    if (!continues) {
      observation->flags |= kLossOfLock;
    } else if (has_rate) {
      const double elapsed_s = 1e-9 * static_cast<double>(elapsed_ns);
      step.emplace();
      step->mismatch_m = phase_m - track->phase_m - 0.5 * (rate_mps + track->rate_mps) * elapsed_s;
      step->tolerance_m = kPhaseNoise_m +
                          1.5 * (rate_sigma_mps + track->rate_sigma_mps) * elapsed_s +
                          kAcceleration_mps2 * elapsed_s * elapsed_s;
    }
    track->phase_m = phase_m;
    track->phase_time_ns = time_ns;
  }
  track->phase_valid = valid && has_rate;
  track->rate_mps = rate_mps;
  track->rate_sigma_mps = rate_sigma_mps;
  return step;
}

void FlagSlips(const std::vector<PhaseStep>& steps, std::vector<double>* scratch,
               std::vector<SignalObservation>* signals) {
  double shared_m = 0.0;
  if (steps.size() >= kFewestSharing) {
    scratch->clear();
    for (const PhaseStep& step : steps) scratch->push_back(step.mismatch_m);
    const auto middle = scratch->begin() + static_cast<std::ptrdiff_t>(scratch->size() / 2);
    std::nth_element(scratch->begin(), middle, scratch->end());
    shared_m = *middle;
  }
  for (const PhaseStep& step : steps) {
    if (std::abs(step.mismatch_m - shared_m) > step.tolerance_m) {
      (*signals)[step.signal].flags |= kLossOfLock;
    }
  }
}

}  // namespace lodemark
