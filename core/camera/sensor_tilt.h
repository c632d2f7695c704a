// The image on a sensor that is not square to the optical axis.
#pragma once

#include <Eigen/Core>

namespace lodemark {

// OpenCV's homography of a sensor turned by tau_x about x, then by tau_y about y (calib3d,
// distortion coefficients tau_x tau_y). It is the identity for no tilt, and has an inverse while
// cos(tau_x) cos(tau_y) is not 0.
struct SensorTilt {
  SensorTilt(double tau_x_rad, double tau_y_rad);

  Eigen::Matrix3d tilted_from_flat;
  Eigen::Matrix3d by_tau_x;  // its derivatives, per radian
  Eigen::Matrix3d by_tau_y;
};

}  // namespace lodemark
