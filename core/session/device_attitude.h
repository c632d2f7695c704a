// How a phone is turned, as its inertial sensors know it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lodemark {

struct DeviceAttitude {
  // Turns east, north, up at the place into the axes of the accelerometer.
  Eigen::Quaterniond device_from_enu = Eigen::Quaterniond::Identity();
  // Of small turns about east, north and up: enu_from_device = exp(turn) * estimate.
  Eigen::Matrix3d covariance_enu_rad2 = Eigen::Matrix3d::Zero();
};

}  // namespace lodemark
