// Position, velocity and verdicts of one GNSS epoch, and what epochs teach for those to come.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/clock_biases.h"
#include "core/fusion/combined_adjustment.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/position_witness.h"
#include "core/fusion/velocity_adjustment.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/satellite_orbits.h"
#include "core/session/code_rate_check.h"
#include "core/session/epoch_filter.h"
#include "core/session/gnss_epoch.h"
#include "core/session/height_memory.h"
#include "core/session/range_weights.h"
#include "core/session/session.h"

namespace lodemark {

// What a photograph brings to an epoch.
struct PhotoPart {
  PositionWitness* witness = nullptr;        // or
  std::span<const RangeObservation> ranges;  // visual ones, each for itself
  std::optional<Eigen::Vector3d> start_in_ecef;
  std::int64_t taken_ns = 0;  // in the session's time

  bool empty() const { return witness == nullptr && ranges.empty(); }
};

// What epochs and photographs leave behind for those to come, but for the steps of the filter.
struct EpochMemory {
  explicit EpochMemory(const SessionOptions& options);

  GnssEpochModel model;
  RangeWeights weights;
  CodeRateCheck code_rate;
  ClockBiases biases;
  HeightMemory height;
  EpochFilter filter;
  bool modelled = false;
  std::optional<Eigen::Vector3d> last_place_in_ecef;
  std::int64_t last_gps_ns = 0;
};

// Epochs come in the order of their time. Allocates only while they grow.
class EpochSolver {
 public:
  // sensors: what the filter may carry the motion by; null for nothing.
  explicit EpochSolver(const SessionOptions& options, const SensorBuffer* sensors = nullptr);

  SatelliteOrbits& orbits() { return orbits_; }
  IonosphereModel& ionosphere() { return ionosphere_; }
  void UseSights(SightSource* sights) { model_.UseSights(sights); }

  // Fills all of *estimate but its times, which are given, and the satellites seen; and one status
  // per signal.
  void Solve(const ObservationEpoch& epoch, const PhotoPart& photo, SessionEstimate* estimate,
             std::vector<SatelliteStatus>* statuses);
  // The photograph with the ranges of the last epoch, where there are any, or without. The estimate
  // is of the moment of that epoch, and nothing is learned from it.
  void SolvePhoto(const PhotoPart& photo, bool with_epoch, SessionEstimate* estimate);

  // At which moment a photograph of a time is to be heard: that of the filter if it is within
  // reach, to which it is carried if not; its own without a filter at work.
  std::int64_t MomentFor(std::int64_t time_ns, std::int64_t reach_ns);

  const EpochFilter& filter() const { return filter_; }

  // Of landmarks that came as ranges, by the last solution.
  std::span<const ObservationVerdict> visual_verdicts() const;

  // Allocates only while what is remembered grows.
  void Save(EpochMemory* memory) const;
  // As if nothing had come since it was saved.
  void GoBackTo(const EpochMemory& memory);

  // The receiver clock starts anew; biases between the groups stay.
  void ForgetRanges() { code_rate_.Forget(); }
  // Time starts anew.
  void ForgetTime();
  // All but orbits and ionosphere.
  void Forget();

 private:
  bool filters() const { return options_.estimator != Estimator::kEpoch; }
  EstimateStatus SolvePosition(std::int64_t time_ns, const ObservationEpoch& epoch,
                               const PhotoPart& photo, std::vector<SatelliteStatus>* statuses);
  // Satellites and photograph from a place near by.
  PointStatus Adjust(const Eigen::Vector3d& place, const PhotoPart& photo, bool with_epoch,
                     const PointOptions& options);
  PointOptions PointOptionsAt(std::int64_t time_gps_ns) const;
  void FillFromFilter(SessionEstimate* estimate) const;
  // Whether the ranges prove that the filter is elsewhere: then the adjustment is theirs alone.
  void LookForLostFilter(const Eigen::Vector3d& place, PointOptions options);
  // Where there was too little to adjust: the state of the filter, while it is good enough.
  bool Coast(SessionEstimate* estimate) const;
  void SolveVelocity(SessionEstimate* estimate, std::vector<SatelliteStatus>* statuses);
  void FillPosition(SessionEstimate* estimate) const;
  void Judge(SessionEstimate* estimate, std::vector<SatelliteStatus>* statuses) const;
  void Learn();

  SessionOptions options_;
  SatelliteOrbits orbits_;
  IonosphereModel ionosphere_;
  GnssEpochModel model_;
  RangeWeights weights_;
  CodeRateCheck code_rate_;
  ClockBiases biases_;
  HeightMemory height_;
  EpochFilter filter_;
  PointAdjustment adjustment_;
  CombinedAdjustment combined_adjustment_;
  CombinedEstimate combined_;
  std::vector<RangeObservation> ranges_;  // of satellites, then of landmarks
  std::size_t satellite_ranges_ = 0;
  bool modelled_ = false;  // the last epoch: there was a place to model it from
  PointEstimate point_;
  PointEstimate alone_;  // of the ranges without the filter
  std::vector<ObservationVerdict> verdicts_alone_;
  PhotoOutcome photo_ = PhotoOutcome::kNone;
  std::vector<ObservationVerdict> verdicts_;  // of ranges_
  std::vector<double> redundancy_;            // of each range
  VelocityEstimate velocity_;
  std::vector<RateVerdict> rate_verdicts_;
  std::optional<Eigen::Vector3d> last_place_in_ecef_;  // only where to linearise
  std::int64_t last_gps_ns_ = 0;
};

}  // namespace lodemark
