// Where the receiver is and how it moves, carried from moment to moment: by inertial sensors where
// there are any and it is known how they are turned, else by what moves by itself.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "core/fusion/motion_filter.h"
#include "core/session/barometer.h"
#include "core/session/inertial_carrier.h"

namespace lodemark {

class CarriedMotion {
 public:
  // sensors: null for none; it must stay.
  explicit CarriedMotion(const SensorBuffer* sensors) : inertial_(sensors), barometer_(sensors) {}

  bool started() const { return inertial() || motion_.started(); }
  bool inertial() const { return inertial_.carries(); }
  Eigen::Vector3d position_in_ecef() const;
  Eigen::Vector3d velocity_in_ecef_mps() const;
  double clock_drift_mps() const;
  Eigen::Matrix3d PositionCovarianceEnu() const;
  Eigen::Matrix3d VelocityCovarianceEnu() const;

  void Start(const Eigen::Vector3d& position_in_ecef, const Eigen::Matrix3d& covariance_enu_m2);
  void Stop();
  void Advance(std::int64_t from_ns, std::int64_t to_ns,
               std::span<const RangeRateObservation> rates,
               std::span<const RangeChangeObservation> changes, const MotionModel& model,
               MotionVerdicts* verdicts);
  PositionStatement Place() const;
  // How the phone is turned, where inertial sensors carry it; of the moment of the state.
  std::optional<DeviceAttitude> AttitudeAt(std::int64_t state_ns, std::int64_t time_ns) const {
    return inertial_.AttitudeAt(state_ns, time_ns);
  }
  void Hear(const PositionStatement& said);

  // The latest time update with all that was heard since; of no use where inertial.
  const MotionStep& step() const { return motion_.step(); }

 private:
  MotionFilter motion_;
  InertialCarrier inertial_;
  Barometer barometer_;
};

}  // namespace lodemark
