// Position, velocity and verdicts of one GNSS epoch, and what epochs teach for those to come.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fusion/clock_biases.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/velocity_adjustment.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/satellite_orbits.h"
#include "core/session/code_rate_check.h"
#include "core/session/gnss_epoch.h"
#include "core/session/height_memory.h"
#include "core/session/range_weights.h"
#include "core/session/session.h"

namespace lodemark {

// Epochs come in the order of their time. Allocates only while they grow.
class EpochSolver {
 public:
  explicit EpochSolver(const SessionOptions& options);

  SatelliteOrbits& orbits() { return orbits_; }
  IonosphereModel& ionosphere() { return ionosphere_; }

  // Fills all of *estimate but its times and the satellites seen, and one status per signal.
  void Solve(const ObservationEpoch& epoch, SessionEstimate* estimate,
             std::vector<SatelliteStatus>* statuses);

  // The receiver clock starts anew; biases between the groups stay.
  void ForgetRanges() { code_rate_.Forget(); }
  // Time starts anew.
  void ForgetTime();
  // All but orbits and ionosphere.
  void Forget();

 private:
  EstimateStatus SolvePosition(const ObservationEpoch& epoch,
                               std::vector<SatelliteStatus>* statuses);
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
  PointAdjustment adjustment_;
  PointEstimate point_;
  std::vector<ObservationVerdict> verdicts_;
  std::vector<double> redundancy_;  // of each range
  VelocityEstimate velocity_;
  std::vector<RateVerdict> rate_verdicts_;
  std::optional<Eigen::Vector3d> last_place_in_ecef_;  // only where to linearise
  std::int64_t last_gps_ns_ = 0;
};

}  // namespace lodemark
