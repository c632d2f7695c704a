// A receiver that moves among directions to satellites, for the tests of the motion filter.
#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/fusion/motion_filter.h"
#include "core/geo/geodetic.h"

namespace lodemark::test {

inline const Geodetic kMotionPlace = {0.84, 0.2, 250.0};

inline Eigen::Vector3d MotionStart() { return EcefFromGeodetic(kMotionPlace); }
inline Eigen::Matrix3d EcefFromEnu() { return EnuFromEcefRotation(kMotionPlace).transpose(); }

// Unit vectors to so many satellites all over the sky, earth-fixed.
inline std::vector<Eigen::Vector3d> SkyDirections(int count) {
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double azimuth_rad = 2.4 * i;
    const double elevation_rad = (15.0 + 65.0 * i / count) * kRadiansPerDegree;
    directions.push_back(EcefFromEnu() *
                         Eigen::Vector3d(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                         std::cos(azimuth_rad) * std::cos(elevation_rad),
                                         std::sin(elevation_rad)));
  }
  return directions;
}

// Noise is drawn as so many times the stated sigma.
inline std::vector<RangeRateObservation> RatesOf(const std::vector<Eigen::Vector3d>& directions,
                                                 const Eigen::Vector3d& velocity_mps,
                                                 double drift_mps, double sigma_mps,
                                                 double noise_sigmas, Random* random) {
  std::vector<RangeRateObservation> rates;
  for (const Eigen::Vector3d& direction : directions) {
    rates.push_back(
        {direction,
         drift_mps - direction.dot(velocity_mps) + noise_sigmas * sigma_mps * random->Gaussian(),
         sigma_mps});
  }
  return rates;
}

inline std::vector<RangeChangeObservation> ChangesOf(const std::vector<Eigen::Vector3d>& directions,
                                                     const Eigen::Vector3d& moved_m, double clock_m,
                                                     double sigma_m, double noise_sigmas,
                                                     Random* random) {
  std::vector<RangeChangeObservation> changes;
  for (const Eigen::Vector3d& direction : directions) {
    changes.push_back(
        {direction, clock_m - direction.dot(moved_m) + noise_sigmas * sigma_m * random->Gaussian(),
         sigma_m});
  }
  return changes;
}

// A statement of a position, around where the filter is.
inline PositionStatement StatedAt(const MotionFilter& filter, const Eigen::Vector3d& said_in_ecef,
                                  const Eigen::Matrix3d& information_enu_pm2) {
  PositionStatement said;
  said.around_in_ecef = filter.position_in_ecef();
  said.information_pm2 = information_enu_pm2;
  said.pull_pm = information_enu_pm2 * (EnuFromEcefRotation(GeodeticFromEcef(said.around_in_ecef)) *
                                        (said_in_ecef - said.around_in_ecef));
  return said;
}

inline MotionVector StateOf(const MotionFilter& filter) {
  MotionVector state;
  state << filter.position_in_ecef(), filter.velocity_in_ecef_mps();
  return state;
}

// Earth-fixed. A pull without information moves the state by the covariance times the pull: so the
// covariance between position and velocity shows.
inline MotionMatrix CovarianceOf(const MotionFilter& filter) {
  const Eigen::Matrix3d ecef_from_enu =
      EnuFromEcefRotation(GeodeticFromEcef(filter.position_in_ecef())).transpose();
  MotionMatrix covariance;
  covariance.topLeftCorner<3, 3>() =
      ecef_from_enu * filter.PositionCovarianceEnu() * ecef_from_enu.transpose();
  covariance.bottomRightCorner<3, 3>() =
      ecef_from_enu * filter.VelocityCovarianceEnu() * ecef_from_enu.transpose();
  for (int axis = 0; axis < 3; ++axis) {
    MotionFilter pulled = filter;
    PositionStatement pull;
    pull.around_in_ecef = filter.position_in_ecef();
    pull.pull_pm = ecef_from_enu.transpose().col(axis);
    pulled.Hear(pull);
    covariance.block<3, 1>(3, axis) = pulled.velocity_in_ecef_mps() - filter.velocity_in_ecef_mps();
  }
  covariance.topRightCorner<3, 3>() = covariance.bottomLeftCorner<3, 3>().transpose();
  return covariance;
}

// What white acceleration adds within so many seconds.
inline MotionMatrix MotionNoise(const MotionModel& model, double t) {
  const Eigen::Matrix3d density =
      EcefFromEnu() * model.acceleration_density_m2ps3.asDiagonal() * EcefFromEnu().transpose();
  MotionMatrix noise;
  noise << density * (t * t * t / 3.0), density * (t * t / 2.0), density * (t * t / 2.0),
      density * t;
  return noise;
}

inline MotionMatrix MotionTransition(double t) {
  MotionMatrix transition = MotionMatrix::Identity();
  transition.topRightCorner<3, 3>() = t * Eigen::Matrix3d::Identity();
  return transition;
}

// A draw from a normal distribution around zero.
inline MotionVector Drawn(const MotionMatrix& covariance, Random* random) {
  MotionVector white;
  for (int i = 0; i < 6; ++i) white[i] = random->Gaussian();
  const Eigen::LLT<MotionMatrix> root(covariance);
  return root.matrixL() * white;
}

}  // namespace lodemark::test
