// The pull that an accelerometer at rest holds against.
#pragma once

#include <Eigen/Core>

namespace lodemark {

// Normal gravity of the WGS 84 ellipsoid, the centrifugal part included, m/s^2, earth-fixed. The
// real one differs by some 0.0005 m/s^2.
Eigen::Vector3d GravityInEcef(const Eigen::Vector3d& position_in_ecef);

// Of the earth about its z axis, WGS 84.
inline constexpr double kEarthTurnRate_radps = 7.292115e-5;

}  // namespace lodemark
