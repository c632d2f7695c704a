#include "core/fusion/motion_filter.h"

#include <Eigen/Cholesky>

#include "core/fusion/hear_place.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// 1 sigma an axis of a velocity that nobody knows, and of its vertical part.
constexpr double kAnySpeed_mps = 15.0;
constexpr double kAnyClimb_mps = 2.0;

Eigen::Matrix3d Turned(const Eigen::Matrix3d& enu_from_ecef, const Eigen::Vector3d& diagonal) {
  return enu_from_ecef.transpose() * diagonal.asDiagonal() * enu_from_ecef;
}

}  // namespace

void MotionFilter::Start(const Eigen::Vector3d& position_in_ecef,
                         const Eigen::Matrix3d& covariance_enu_m2) {
  started_ = true;
  step_ = MotionStep();
  step_.filtered.mean.head<3>() = position_in_ecef;
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(GeodeticFromEcef(position_in_ecef));
  MotionMatrix& covariance = step_.filtered.covariance;
  covariance.topLeftCorner<3, 3>() = enu_from_ecef.transpose() * covariance_enu_m2 * enu_from_ecef;
  covariance.bottomRightCorner<3, 3>() = Turned(
      enu_from_ecef, Eigen::Vector3d(kAnySpeed_mps * kAnySpeed_mps, kAnySpeed_mps * kAnySpeed_mps,
                                     kAnyClimb_mps * kAnyClimb_mps));
}

void MotionFilter::Start(const MotionState& state) {
  started_ = true;
  step_ = MotionStep();
  step_.filtered = state;
}

void MotionFilter::Advance(double seconds, std::span<const RangeRateObservation> rates,
                           std::span<const RangeChangeObservation> changes,
                           const MotionModel& model, MotionVerdicts* verdicts,
                           const std::optional<Rise>& rise) {
  const MotionState& before = step_.filtered;
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(before.mean.head<3>()));
  const Eigen::Matrix3d density = Turned(enu_from_ecef, model.acceleration_density_m2ps3);
  const double t = seconds;
  MotionMatrix noise;
  noise << density * (t * t * t / 3.0), density * (t * t / 2.0), density * (t * t / 2.0),
      density * t;
  MotionMatrix transition = MotionMatrix::Identity();
  transition.topRightCorner<3, 3>() = t * Eigen::Matrix3d::Identity();
  // Displacement and velocity are linear in the state before and the noise.
  MotionMatrix step_from_state = transition;
  step_from_state.topLeftCorner<3, 3>().setZero();
  StepKnowledge known;
  known.mean = step_from_state * before.mean;
  known.covariance = step_from_state * before.covariance * step_from_state.transpose() + noise;
  StepKnowledge found = AdjustStep(known, rates, changes, verdicts);
  verdicts->rise_square.reset();
  if (rise) verdicts->rise_square = HearRise(*rise, enu_from_ecef.row(2), &found);
  // What was found out of the step moves the states before and after as far as they hang on it.
  const MotionMatrix before_with_step = before.covariance * step_from_state.transpose();
  const MotionMatrix after_with_step = transition * before_with_step + noise;
  const Eigen::LDLT<StepMatrix> by_step(known.covariance);
  const MotionMatrix before_gain = by_step.solve(before_with_step.transpose()).transpose();
  const MotionMatrix after_gain = by_step.solve(after_with_step.transpose()).transpose();
  const StepVector moved = found.mean - known.mean;
  const StepMatrix shrunk = known.covariance - found.covariance;
  MotionStep next;
  next.begins = false;
  next.before.mean = before.mean + before_gain * moved;
  next.before.covariance = before.covariance - before_gain * shrunk * before_gain.transpose();
  next.predicted.mean = transition * before.mean + after_gain * moved;
  const MotionMatrix after = transition * before.covariance * transition.transpose() + noise -
                             after_gain * shrunk * after_gain.transpose();
  next.predicted.covariance = 0.5 * (after + after.transpose());
  const MotionMatrix after_with_before =
      transition * before.covariance - after_gain * shrunk * before_gain.transpose();
  next.gain = next.predicted.covariance.ldlt().solve(after_with_before).transpose();
  next.filtered = next.predicted;
  started_ = next.predicted.mean.allFinite() && next.predicted.covariance.allFinite() &&
             next.predicted.covariance.diagonal().minCoeff() > 0.0;
  if (!started_) return;
  step_ = next;
  clock_drift_mps_ = found.clock_drift_mps;
}

PositionStatement MotionFilter::Place() const {
  PositionStatement place;
  place.around_in_ecef = step_.filtered.mean.head<3>();
  place.information_pm2 = PositionCovarianceEnu().ldlt().solve(Eigen::Matrix3d::Identity());
  return place;
}

void MotionFilter::Hear(const PositionStatement& said) {
  MotionState& state = step_.filtered;
  state.mean += HearPlace(said, EnuFromEcefRotation(GeodeticFromEcef(state.mean.head<3>())),
                          &state.covariance);
}

Eigen::Matrix3d MotionFilter::CovarianceEnu(Eigen::Index first) const {
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(step_.filtered.mean.head<3>()));
  return enu_from_ecef * step_.filtered.covariance.block<3, 3>(first, first) *
         enu_from_ecef.transpose();
}

}  // namespace lodemark
