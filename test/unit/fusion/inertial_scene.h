// A vehicle on its way with a phone fixed askew in it: what its inertial sensor would feel, by
// differences of the path, and what satellites would measure.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/fusion/inertial_filter.h"
#include "core/geo/geodetic.h"
#include "core/geo/gravity.h"
#include "core/geo/rotation.h"

namespace lodemark::test {

class InertialScene {
 public:
  explicit InertialScene(const Geodetic& origin = {0.83, 0.23, 120.0}) : origin_(origin) {}

  Eigen::Vector3d PlaceAt(double seconds) const {
    const Eigen::Vector3d enu_m(10.0 * seconds + 15.0 * std::sin(0.3 * seconds),
                                40.0 * std::sin(0.15 * seconds), 2.0 * std::sin(0.05 * seconds));
    return origin_in_ecef_ + enu_from_ecef_.transpose() * enu_m;
  }
  Eigen::Vector3d VelocityAt(double seconds) const {
    return (PlaceAt(seconds + kStep_s) - PlaceAt(seconds - kStep_s)) / (2.0 * kStep_s);
  }
  Eigen::Quaterniond EcefFromVehicle(double seconds) const {
    const Eigen::Vector3d forward = VelocityAt(seconds).normalized();
    const Eigen::Vector3d up = enu_from_ecef_.row(2);
    Eigen::Matrix3d axes;
    axes.col(0) = forward;
    axes.col(1) = up.cross(forward).normalized();
    axes.col(2) = forward.cross(axes.col(1));
    return Eigen::Quaterniond(axes);
  }
  Eigen::Quaterniond EcefFromSensor(double seconds) const {
    return EcefFromVehicle(seconds) * vehicle_from_sensor_;
  }
  const Eigen::Quaterniond& vehicle_from_sensor() const { return vehicle_from_sensor_; }
  const Eigen::Matrix3d& enu_from_ecef() const { return enu_from_ecef_; }

  InertialSample FeltAt(double seconds) const {
    const double h = 10.0 * kStep_s;
    const Eigen::Vector3d earth(0.0, 0.0, kEarthTurnRate_radps);
    const Eigen::Vector3d acceleration =
        (PlaceAt(seconds + h) - 2.0 * PlaceAt(seconds) + PlaceAt(seconds - h)) / (h * h);
    const Eigen::Quaterniond sensor_from_ecef = EcefFromSensor(seconds).conjugate();
    InertialSample felt;
    felt.time_ns = std::llround(1e9 * seconds);
    felt.specific_force_mps2 = sensor_from_ecef * (acceleration - GravityInEcef(PlaceAt(seconds)) +
                                                   2.0 * earth.cross(VelocityAt(seconds)));
    felt.turn_rate_radps =
        TurnOf(EcefFromSensor(seconds - h).conjugate() * EcefFromSensor(seconds + h)) / (2.0 * h) +
        sensor_from_ecef * earth;
    return felt;
  }

  // late_s: the samples' times are so much too late.
  std::vector<InertialSample> Felt(double from_s, double to_s, double late_s = 0.0) const {
    std::vector<InertialSample> samples;
    const int count = static_cast<int>(std::lround((to_s - from_s) * kSamplesPerSecond));
    for (int i = 0; i <= count; ++i) {
      const double seconds = from_s + i / kSamplesPerSecond;
      samples.push_back(FeltAt(seconds - late_s));
      samples.back().time_ns = std::llround(1e9 * seconds);
    }
    return samples;
  }

  InertialState StateAt(double seconds) const {
    InertialState state;
    state.position_in_ecef = PlaceAt(seconds);
    state.velocity_in_ecef_mps = VelocityAt(seconds);
    state.ecef_from_sensor = EcefFromSensor(seconds);
    return state;
  }

  // Doppler of eight satellites, of so much noise.
  std::vector<RangeRateObservation> RatesAt(double seconds, double sigma_mps,
                                            Random* random) const {
    constexpr double kDirections_deg[8][2] = {{0, 90},   {0, 40},   {60, 20},  {120, 50},
                                              {180, 30}, {240, 45}, {300, 25}, {20, 60}};
    std::vector<RangeRateObservation> rates;
    for (const auto& direction : kDirections_deg) {
      const double azimuth = direction[0] * kRadiansPerDegree;
      const double elevation = direction[1] * kRadiansPerDegree;
      RangeRateObservation rate;
      rate.direction_in_ecef =
          enu_from_ecef_.transpose() * Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth),
                                                       std::cos(elevation) * std::cos(azimuth),
                                                       std::sin(elevation));
      rate.rate_mps =
          -rate.direction_in_ecef.dot(VelocityAt(seconds)) + 3.0 + sigma_mps * random->Gaussian();
      rate.sigma_mps = sigma_mps;
      rates.push_back(rate);
    }
    return rates;
  }

 private:
  static constexpr double kStep_s = 1e-3;
  static constexpr double kSamplesPerSecond = 100.0;

  Geodetic origin_;
  Eigen::Vector3d origin_in_ecef_ = EcefFromGeodetic(origin_);
  Eigen::Matrix3d enu_from_ecef_ = EnuFromEcefRotation(origin_);
  Eigen::Quaterniond vehicle_from_sensor_ = Turn(Eigen::Vector3d(0.4, -1.1, 0.7));
};

}  // namespace lodemark::test
