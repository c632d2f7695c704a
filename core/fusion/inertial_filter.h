// Position, velocity and attitude carried by an inertial sensor: an error-state Kalman filter in
// the earth-fixed frame, which hears Doppler, carrier phase and statements as MotionFilter does.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "core/fusion/inertial_increment.h"
#include "core/fusion/inertial_sample.h"
#include "core/fusion/observation.h"
#include "core/fusion/position_statement.h"
#include "core/fusion/rise.h"
#include "core/fusion/step_adjustment.h"

namespace lodemark {

struct InertialState {
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_ecef_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond ecef_from_sensor = Eigen::Quaterniond::Identity();
  InertialBiases biases;
  // How the sensor is mounted: x forward, y to the left, z up of the vehicle.
  Eigen::Quaterniond sensor_from_vehicle = Eigen::Quaterniond::Identity();
  double late_s = 0.0;  // the sensor's times are so much too late
};

// Errors, of truth minus state: position, velocity, turn of the attitude, each earth-fixed; biases
// of turn rate and specific force; turn of the mounting, in the sensor's axes; lateness.
inline constexpr int kInertialErrors = 19;
using InertialVector = Eigen::Matrix<double, kInertialErrors, 1>;
using InertialMatrix = Eigen::Matrix<double, kInertialErrors, kInertialErrors>;
using InertialSlope = Eigen::Matrix<double, 3, kInertialErrors>;

class InertialFilter {
 public:
  bool started() const { return started_; }
  const InertialState& state() const { return state_; }
  const InertialMatrix& covariance() const { return covariance_; }
  double clock_drift_mps() const { return clock_drift_mps_; }
  // Mean square of what Doppler and phase had to correct the velocity by, of late, in its variance.
  double strain() const { return strain_; }

  // covariance: of position and velocity, and of turn and biases, earth-fixed.
  void Start(const InertialState& state, const Eigen::Matrix<double, 6, 6>& motion_covariance,
             const Eigen::Matrix<double, 9, 9>& attitude_covariance,
             const InertialNoise& noise = {});
  void Stop() { started_ = false; }

  // Carries the state on to the time of the last sample; the first is at the time of the state.
  // rates: at the new moment; changes and rise: in between. Stops where numbers run out, or where
  // the sensor tells of another motion than rates and changes do.
  void Advance(std::span<const InertialSample> samples, std::span<const RangeRateObservation> rates,
               std::span<const RangeChangeObservation> changes, MotionVerdicts* verdicts,
               const std::optional<Rise>& rise = {});

  // What is known of the position, and an independent statement around that place.
  PositionStatement Place() const;
  void Hear(const PositionStatement& said);

  // The velocity, earth-fixed. False, and not heard, where it is not that by far.
  bool HearVelocity(const Eigen::Vector3d& velocity_in_ecef_mps, double sigma_mps);
  // Nothing turns: the turn rate felt is its bias. Likewise.
  bool HearStill(const Eigen::Vector3d& felt_radps, double sigma_radps);
  // From now on the sensor is fixed to a vehicle that moves forward.
  void Mount();
  // Likewise, in a known way, to so many radians an axis.
  void MountAs(const Eigen::Quaterniond& sensor_from_vehicle, double sigma_rad);
  bool mounted() const { return mounted_; }
  void Unmount() { mounted_ = false; }
  // The velocity along the vehicle's axes. Likewise.
  bool HearVehicle(const Eigen::Vector3d& velocity_in_vehicle_mps,
                   const Eigen::Vector3d& sigmas_mps);
  Eigen::Vector3d VelocityInVehicle() const;

  Eigen::Matrix3d PositionCovarianceEnu() const { return CovarianceEnu(0); }
  Eigen::Matrix3d VelocityCovarianceEnu() const { return CovarianceEnu(3); }
  // Of small turns of the attitude.
  Eigen::Matrix3d AttitudeCovarianceEnu() const { return CovarianceEnu(6); }

 private:
  // slope * errors + noise = residual.
  bool Hear(const InertialSlope& slope, const Eigen::Vector3d& residual,
            const Eigen::Vector3d& sigmas);
  Eigen::Matrix3d CovarianceEnu(Eigen::Index first) const;
  void Correct(const InertialVector& errors);
  void NoteStrain(double seconds, const StepKnowledge& known, const StepKnowledge& found);
  void NoteContradiction(double seconds, const StepKnowledge& known,
                         std::span<const RangeRateObservation> rates);
  void NoteSquare(double seconds, double square);

  bool started_ = false;
  bool mounted_ = false;
  InertialState state_;
  InertialMatrix covariance_ = InertialMatrix::Identity();
  InertialNoise noise_;
  double clock_drift_mps_ = 0.0;
  double strain_ = 1.0;
  MotionVerdicts by_themselves_;
};

}  // namespace lodemark
