#include "core/gnss/android_observables.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/android_signal_time.h"

namespace lodemark {
namespace {

// The phone's estimate of its bias may move by this much between two epochs without the clock
// having jumped: 10 ppm of the time between, more than any crystal, and 1 ms for a better fix.
constexpr std::int64_t kBiasStep_ns = kMillisecond_ns;
constexpr std::int64_t kDriftDivisor = 100'000;
// Beyond this the held bias is renewed, so that ranges stay near what satellites can have.
constexpr std::int64_t kLargestHeldError_ns = 10 * kMillisecond_ns;

// A bias with a larger 3 sigma is not trusted until decoded times of week confirm it.
constexpr double kTrustedBias_ns = 5e6;
constexpr std::int64_t kTrustedMargin_ns = 2 * kMillisecond_ns;
constexpr std::int64_t kConfirmedMargin_ns = 40 * kMillisecond_ns;
constexpr std::size_t kConfirmingSatellites = 3;
constexpr std::int64_t kTypicalTravel_ns = 78 * kMillisecond_ns;
constexpr std::int64_t kShortestTravel_ns = 53 * kMillisecond_ns;
constexpr std::int64_t kLongestTravel_ns = 148 * kMillisecond_ns;

// Google's "GNSS raw measurements" guide: a received time worse than this is of no use (150 m).
constexpr std::int64_t kLargestTimeUncertainty_ns = 500;
constexpr double kLargestTimeOffset_ns = 1e9;

constexpr double kLargestCn0_dbhz = 65.0;
constexpr double kLargestAgc_db = 200.0;

// Signals of one satellite differ by the ionosphere and inter-signal biases, well below 3 km.
constexpr double kSignalsApart_m = 3e3;
constexpr std::int64_t kPredictable_ns = 30 * kSecond_ns;
constexpr double kPredictionError_m = 30e3;

constexpr std::int64_t kForgottenAfterEpochs = 600;

constexpr std::int32_t kMultipathIndicated = 1;  // GnssMeasurement.MULTIPATH_INDICATOR_DETECTED

// The year 2075, and 31 years since power-on: keep all sums below far from the ends of int64.
constexpr std::int64_t kLatest_ns = 3'000'000'000 * kSecond_ns;
constexpr std::int64_t kLongestRun_ns = 1'000'000'000 * kSecond_ns;

bool IsUsable(const AndroidClock& clock) {
  if (!clock.Has(kClockHasFullBias)) return false;
  if (clock.time_ns < -kLongestRun_ns || clock.time_ns > kLongestRun_ns) return false;
  if (clock.full_bias_ns < -kLatest_ns || clock.full_bias_ns > kLatest_ns) return false;
  const std::int64_t gps_ns = clock.time_ns - clock.full_bias_ns;
  return gps_ns > 2 * kWeek_ns && gps_ns < kLatest_ns;
}

double BiasFraction(const AndroidClock& clock) {
  const bool usable = clock.Has(kClockHasBias) && std::abs(clock.bias_ns) < 1e9;
  return usable ? clock.bias_ns : 0.0;
}

bool IsFiniteWithin(double value, double largest) { return std::abs(value) <= largest; }

double MedianOf(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

void AddDoppler(const AndroidMeasurement& measurement, SignalObservation* observation) {
  if (!HasUsableRangeRate(measurement)) return;
  observation->present |= kHasDoppler;
  observation->doppler_hz =
      -measurement.pseudorange_rate_mps * observation->frequency_hz / kSpeedOfLight_mps;
  if (measurement.Has(kMeasurementHasRangeRateUncertainty) &&
      measurement.pseudorange_rate_uncertainty_mps > 0.0) {
    observation->present |= kHasRangeRateSigma;
    observation->range_rate_sigma_mps = measurement.pseudorange_rate_uncertainty_mps;
  }
}

void AddStrengths(const AndroidMeasurement& measurement, SignalObservation* observation) {
  if (measurement.Has(kMeasurementHasCn0) && measurement.cn0_dbhz > 0.0 &&
      measurement.cn0_dbhz <= kLargestCn0_dbhz) {
    observation->present |= kHasCn0;
    observation->cn0_dbhz = measurement.cn0_dbhz;
  }
  if (measurement.Has(kMeasurementHasBasebandCn0) && measurement.baseband_cn0_dbhz > 0.0 &&
      measurement.baseband_cn0_dbhz <= kLargestCn0_dbhz) {
    observation->present |= kHasBasebandCn0;
    observation->baseband_cn0_dbhz = measurement.baseband_cn0_dbhz;
  }
  if (measurement.Has(kMeasurementHasAgc) && IsFiniteWithin(measurement.agc_db, kLargestAgc_db)) {
    observation->present |= kHasAgc;
    observation->agc_db = measurement.agc_db;
  }
  if (measurement.multipath_indicator == kMultipathIndicated) {
    observation->flags |= kMultipathDetected;
  }
}

}  // namespace

AndroidObservables::AndroidObservables() = default;

void AndroidObservables::Reset() {
  const GlonassChannels channels = glonass_channels_;
  *this = AndroidObservables();
  glonass_channels_ = channels;
}

std::int64_t AndroidObservables::CurrentTime(const AndroidClock& clock) const {
  return clock.time_ns - clock.full_bias_ns + correction_ns_;
}

void AndroidObservables::Hold(const AndroidClock& clock) {
  const double less_ns = -BiasFraction(clock);
  double whole_ns = std::floor(less_ns);
  held_fraction_ns_ = less_ns - whole_ns;
  if (held_fraction_ns_ >= 1.0) {  // a negative hair below zero rounds up
    held_fraction_ns_ = 0.0;
    whole_ns += 1.0;
  }
  held_bias_ns_ = clock.full_bias_ns - correction_ns_ - static_cast<std::int64_t>(whole_ns);
  holding_ = true;
  ++hold_count_;
}

// Begins a new hold where the clock asks for one; true if the clock of the epochs before was lost.
bool AndroidObservables::FollowClock(const AndroidClock& clock) {
  const bool first = !holding_;
  const bool restarted = clock.hardware_clock_discontinuity_count != discontinuity_count_ ||
                         clock.time_ns < last_time_ns_;
  const std::int64_t elapsed_ns = clock.time_ns - last_time_ns_;
  const std::int64_t step_ns = clock.full_bias_ns - last_full_bias_ns_;
  const bool stepped = std::abs(step_ns) > kBiasStep_ns + std::abs(elapsed_ns) / kDriftDivisor;
  if (first || restarted || stepped) correction_ns_ = 0;
  const std::int64_t held_error_ns = clock.full_bias_ns - correction_ns_ - held_bias_ns_;
  const bool renew = std::abs(held_error_ns) > kLargestHeldError_ns;

  discontinuity_count_ = clock.hardware_clock_discontinuity_count;
  last_time_ns_ = clock.time_ns;
  last_full_bias_ns_ = clock.full_bias_ns;
  if (first || restarted || stepped || renew) Hold(clock);
  // The hardware clock carries the phase; an estimate of its bias does not.
  if (restarted) {
    tracks_.BreakPhases();
  }
  return !first && (restarted || stepped || renew);
}

void AndroidObservables::Identify(const AndroidEpoch& raw) {
  work_.clear();
  for (const AndroidMeasurement& measurement : raw.measurements) {
    Work& work = work_.emplace_back();
    work.verdict = IdentifySignal(measurement, glonass_channels_, &work.signal);
    if (work.verdict != RawVerdict::kGood) continue;
    work.tracking =
        HasCodeLock(measurement.state) || measurement.Has(kMeasurementHasGivenPseudorange);
    work.period_ns = AmbiguityPeriodNanoseconds(measurement.state, work.signal.satellite.system,
                                                work.signal.signal);
    if (!work.tracking) {
      work.verdict = RawVerdict::kNotTracking;
    } else if (measurement.Has(kMeasurementHasReceivedTimeUncertainty) &&
               measurement.received_sv_time_uncertainty_ns > kLargestTimeUncertainty_ns) {
      work.verdict = RawVerdict::kTimeUncertain;
    }
  }
}

// Checks the clock against decoded times of week and corrects it where they disagree. True if it
// was corrected, and so held anew.
bool AndroidObservables::CorrectClock(const AndroidEpoch& raw) {
  const AndroidClock& clock = raw.clock;
  const bool uncertain = clock.Has(kClockHasBiasUncertainty) &&
                         !(std::abs(3.0 * clock.bias_uncertainty_ns) <= kTrustedBias_ns);
  scratch_.clear();
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const Work& work = work_[i];
    if (work.verdict != RawVerdict::kGood || work.period_ns < kDay_ns) continue;
    const std::int64_t sent_ns = raw.measurements[i].received_sv_time_ns;
    if (sent_ns < 0 || sent_ns > work.period_ns) continue;
    const std::int64_t received_ns =
        current_gps_ns_ - SystemTimeOffsetNanoseconds(work.signal.satellite.system, leap_seconds_);
    const std::int64_t half_ns = work.period_ns / 2;
    scratch_.push_back(static_cast<double>(
        FloorModulo(received_ns - sent_ns + half_ns, work.period_ns) - half_ns));
  }
  clock_checked_ = !uncertain;
  margin_ns_ = uncertain ? kConfirmedMargin_ns : kTrustedMargin_ns;
  if (clock.Has(kClockHasBiasUncertainty) && !uncertain) {
    margin_ns_ += static_cast<std::int64_t>(std::abs(3.0 * clock.bias_uncertainty_ns));
  }
  if (correction_ns_ != 0) margin_ns_ = kConfirmedMargin_ns;
  if (scratch_.size() < kConfirmingSatellites) return false;

  const auto median_ns = static_cast<std::int64_t>(MedianOf(&scratch_));
  const auto agree = [&](double travel_ns) {
    return std::abs(travel_ns - static_cast<double>(median_ns)) <
           static_cast<double>(kConfirmedMargin_ns);
  };
  const auto agreeing =
      static_cast<std::size_t>(std::count_if(scratch_.begin(), scratch_.end(), agree));
  if (agreeing < kConfirmingSatellites || 2 * agreeing <= scratch_.size()) return false;
  clock_checked_ = true;
  if (median_ns >= kShortestTravel_ns && median_ns <= kLongestTravel_ns) return false;

  const std::int64_t correction_ns =
      correction_ns_ + (kTypicalTravel_ns - median_ns) / kMillisecond_ns * kMillisecond_ns;
  if (std::abs(correction_ns) > kWeek_ns) return false;
  correction_ns_ = correction_ns;
  margin_ns_ = kConfirmedMargin_ns;
  Hold(clock);
  return true;
}

// Sets the elapsed time, and the range where the elapsed time leaves one possible value.
void AndroidObservables::MeasureTravel(const AndroidMeasurement& raw, Work* work) const {
  if (!IsFiniteWithin(raw.time_offset_ns, kLargestTimeOffset_ns) || raw.received_sv_time_ns < 0 ||
      raw.received_sv_time_ns > kWeek_ns) {
    work->verdict = RawVerdict::kImplausibleRange;
    return;
  }
  const System system = work->signal.satellite.system;
  const double whole_offset_ns = std::floor(raw.time_offset_ns);
  const std::int64_t received_ns = current_gps_ns_ -
                                   SystemTimeOffsetNanoseconds(system, leap_seconds_) +
                                   static_cast<std::int64_t>(whole_offset_ns);
  const TravelTimes possible = PossibleTravelTimes(system);
  const std::int64_t shortest_ns = possible.shortest_ns - margin_ns_;
  const std::int64_t longest_ns = possible.longest_ns + margin_ns_;
  // The smallest travel time that is not too short.
  const std::int64_t travel_ns =
      shortest_ns +
      FloorModulo(received_ns - raw.received_sv_time_ns - shortest_ns, work->period_ns);

  work->elapsed_ns = travel_ns + held_minus_current_ns_;
  work->fraction_ns = held_fraction_ns_ + raw.time_offset_ns - whole_offset_ns;
  const bool unique = travel_ns + work->period_ns > longest_ns;
  if (!unique || (!clock_checked_ && work->period_ns < kDay_ns)) {
    work->verdict = RawVerdict::kTimeAmbiguous;
  } else if (travel_ns > longest_ns) {
    work->verdict = RawVerdict::kImplausibleRange;
  } else {
    work->has_range = true;
    work->resolved_by_us = work->period_ns < kSecond_ns;
    work->pseudorange_m =
        kSpeedOfLight_mps * 1e-9 * (static_cast<double>(work->elapsed_ns) + work->fraction_ns) +
        RangeMovedToEpoch(raw);
  }
}

// Ranges still ambiguous, from another signal of the satellite or from the epochs before.
void AndroidObservables::ResolveFromNeighbours(const AndroidEpoch& raw) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    Work& work = work_[i];
    if (work.verdict != RawVerdict::kTimeAmbiguous) continue;
    std::optional<double> expected_m;
    double tolerance_m = kSignalsApart_m;
    for (const Work& other : work_) {
      if (other.has_range && !other.resolved_by_us &&
          other.signal.satellite == work.signal.satellite) {
        expected_m = other.pseudorange_m;
      }
    }
    if (!expected_m) {
      const AndroidTrack* track = tracks_.Find(work.signal.satellite, work.signal.signal);
      const std::int64_t age_ns = track ? raw.clock.time_ns - track->range_time_ns : 0;
      if (track && track->range_hold == hold_count_ && age_ns > 0 && age_ns < kPredictable_ns) {
        expected_m = track->range_m + 1e-9 * static_cast<double>(age_ns) * track->rate_mps;
        tolerance_m = kPredictionError_m;
      }
    }
    if (!expected_m) continue;
    const double period_m = kSpeedOfLight_mps * 1e-9 * static_cast<double>(work.period_ns);
    const double range_m =
        kSpeedOfLight_mps * 1e-9 * (static_cast<double>(work.elapsed_ns) + work.fraction_ns) +
        RangeMovedToEpoch(raw.measurements[i]);
    const double resolved_m = range_m + period_m * std::round((*expected_m - range_m) / period_m);
    if (std::abs(resolved_m - *expected_m) > tolerance_m) continue;
    work.pseudorange_m = resolved_m;
    work.has_range = true;
    work.resolved_by_us = true;
    work.verdict = RawVerdict::kGood;
  }
}

void AndroidObservables::AddRange(const Work& work, const AndroidMeasurement& measurement,
                                  SignalObservation* observation) {
  observation->present |= kHasPseudorange;
  observation->pseudorange_m = work.pseudorange_m;
  if (work.resolved_by_us) observation->flags |= kSignalTimeUncertain;
  if (measurement.Has(kMeasurementHasReceivedTimeUncertainty) &&
      measurement.received_sv_time_uncertainty_ns > 0) {
    observation->present |= kHasPseudorangeSigma;
    observation->pseudorange_sigma_m =
        kSpeedOfLight_mps * 1e-9 * static_cast<double>(measurement.received_sv_time_uncertainty_ns);
  }
}

void AndroidObservables::Emit(const AndroidEpoch& raw, ObservationEpoch* epoch) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    Work& work = work_[i];
    if (!work.tracking) continue;
    const AndroidMeasurement& measurement = raw.measurements[i];
    AndroidTrack* track = tracks_.FindOrAdd(work.signal.satellite, work.signal.signal);
    if (track->epoch == epoch_count_) {
      work.verdict = RawVerdict::kDuplicate;
      continue;
    }
    track->epoch = epoch_count_;

    SignalObservation observation;
    observation.satellite = work.signal.satellite;
    observation.signal = work.signal.signal;
    observation.glonass_channel = work.signal.glonass_channel;
    observation.frequency_hz = work.signal.frequency_hz;
    if (work.has_range) {
      AddRange(work, measurement, &observation);
      track->range_m = work.pseudorange_m;
      track->range_time_ns = raw.clock.time_ns;
      track->range_hold = hold_count_;
    }
    AddDoppler(measurement, &observation);
    AddStrengths(measurement, &observation);
    std::optional<PhaseStep> step = AddPhase(measurement, raw.clock.time_ns, track, &observation);
    if (step) {
      step->signal = epoch->signals.size();
      phase_steps_.push_back(*step);
    }
    constexpr std::uint32_t kAny = kHasPseudorange | kHasCarrierPhase | kHasDoppler;
    if ((observation.present & kAny) != 0) epoch->signals.push_back(observation);
  }
}

bool AndroidObservables::Convert(const AndroidEpoch& raw, ObservationEpoch* epoch,
                                 std::vector<RawOutcome>* outcomes) {
  epoch->signals.clear();
  epoch->time_gps_ns = 0;
  epoch->time_fraction_ns = 0.0;
  epoch->clock_discontinuity = false;
  epoch->boot_time_ns = raw.clock.Has(kClockHasElapsedRealtime)
                            ? std::max<std::int64_t>(raw.clock.elapsed_realtime_ns, 0)
                            : 0;
  outcomes->clear();
  if (!IsUsable(raw.clock)) {
    for (std::size_t i = 0; i < raw.measurements.size(); ++i) {
      outcomes->push_back({i, RawVerdict::kClockUnusable});
    }
    return false;
  }

  ++epoch_count_;
  phase_steps_.clear();
  epoch->clock_discontinuity = FollowClock(raw.clock);
  current_gps_ns_ = CurrentTime(raw.clock);
  leap_seconds_ = LeapSecondsAtGps(current_gps_ns_);
  if (raw.clock.Has(kClockHasLeapSecond) &&
      std::abs(static_cast<double>(raw.clock.leap_second) - leap_seconds_) <= 1.0) {
    leap_seconds_ = raw.clock.leap_second;
  }
  Identify(raw);
  if (CorrectClock(raw)) {
    epoch->clock_discontinuity = epoch_count_ > 1;
    current_gps_ns_ = CurrentTime(raw.clock);
  }
  epoch->time_gps_ns = raw.clock.time_ns - held_bias_ns_;
  epoch->time_fraction_ns = held_fraction_ns_;
  held_minus_current_ns_ = epoch->time_gps_ns - current_gps_ns_;

  for (std::size_t i = 0; i < work_.size(); ++i) {
    if (work_[i].verdict != RawVerdict::kGood) continue;
    const AndroidMeasurement& measurement = raw.measurements[i];
    if (measurement.Has(kMeasurementHasGivenPseudorange)) {
      const TravelTimes possible = PossibleTravelTimes(work_[i].signal.satellite.system);
      const double given_ns = measurement.given_pseudorange_m * 1e9 / kSpeedOfLight_mps;
      const double slack_ns = static_cast<double>(kConfirmedMargin_ns);
      work_[i].has_range = given_ns >= static_cast<double>(possible.shortest_ns) - slack_ns &&
                           given_ns <= static_cast<double>(possible.longest_ns) + slack_ns;
      work_[i].pseudorange_m = measurement.given_pseudorange_m;
      if (!work_[i].has_range) work_[i].verdict = RawVerdict::kImplausibleRange;
    } else {
      MeasureTravel(measurement, &work_[i]);
    }
  }
  ResolveFromNeighbours(raw);
  Emit(raw, epoch);
  FlagSlips(phase_steps_, &scratch_, &epoch->signals);
  for (std::size_t i = 0; i < work_.size(); ++i) outcomes->push_back({i, work_[i].verdict});
  if (epoch_count_ % kForgottenAfterEpochs == 0) {
    tracks_.ForgetBefore(epoch_count_ - kForgottenAfterEpochs);
  }
  return true;
}

}  // namespace lodemark
