// Position and velocity carried from moment to moment: an error-state Kalman filter. Its time
// update hears Doppler and carrier phase; what it then knows of the place is a statement like any
// other.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/fusion/acceleration_memory.h"
#include "core/fusion/motion_smoother.h"
#include "core/fusion/observation.h"
#include "core/fusion/position_statement.h"
#include "core/fusion/rise.h"
#include "core/fusion/step_adjustment.h"

namespace lodemark {

class MotionFilter {
 public:
  bool started() const { return started_; }
  Eigen::Vector3d position_in_ecef() const { return step_.filtered.mean.head<3>(); }
  Eigen::Vector3d velocity_in_ecef_mps() const { return step_.filtered.mean.tail<3>(); }
  double clock_drift_mps() const { return clock_drift_mps_; }

  // Begins at a position; nothing is known of the velocity but that it is a person's or a car's.
  void Start(const Eigen::Vector3d& position_in_ecef, const Eigen::Matrix3d& covariance_enu_m2);
  // Begins at a state that was known otherwise.
  void Start(const MotionState& state);
  void Stop() { started_ = false; }

  // Carries the state on, for a millisecond at least; stops where numbers run out. rates: at the
  // new moment; changes: since the moment of the state. Both robustly: what contradicts the rest
  // counts for little, and a rise that contradicts it for nothing.
  void Advance(double seconds, std::span<const RangeRateObservation> rates,
               std::span<const RangeChangeObservation> changes, const MotionModel& model,
               MotionVerdicts* verdicts, const std::optional<Rise>& rise = {});

  // What is known of the position.
  PositionStatement Place() const;
  // Hears an independent statement around that place.
  void Hear(const PositionStatement& said);

  // The latest time update with all that was heard since.
  const MotionStep& step() const { return step_; }

  Eigen::Matrix3d PositionCovarianceEnu() const { return CovarianceEnu(0); }
  Eigen::Matrix3d VelocityCovarianceEnu() const { return CovarianceEnu(3); }

 private:
  Eigen::Matrix3d CovarianceEnu(Eigen::Index first) const;

  bool started_ = false;
  MotionStep step_;
  double clock_drift_mps_ = 0.0;
};

}  // namespace lodemark
