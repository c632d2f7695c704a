#include "core/fusion/inertial_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/fusion/hear_place.h"
#include "core/geo/geodetic.h"
#include "core/geo/gravity.h"
#include "core/geo/rotation.h"

namespace lodemark {
namespace {

constexpr int kVelocity = 3;
constexpr int kTurn = 6;
constexpr int kTurnRate = 9;
constexpr int kForce = 12;
constexpr int kMount = 15;
constexpr int kLate = 18;

// Of a mounting that nobody knows but by the way the vehicle goes.
constexpr double kAnyMount_rad = 0.5;
// How well sensors and receiver agree about the time, usually.
constexpr double kUsualLateness_s = 0.1;
// What of it is learned from vibrations is wrong: it is never believed for long.
constexpr double kLatenessWander_s_psqrt_s = 0.004;

// Beyond so many sigmas what is said of the velocity is not so.
constexpr double kGate = 4.0;

// Strain is remembered for so long; so much of it is another motion than the receiver's.
constexpr double kStrainMemory_s = 10.0;
constexpr double kBreakingStrain = 40.0;
// A velocity and a clock are four unknowns: what so many rates agree on is more than chance.
constexpr double kFewestContradicting = 5.0;
// 1 sigma an axis of a velocity that nobody knows.
constexpr double kAnySpeed_mps = 30.0;

// An end of a stretch is so long: a single sample is mostly vibration.
constexpr std::int64_t kEnd_ns = 200'000'000;

// The mean of the samples near a time.
InertialSample EndOf(std::span<const InertialSample> samples, std::int64_t time_ns) {
  InertialSample mean;
  mean.time_ns = time_ns;
  double count = 0.0;
  for (const InertialSample& sample : samples) {
    if (std::abs(sample.time_ns - time_ns) > kEnd_ns) continue;
    mean.turn_rate_radps += sample.turn_rate_radps;
    mean.specific_force_mps2 += sample.specific_force_mps2;
    count += 1.0;
  }
  mean.turn_rate_radps /= count;
  mean.specific_force_mps2 /= count;
  return mean;
}

using StepWithState = Eigen::Matrix<double, kInertialErrors, 6>;

}  // namespace

void InertialFilter::Start(const InertialState& state,
                           const Eigen::Matrix<double, 6, 6>& motion_covariance,
                           const Eigen::Matrix<double, 9, 9>& attitude_covariance,
                           const InertialNoise& noise) {
  started_ = true;
  mounted_ = false;
  noise_ = noise;
  state_ = state;
  covariance_.setZero();
  covariance_.topLeftCorner<6, 6>() = motion_covariance;
  covariance_.block<9, 9>(kTurn, kTurn) = attitude_covariance;
  covariance_.diagonal().segment<3>(kMount).setConstant(kAnyMount_rad * kAnyMount_rad);
  covariance_(kLate, kLate) = kUsualLateness_s * kUsualLateness_s;
  strain_ = 1.0;
}

void InertialFilter::Advance(std::span<const InertialSample> samples,
                             std::span<const RangeRateObservation> rates,
                             std::span<const RangeChangeObservation> changes,
                             MotionVerdicts* verdicts, const std::optional<Rise>& rise) {
  const InertialIncrement felt = IntegrateInertial(samples, state_.biases, noise_);
  const double t = felt.seconds;
  const Eigen::Matrix3d axes = state_.ecef_from_sensor.toRotationMatrix();
  const Eigen::Vector3d earth(0.0, 0.0, kEarthTurnRate_radps);
  const Eigen::Vector3d pull =
      GravityInEcef(state_.position_in_ecef) - 2.0 * earth.cross(state_.velocity_in_ecef_mps);
  // While it is felt, the earth turns on.
  const Eigen::Vector3d gained = Turn(-t / 2.0 * earth) * (axes * felt.velocity_mps);
  const Eigen::Vector3d moved = Turn(-t / 3.0 * earth) * (axes * felt.moved_m);

  InertialState next = state_;
  next.position_in_ecef += t * state_.velocity_in_ecef_mps + 0.5 * t * t * pull + moved;
  next.velocity_in_ecef_mps += t * pull + gained;
  next.ecef_from_sensor = (Turn(-t * earth) * state_.ecef_from_sensor * felt.turn).normalized();

  InertialMatrix transition = InertialMatrix::Identity();
  transition.block<3, 3>(0, kVelocity) = t * Eigen::Matrix3d::Identity();
  transition.block<3, 3>(0, kTurn) = -CrossOf(moved);
  transition.block<3, 3>(kVelocity, kTurn) = -CrossOf(gained);
  transition.block<3, 6>(0, kTurnRate) = axes * felt.by_biases.bottomRows<3>();
  transition.block<3, 6>(kVelocity, kTurnRate) = axes * felt.by_biases.middleRows<3>(3);
  transition.block<3, 6>(kTurn, kTurnRate) = axes * felt.by_biases.topRows<3>();

  // What is felt later than it is said: the force and the turn rate of the ends change places.
  const Eigen::Matrix3d axes_then = next.ecef_from_sensor.toRotationMatrix();
  const InertialSample first = EndOf(samples, samples.front().time_ns);
  const InertialSample last = EndOf(samples, samples.back().time_ns);
  const Eigen::Vector3d force_before =
      axes * (first.specific_force_mps2 - state_.biases.specific_force_mps2);
  const Eigen::Vector3d force_after =
      axes_then * (last.specific_force_mps2 - state_.biases.specific_force_mps2);
  transition.block<3, 1>(0, kLate) = gained - t * force_before;
  transition.block<3, 1>(kVelocity, kLate) = force_after - force_before;
  transition.block<3, 1>(kTurn, kLate) =
      axes_then * (last.turn_rate_radps - state_.biases.turn_rate_radps) -
      axes * (first.turn_rate_radps - state_.biases.turn_rate_radps);
  next.position_in_ecef += state_.late_s * transition.block<3, 1>(0, kLate);
  next.velocity_in_ecef_mps += state_.late_s * transition.block<3, 1>(kVelocity, kLate);
  next.ecef_from_sensor =
      (Turn(state_.late_s * transition.block<3, 1>(kTurn, kLate)) * next.ecef_from_sensor)
          .normalized();

  InertialMatrix noise = InertialMatrix::Zero();
  constexpr int kOrder[3] = {kTurn, kVelocity, 0};  // rows of an increment
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      noise.block<3, 3>(kOrder[row], kOrder[column]) =
          std::max(1.0, strain_) *
          (axes * felt.covariance.block<3, 3>(3 * row, 3 * column) * axes.transpose());
    }
  }
  const double turned = noise_.scale * TurnOf(felt.turn).norm();
  const double hastened = noise_.scale * (gained + t * pull).norm();
  noise.diagonal().segment<3>(kTurn).array() += turned * turned;
  noise.diagonal().segment<3>(kVelocity).array() += hastened * hastened;
  noise.diagonal().segment<3>(0).array() += 0.25 * t * t * hastened * hastened;
  noise.diagonal().segment<3>(kTurnRate).array() +=
      t * noise_.turn_rate_wander_radps_psqrt_s * noise_.turn_rate_wander_radps_psqrt_s;
  noise(kLate, kLate) += t * kLatenessWander_s_psqrt_s * kLatenessWander_s_psqrt_s;
  noise.diagonal().segment<3>(kForce).array() +=
      t * noise_.specific_force_wander_mps2_psqrt_s * noise_.specific_force_wander_mps2_psqrt_s;

  // Displacement and velocity are linear in the errors before and the noise.
  Eigen::Matrix<double, 6, kInertialErrors> step_from_state = transition.topRows<6>();
  step_from_state.topLeftCorner<3, 3>().setZero();
  const StepWithState before_with_step = covariance_ * step_from_state.transpose();
  StepKnowledge known;
  known.mean << next.position_in_ecef - state_.position_in_ecef, next.velocity_in_ecef_mps;
  known.covariance = step_from_state * before_with_step + noise.topLeftCorner<6, 6>();
  const StepKnowledge measured = AdjustStep(known, rates, changes, verdicts);
  StepKnowledge found = measured;
  verdicts->rise_square.reset();
  if (rise) {
    const Eigen::Matrix3d enu_from_ecef =
        EnuFromEcefRotation(GeodeticFromEcef(state_.position_in_ecef));
    verdicts->rise_square = HearRise(*rise, enu_from_ecef.row(2), &found);
  }
  const StepWithState after_with_step = transition * before_with_step + noise.leftCols<6>();
  const StepWithState gain =
      Eigen::LDLT<StepMatrix>(known.covariance).solve(after_with_step.transpose()).transpose();
  const InertialMatrix after = transition * covariance_ * transition.transpose() + noise -
                               gain * (known.covariance - found.covariance) * gain.transpose();
  covariance_ = 0.5 * (after + after.transpose());
  state_ = next;
  Correct(gain * (found.mean - known.mean));
  clock_drift_mps_ = found.clock_drift_mps;
  if (verdicts->rates_agree || verdicts->changes_agree) {
    NoteStrain(t, known, measured);
  } else if (!rates.empty()) {
    NoteContradiction(t, known, rates);
  }
  started_ = strain_ < kBreakingStrain && covariance_.allFinite() &&
             covariance_.diagonal().minCoeff() > 0.0 && state_.position_in_ecef.allFinite() &&
             state_.velocity_in_ecef_mps.allFinite() &&
             state_.ecef_from_sensor.coeffs().allFinite();
}

void InertialFilter::NoteStrain(double seconds, const StepKnowledge& known,
                                const StepKnowledge& found) {
  const Eigen::Vector3d moved = (found.mean - known.mean).tail<3>();
  const Eigen::Matrix3d expected = (known.covariance - found.covariance).bottomRightCorner<3, 3>();
  NoteSquare(seconds, moved.dot(expected.ldlt().solve(moved)) / 3.0);
}

// No rates fit what the sensor says. Do they fit one velocity by themselves?
void InertialFilter::NoteContradiction(double seconds, const StepKnowledge& known,
                                       std::span<const RangeRateObservation> rates) {
  StepKnowledge anything = known;
  anything.covariance.diagonal().array() += kAnySpeed_mps * kAnySpeed_mps;
  const StepKnowledge found = AdjustStep(anything, rates, {}, &by_themselves_);
  double agreeing = 0.0;
  for (const MotionVerdict& verdict : by_themselves_.rates) agreeing += verdict.weight;
  if (!by_themselves_.rates_agree || agreeing < kFewestContradicting) return;
  const Eigen::Vector3d moved = (found.mean - known.mean).tail<3>();
  const Eigen::Matrix3d expected = (known.covariance + found.covariance).bottomRightCorner<3, 3>();
  NoteSquare(seconds, moved.dot(expected.ldlt().solve(moved)) / 3.0);
}

void InertialFilter::NoteSquare(double seconds, double square) {
  if (!(square >= 0.0)) return;
  strain_ += (1.0 - std::exp(-seconds / kStrainMemory_s)) *
             (std::min(square, 10.0 * kBreakingStrain) - strain_);
}

void InertialFilter::Correct(const InertialVector& errors) {
  state_.position_in_ecef += errors.head<3>();
  state_.velocity_in_ecef_mps += errors.segment<3>(kVelocity);
  state_.ecef_from_sensor = (Turn(errors.segment<3>(kTurn)) * state_.ecef_from_sensor).normalized();
  state_.biases.turn_rate_radps += errors.segment<3>(kTurnRate);
  state_.biases.specific_force_mps2 += errors.segment<3>(kForce);
  state_.sensor_from_vehicle =
      (Turn(errors.segment<3>(kMount)) * state_.sensor_from_vehicle).normalized();
  state_.late_s += errors[kLate];
}

PositionStatement InertialFilter::Place() const {
  PositionStatement place;
  place.around_in_ecef = state_.position_in_ecef;
  place.information_pm2 = PositionCovarianceEnu().ldlt().solve(Eigen::Matrix3d::Identity());
  return place;
}

void InertialFilter::Hear(const PositionStatement& said) {
  Correct(HearPlace(said, EnuFromEcefRotation(GeodeticFromEcef(state_.position_in_ecef)),
                    &covariance_));
}

bool InertialFilter::HearVelocity(const Eigen::Vector3d& velocity_in_ecef_mps, double sigma_mps) {
  InertialSlope slope = InertialSlope::Zero();
  slope.block<3, 3>(0, kVelocity).setIdentity();
  return Hear(slope, velocity_in_ecef_mps - state_.velocity_in_ecef_mps,
              Eigen::Vector3d::Constant(sigma_mps));
}

bool InertialFilter::HearStill(const Eigen::Vector3d& felt_radps, double sigma_radps) {
  InertialSlope slope = InertialSlope::Zero();
  slope.block<3, 3>(0, kTurnRate).setIdentity();
  return Hear(slope, felt_radps - state_.biases.turn_rate_radps,
              Eigen::Vector3d::Constant(sigma_radps));
}

void InertialFilter::Mount() {
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(state_.position_in_ecef));
  const Eigen::Vector3d forward = state_.velocity_in_ecef_mps.normalized();
  const Eigen::Vector3d up = enu_from_ecef.row(2);
  Eigen::Matrix3d ecef_from_vehicle;
  ecef_from_vehicle.col(0) = forward;
  ecef_from_vehicle.col(1) = up.cross(forward).normalized();
  ecef_from_vehicle.col(2) = forward.cross(ecef_from_vehicle.col(1));
  if (!ecef_from_vehicle.allFinite()) return;
  MountAs(state_.ecef_from_sensor.conjugate() * Eigen::Quaterniond(ecef_from_vehicle),
          kAnyMount_rad);
}

void InertialFilter::MountAs(const Eigen::Quaterniond& sensor_from_vehicle, double sigma_rad) {
  state_.sensor_from_vehicle = sensor_from_vehicle.normalized();
  covariance_.middleRows<3>(kMount).setZero();
  covariance_.middleCols<3>(kMount).setZero();
  covariance_.diagonal().segment<3>(kMount).setConstant(sigma_rad * sigma_rad);
  mounted_ = true;
}

Eigen::Vector3d InertialFilter::VelocityInVehicle() const {
  return state_.sensor_from_vehicle.conjugate() *
         (state_.ecef_from_sensor.conjugate() * state_.velocity_in_ecef_mps);
}

bool InertialFilter::HearVehicle(const Eigen::Vector3d& velocity_in_vehicle_mps,
                                 const Eigen::Vector3d& sigmas_mps) {
  const Eigen::Matrix3d sensor_from_ecef = state_.ecef_from_sensor.conjugate().toRotationMatrix();
  const Eigen::Matrix3d vehicle_from_sensor =
      state_.sensor_from_vehicle.conjugate().toRotationMatrix();
  const Eigen::Matrix3d vehicle_from_ecef = vehicle_from_sensor * sensor_from_ecef;
  InertialSlope slope = InertialSlope::Zero();
  slope.block<3, 3>(0, kVelocity) = vehicle_from_ecef;
  slope.block<3, 3>(0, kTurn) = vehicle_from_ecef * CrossOf(state_.velocity_in_ecef_mps);
  slope.block<3, 3>(0, kMount) =
      vehicle_from_sensor * CrossOf(sensor_from_ecef * state_.velocity_in_ecef_mps);
  return Hear(slope, velocity_in_vehicle_mps - VelocityInVehicle(), sigmas_mps);
}

bool InertialFilter::Hear(const InertialSlope& slope, const Eigen::Vector3d& residual,
                          const Eigen::Vector3d& sigmas) {
  const Eigen::Matrix<double, kInertialErrors, 3> cross = covariance_ * slope.transpose();
  Eigen::Matrix3d expected = slope * cross;
  expected.diagonal() += sigmas.cwiseAbs2();
  const Eigen::LDLT<Eigen::Matrix3d> by_expected(expected);
  const Eigen::Vector3d pull = by_expected.solve(residual);
  if (!(residual.dot(pull) <= kGate * kGate)) return false;
  const InertialMatrix after = covariance_ - cross * by_expected.solve(cross.transpose());
  covariance_ = 0.5 * (after + after.transpose());
  Correct(cross * pull);
  return true;
}

Eigen::Matrix3d InertialFilter::CovarianceEnu(Eigen::Index first) const {
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(state_.position_in_ecef));
  return enu_from_ecef * covariance_.block<3, 3>(first, first) * enu_from_ecef.transpose();
}

}  // namespace lodemark
