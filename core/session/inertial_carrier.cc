#include "core/session/inertial_carrier.h"

#include <algorithm>
#include <cmath>

#include "core/geo/geodetic.h"
#include "core/geo/gravity.h"
#include "core/geo/rotation.h"
#include "core/session/vehicle_axes.h"

namespace lodemark {
namespace {

// A stretch of an alignment: shorter ones say little of the heading, longer ones are not straight.
constexpr double kShortestStretch_s = 0.9;
constexpr double kLongestStretch_s = 3.0;
// Velocities known worse say nothing.
constexpr double kWorstVelocity_mps = 0.5;

// Longer ways are taken in steps.
constexpr std::int64_t kStep_ns = 1'000'000'000;
constexpr std::int64_t kLongestStep_ns = 1'500'000'000;

// A phone that lies still, even in a car with its engine running.
constexpr double kStillForce_mps2 = 0.15;
constexpr double kStillTurnRate_radps = 0.015;
constexpr double kShortestRest_s = 0.15;
constexpr double kStillSpeed_mps = 0.5;
constexpr double kRest_mps = 0.05;
constexpr double kRest_radps = 0.004;

// No one walks so fast; below the second the direction says little.
constexpr double kVehicleSpeed_mps = 5.0;
constexpr double kSlowVehicle_mps = 2.0;
// What a vehicle moves sideways and up within a second, 1 sigma: of itself, of its speed, and where
// it turns, as the phone is some way before its rear axle.
constexpr double kSideways_mps = 0.3;
constexpr double kSidewaysShare = 0.015;
constexpr double kBeforeAxle_m = 1.5;
// So many times in a row it did not: the phone was taken out of its holder.
constexpr int kUnlikeVehicle = 3;

// Of a vehicle's own speed: noise, and the size of its wheels.
constexpr double kWheelSpeed_mps = 0.1;
constexpr double kWheelSpeedShare = 0.01;
constexpr std::int64_t kSpeedLasts_ns = 300'000'000;

// What is felt by wheels: differences of a rounded speed, on roads that are not level.
constexpr double kWheelTurn_rad_psqrt_s = 3e-3;
constexpr double kWheelForce_mps_psqrt_s = 0.3;
constexpr double kWheelAxes_rad = 0.02;
constexpr double kWheelTurnWander_radps_psqrt_s = 1e-4;

constexpr double kUnsaid_mps = 1e4;

// An attitude is carried on by turn rates alone for so long.
constexpr double kLongestTurn_s = 5.0;

double Seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

struct Scatter {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double deviation = 0.0;  // the largest of the three axes
};

template <typename Value>
Scatter ScatterOf(std::span<const InertialSample> samples, const Value& value) {
  Scatter scatter;
  const double count = static_cast<double>(samples.size());
  for (const InertialSample& sample : samples) scatter.mean += value(sample) / count;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const InertialSample& sample : samples) {
    squares += (value(sample) - scatter.mean).cwiseAbs2() / count;
  }
  scatter.deviation = std::sqrt(squares.maxCoeff());
  return scatter;
}

Scatter TurnRates(std::span<const InertialSample> samples) {
  return ScatterOf(samples, [](const InertialSample& sample) { return sample.turn_rate_radps; });
}

Scatter Forces(std::span<const InertialSample> samples) {
  return ScatterOf(samples,
                   [](const InertialSample& sample) { return sample.specific_force_mps2; });
}

}  // namespace

void InertialCarrier::Note(std::int64_t time_ns, const MotionFilter& motion, bool measured) {
  if (sensors_ == nullptr || filter_.started()) return;
  const MotionState& state = motion.step().filtered;
  const double variance = state.covariance.diagonal().tail<3>().mean();
  if (!measured || !(variance < kWorstVelocity_mps * kWorstVelocity_mps)) return;
  const double seconds = Seconds(noted_ns_, time_ns);
  if (noted_ns_ != 0 && seconds >= 0.0 && seconds < kShortestStretch_s) return;
  const Eigen::Vector3d before = noted_velocity_in_ecef_mps_;
  const double variance_before = noted_variance_m2ps2_;
  const std::int64_t from_ns = noted_ns_;
  noted_ns_ = time_ns;
  noted_velocity_in_ecef_mps_ = state.mean.tail<3>();
  noted_variance_m2ps2_ = variance;
  bool complete = false;
  std::span<const InertialSample> samples;
  if (from_ns != 0 && seconds > 0.0 && seconds < kLongestStretch_s) {
    samples = Felt(from_ns, time_ns, &complete);
  }
  if (!complete) {
    alignment_.Forget();
    return;
  }
  FeltStretch stretch;
  stretch.felt = IntegrateInertial(samples, InertialBiases(), noise());
  stretch.gained_in_ecef_mps =
      noted_velocity_in_ecef_mps_ - before - seconds * GravityInEcef(motion.position_in_ecef());
  stretch.sigma_mps = std::sqrt(variance + variance_before);
  alignment_.Add(stretch);
  const Eigen::Vector3d up =
      EnuFromEcefRotation(GeodeticFromEcef(motion.position_in_ecef())).row(2);
  const std::optional<InertialAlignmentResult> aligned = alignment_.Solve(up);
  if (!aligned) return;
  InertialState begin;
  begin.position_in_ecef = motion.position_in_ecef();
  begin.velocity_in_ecef_mps = motion.velocity_in_ecef_mps();
  begin.ecef_from_sensor = aligned->ecef_from_sensor;
  begin.biases = aligned->biases;
  filter_.Start(begin, state.covariance, aligned->covariance, noise());
  if (by_wheels_) filter_.MountAs(Eigen::Quaterniond::Identity(), kWheelAxes_rad);
  unlike_vehicle_ = 0;
  alignment_.Forget();
}

bool InertialCarrier::Advance(std::int64_t from_ns, std::int64_t to_ns,
                              std::span<const RangeRateObservation> rates,
                              std::span<const RangeChangeObservation> changes, Barometer* barometer,
                              MotionVerdicts* verdicts) {
  // Rest and vehicle hold it all through a silence, of which phases tell nothing.
  if (to_ns - from_ns > kLongestStep_ns) changes = {};
  while (to_ns - from_ns > kLongestStep_ns) {
    if (!Step(from_ns, from_ns + kStep_ns, {}, {}, barometer, verdicts)) return false;
    if (!filter_.started()) return true;
    from_ns += kStep_ns;
  }
  return Step(from_ns, to_ns, rates, changes, barometer, verdicts);
}

bool InertialCarrier::Step(std::int64_t from_ns, std::int64_t to_ns,
                           std::span<const RangeRateObservation> rates,
                           std::span<const RangeChangeObservation> changes, Barometer* barometer,
                           MotionVerdicts* verdicts) {
  bool complete = false;
  const bool by_wheels = by_wheels_;
  const std::span<const InertialSample> samples = Felt(from_ns, to_ns, &complete);
  if (!complete || by_wheels != by_wheels_) return false;
  const InertialState& before = filter_.state();
  const std::optional<Rise> rise =
      barometer->RiseBetween(from_ns, to_ns, GeodeticFromEcef(before.position_in_ecef).height_m,
                             before.velocity_in_ecef_mps.norm());
  filter_.Advance(samples, rates, changes, verdicts, rise);
  if (rise) {
    barometer->Learn(Seconds(from_ns, to_ns), rise->rise_m, *verdicts->rise_square);
  }
  if (!filter_.started()) return true;
  HearRest(samples, Seconds(from_ns, to_ns));
  HearVehicle(samples, from_ns, to_ns);
  return true;
}

std::span<const InertialSample> InertialCarrier::Felt(std::int64_t from_ns, std::int64_t to_ns,
                                                      bool* complete) {
  const std::span<const InertialSample> samples = sensors_->Between(from_ns, to_ns, complete);
  const bool by_wheels = samples.empty() && FeltInVehicle(*sensors_, from_ns, to_ns, &wheels_);
  if (by_wheels != by_wheels_) alignment_.Forget();
  by_wheels_ = by_wheels;
  if (!by_wheels) return samples;
  *complete = true;
  return wheels_;
}

const InertialNoise& InertialCarrier::noise() const {
  static constexpr InertialNoise kPhone;
  static constexpr InertialNoise kWheels = {kWheelTurn_rad_psqrt_s, kWheelForce_mps_psqrt_s,
                                            kWheelTurnWander_radps_psqrt_s, 1e-4, 0.02};
  return by_wheels_ ? kWheels : kPhone;
}

void InertialCarrier::HearRest(std::span<const InertialSample> samples, double seconds) {
  // Wheels say themselves that they stand, and a car that rolls evenly feels nothing either.
  if (by_wheels_ || seconds < kShortestRest_s) return;
  const InertialState& state = filter_.state();
  if (state.velocity_in_ecef_mps.norm() >
      kStillSpeed_mps + 3.0 * std::sqrt(filter_.VelocityCovarianceEnu().trace())) {
    return;
  }
  const Scatter turn_rates = TurnRates(samples);
  if (turn_rates.deviation > kStillTurnRate_radps ||
      (turn_rates.mean - state.biases.turn_rate_radps).norm() > kStillTurnRate_radps ||
      Forces(samples).deviation > kStillForce_mps2) {
    return;
  }
  if (!filter_.HearVelocity(Eigen::Vector3d::Zero(), kRest_mps)) return;
  filter_.HearStill(turn_rates.mean, kRest_radps);
}

void InertialCarrier::HearVehicle(std::span<const InertialSample> samples, std::int64_t from_ns,
                                  std::int64_t to_ns) {
  const std::span<const VehicleSample> wheels = sensors_->VehicleBetween(from_ns, to_ns);
  const double speed_mps = filter_.state().velocity_in_ecef_mps.norm();
  const double speed_sigma_mps = std::sqrt(filter_.VelocityCovarianceEnu().trace());
  if (!filter_.mounted()) {
    const double least_mps = wheels.empty() ? kVehicleSpeed_mps : kSlowVehicle_mps;
    if (speed_mps < least_mps + 3.0 * speed_sigma_mps) return;
    filter_.Mount();
    unlike_vehicle_ = 0;
  }
  const bool has_speed = !wheels.empty() && to_ns - wheels.back().time_ns < kSpeedLasts_ns;
  if (!has_speed && speed_mps < kSlowVehicle_mps) return;
  const double turn_rate_radps =
      (TurnRates(samples).mean - filter_.state().biases.turn_rate_radps).norm();
  // As much within a second, however often it is asked.
  const double times = 1.0 / std::sqrt(std::clamp(Seconds(from_ns, to_ns), 0.01, 1.0));
  const double sideways_mps =
      times * (kSideways_mps + kSidewaysShare * speed_mps + kBeforeAxle_m * turn_rate_radps);
  Eigen::Vector3d said(0.0, 0.0, 0.0);
  Eigen::Vector3d sigmas(kUnsaid_mps, sideways_mps, sideways_mps);
  if (has_speed) {
    said.x() = wheels.back().forward_speed_mps;
    sigmas.x() = times * (kWheelSpeed_mps + kWheelSpeedShare * std::abs(said.x()));
  }
  if (filter_.HearVehicle(said, sigmas)) {
    unlike_vehicle_ = 0;
  } else if (++unlike_vehicle_ >= kUnlikeVehicle && !by_wheels_) {
    filter_.Unmount();
  }
}

std::optional<DeviceAttitude> InertialCarrier::AttitudeAt(std::int64_t state_ns,
                                                          std::int64_t time_ns) const {
  if (!carries() || by_wheels_) return std::nullopt;
  const InertialState& state = filter_.state();
  const double seconds = Seconds(state_ns, time_ns);
  Eigen::Quaterniond ecef_from_device = state.ecef_from_sensor;
  DeviceAttitude attitude;
  attitude.covariance_enu_rad2 = filter_.AttitudeCovarianceEnu();
  if (time_ns != state_ns) {
    if (!(std::abs(seconds) < kLongestTurn_s)) return std::nullopt;
    const std::int64_t late_ns = std::llround(1e9 * state.late_s);
    bool complete = false;
    const std::span<const InertialSample> samples = sensors_->Between(
        std::min(state_ns, time_ns) + late_ns, std::max(state_ns, time_ns) + late_ns, &complete);
    if (!complete) return std::nullopt;
    const InertialIncrement felt = IntegrateInertial(samples, state.biases, noise());
    const Eigen::Vector3d earth(0.0, 0.0, kEarthTurnRate_radps);
    ecef_from_device = Turn(-seconds * earth) * ecef_from_device *
                       (seconds > 0.0 ? felt.turn : felt.turn.conjugate());
    const double turned_rad = noise().scale * TurnOf(felt.turn).norm();
    attitude.covariance_enu_rad2.diagonal().array() +=
        felt.covariance.diagonal().head<3>().maxCoeff() + turned_rad * turned_rad;
  }
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(state.position_in_ecef));
  attitude.device_from_enu =
      (Eigen::Quaterniond(enu_from_ecef) * ecef_from_device).conjugate().normalized();
  return attitude;
}

void InertialCarrier::Forget() { *this = InertialCarrier(sensors_); }

}  // namespace lodemark
