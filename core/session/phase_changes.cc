#include "core/session/phase_changes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodemark {
namespace {

// Over longer gaps a receiver may have lost its lock and found it again unnoticed.
constexpr double kLongestGap_s = 3.5;

// Oscillators of satellites wander, and what the atmosphere changes is known in part.
constexpr double kWander_mps = 0.003;

// A phase that disagrees with the Doppler of its signal by so much has slipped. Accelerations make
// Doppler at one moment and its mean over a second differ, alike for all signals in part only.
constexpr double kSlipRate_mps = 3.0;
constexpr double kSlip_m = 0.5;

double MedianOf(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace

std::span<const RangeChangeObservation> PhaseChanges::Update(std::int64_t time_gps_ns,
                                                             const Eigen::Vector3d& place_in_ecef,
                                                             std::span<const TrackedPhase> phases) {
  changes_.clear();
  signals_.clear();
  against_rate_mps_.clear();
  sorted_mps_.clear();
  const double gap_s = 1e-9 * static_cast<double>(time_gps_ns - past_gps_ns_);
  if (gap_s > 0.0 && gap_s <= kLongestGap_s) {
    for (const TrackedPhase& now : phases) {
      const auto before = std::find_if(past_.begin(), past_.end(), [&](const TrackedPhase& past) {
        return past.satellite == now.satellite && past.signal == now.signal;
      });
      if (before == past_.end() || now.lost_lock || now.half_cycle != before->half_cycle ||
          now.orbit_gps_ns != before->orbit_gps_ns) {
        continue;
      }
      // From one place the satellite's motion is taken out, so the receiver's is seen from where
      // the satellite was.
      const Eigen::Vector3d line = before->satellite_in_ecef - place_in_ecef;
      const double distance_m = line.norm();
      RangeChangeObservation change;
      change.direction_in_ecef = line / distance_m;
      change.change_m = now.phase_m - before->phase_m -
                        ((now.satellite_in_ecef - place_in_ecef).norm() - distance_m);
      change.sigma_m = std::hypot(now.sigma_m, before->sigma_m, kWander_mps * gap_s);
      double against_rate_mps = std::numeric_limits<double>::quiet_NaN();
      if (now.rate_mps && before->rate_mps) {
        against_rate_mps =
            (now.phase_m - before->phase_m) / gap_s - 0.5 * (*now.rate_mps + *before->rate_mps);
        sorted_mps_.push_back(against_rate_mps);
      }
      changes_.push_back(change);
      signals_.push_back(now.index);
      against_rate_mps_.push_back(against_rate_mps);
    }
  }
  // What the signals share is how the receiver's clock counts phase against Doppler.
  const double common_mps = sorted_mps_.size() >= 3 ? MedianOf(&sorted_mps_) : 0.0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const double off_mps = std::abs(against_rate_mps_[i] - common_mps);
    if (off_mps > std::max(kSlipRate_mps, kSlip_m / gap_s)) continue;
    changes_[kept] = changes_[i];
    signals_[kept] = signals_[i];
    ++kept;
  }
  changes_.resize(kept);
  signals_.resize(kept);
  past_.assign(phases.begin(), phases.end());
  past_gps_ns_ = time_gps_ns;
  return changes_;
}

}  // namespace lodemark
