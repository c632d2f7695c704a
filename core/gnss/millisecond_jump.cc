#include "core/gnss/millisecond_jump.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kMillisecond_m = kSpeedOfLight_mps * 1e-3;
constexpr std::int64_t kLongestGap_ns = 60 * kSecond_ns;
constexpr std::int64_t kFurthest_ms = 10;

// How far from a whole millisecond a step may be: reflections and Dopplers that change over a
// minute make less than 6 km of range; without Dopplers satellites move by 800 m/s for 30 s.
constexpr double kTolerance_ms = 0.02;
constexpr double kToleranceWithoutDoppler_ms = 0.1;
constexpr std::size_t kFewestSignals = 2;
constexpr double kLargestStep_ms = 1e6;

}  // namespace

void MillisecondJumpRepair::Reset() { *this = MillisecondJumpRepair(); }

std::int32_t MillisecondJumpRepair::SharedStep(double tolerance_ms) {
  if (steps_ms_.size() < kFewestSignals) return 0;
  const auto middle = steps_ms_.begin() + static_cast<std::ptrdiff_t>(steps_ms_.size() / 2);
  std::nth_element(steps_ms_.begin(), middle, steps_ms_.end());
  const double whole_ms = std::round(*middle);
  const auto agreeing = static_cast<std::size_t>(
      std::count_if(steps_ms_.begin(), steps_ms_.end(),
                    [&](double step_ms) { return std::abs(step_ms - whole_ms) <= tolerance_ms; }));
  if (agreeing < kFewestSignals || 3 * agreeing < 2 * steps_ms_.size()) return 0;
  return static_cast<std::int32_t>(whole_ms);
}

std::optional<MillisecondJump> MillisecondJumpRepair::Find(const ObservationEpoch& epoch) {
  const std::int64_t elapsed_ns = epoch.time_gps_ns - last_time_ns_;
  if (!has_last_ || epoch.clock_discontinuity || elapsed_ns <= 0 || elapsed_ns > kLongestGap_ns) {
    interval_ns_ = 0;
    return std::nullopt;
  }
  const double elapsed_s = 1e-9 * static_cast<double>(elapsed_ns);

  // First the codes, then the phases, each against the mean of the Dopplers at both ends.
  std::int32_t stepped_ms[2] = {0, 0};
  bool every_doppler = true;
  for (const bool phase : {false, true}) {
    steps_ms_.clear();
    std::size_t hint = 0;
    for (const SignalObservation& signal : epoch.signals) {
      if (!signal.Has(phase ? kHasCarrierPhase : kHasPseudorange)) continue;
      const auto same = [&](const Last& last) {
        return last.satellite == signal.satellite && last.signal == signal.signal;
      };
      // Epochs list their signals in nearly the same order.
      auto found =
          std::find_if(last_.begin() + static_cast<std::ptrdiff_t>(hint), last_.end(), same);
      if (found == last_.end()) found = std::find_if(last_.begin(), last_.end(), same);
      if (found == last_.end()) continue;
      hint = static_cast<std::size_t>(found - last_.begin());
      if ((found->present & (phase ? kHasCarrierPhase : kHasPseudorange)) == 0) continue;

      const double wavelength_m = kSpeedOfLight_mps / signal.frequency_hz;
      double rate_mps = 0.0;
      if (signal.Has(kHasDoppler) && (found->present & kHasDoppler) != 0) {
        rate_mps = 0.5 * (found->rate_mps - signal.doppler_hz * wavelength_m);
      } else {
        every_doppler = false;
      }
      const double step_m = phase ? signal.carrier_phase_cycles * wavelength_m - found->phase_m
                                  : signal.pseudorange_m - found->range_m;
      const double step_ms = (step_m - rate_mps * elapsed_s) / kMillisecond_m;
      if (std::abs(step_ms) < kLargestStep_ms) steps_ms_.push_back(step_ms);
    }
    stepped_ms[phase ? 1 : 0] =
        SharedStep(every_doppler ? kTolerance_ms : kToleranceWithoutDoppler_ms);
  }

  const std::int32_t code_ms = stepped_ms[0];
  const std::int32_t phase_ms = stepped_ms[1];
  const std::int64_t expected_ns = interval_ns_;
  const bool tag_moved = expected_ns > 0 && std::abs(elapsed_ns - code_ms * kMillisecond_ns -
                                                     expected_ns) < kMillisecond_ns / 2;
  interval_ns_ = elapsed_ns - (tag_moved ? code_ms * kMillisecond_ns : 0);
  if (code_ms == 0 && phase_ms == 0) return std::nullopt;

  MillisecondJump jump;
  jump.time_gps_ns = epoch.time_gps_ns;
  jump.milliseconds = code_ms != 0 ? code_ms : phase_ms;
  using Kind = MillisecondJump::Kind;
  if (code_ms == 0) {
    jump.kind = Kind::kPhase;
  } else if (phase_ms == code_ms) {
    jump.kind = tag_moved ? Kind::kTagCodeAndPhase : Kind::kCodeAndPhase;
  } else {
    jump.kind = tag_moved ? Kind::kTagAndCode : Kind::kCode;
  }
  return jump;
}

void MillisecondJumpRepair::Keep(const ObservationEpoch& epoch) {
  last_.clear();
  for (const SignalObservation& signal : epoch.signals) {
    const double wavelength_m = kSpeedOfLight_mps / signal.frequency_hz;
    last_.push_back({signal.satellite, signal.signal, signal.present, signal.pseudorange_m,
                     signal.carrier_phase_cycles * wavelength_m,
                     -signal.doppler_hz * wavelength_m});
  }
  last_time_ns_ = epoch.time_gps_ns;
  has_last_ = true;
}

std::optional<MillisecondJump> MillisecondJumpRepair::Repair(ObservationEpoch* epoch) {
  const std::optional<MillisecondJump> jump = Find(*epoch);
  Keep(*epoch);

  if (jump) {
    using Kind = MillisecondJump::Kind;
    if (jump->kind != Kind::kPhase) moved_ms_ += jump->milliseconds;
    if (jump->kind != Kind::kCode && jump->kind != Kind::kTagAndCode) {
      phase_moved_ms_ += jump->milliseconds;
    }
  }
  if (std::abs(moved_ms_) > kFurthest_ms) {
    moved_ms_ = 0;
    epoch->clock_discontinuity = true;
  }
  if (moved_ms_ == 0 && phase_moved_ms_ == 0) return jump;

  epoch->time_gps_ns -= moved_ms_ * kMillisecond_ns;
  for (SignalObservation& signal : epoch->signals) {
    signal.pseudorange_m -= static_cast<double>(moved_ms_) * kMillisecond_m;
    signal.carrier_phase_cycles -=
        static_cast<double>(phase_moved_ms_) * 1e-3 * signal.frequency_hz;
  }
  return jump;
}

}  // namespace lodemark
