// By how much the carrier phase of each signal says its range changed since the epoch before.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/observation.h"
#include "core/gnss/observation.h"

namespace lodemark {

// A carrier phase with all that makes its range but the receiver.
struct TrackedPhase {
  std::size_t index = 0;  // into ObservationEpoch::signals
  SatelliteId satellite;
  SignalCode signal;
  Eigen::Vector3d satellite_in_ecef = Eigen::Vector3d::Zero();  // in the frame at reception
  // Phase as a distance, the satellite's clock and the atmosphere taken out.
  double phase_m = 0.0;
  double sigma_m = 0.01;
  std::optional<double> rate_mps;  // of the corrected phase, by Doppler, receiver included
  std::int64_t orbit_gps_ns = 0;   // which set of orbit and clock these are of
  bool lost_lock = false;          // since the epoch before
  bool half_cycle = false;         // may be off by half a cycle
};

// Remembers phases, never positions.
class PhaseChanges {
 public:
  // place_in_ecef: near the receiver. Changes of the signals that were followed without a break;
  // valid until the next call.
  std::span<const RangeChangeObservation> Update(std::int64_t time_gps_ns,
                                                 const Eigen::Vector3d& place_in_ecef,
                                                 std::span<const TrackedPhase> phases);
  // The signal of each change.
  std::span<const std::size_t> signals() const { return signals_; }  // of the epoch
  void Forget() { past_.clear(); }

 private:
  std::int64_t past_gps_ns_ = 0;
  std::vector<TrackedPhase> past_;
  std::vector<RangeChangeObservation> changes_;
  std::vector<std::size_t> signals_;
  std::vector<double> against_rate_mps_;
  std::vector<double> sorted_mps_;
};

}  // namespace lodemark
