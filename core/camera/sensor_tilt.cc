#include "core/camera/sensor_tilt.h"

#include <cmath>

namespace lodemark {
namespace {

// Brings the turned image back to the plane z = 1 of the untilted axes; the last entry is the
// matrix's own 1, or 0 in a derivative.
Eigen::Matrix3d ToPlane(const Eigen::Matrix3d& turn, double last) {
  Eigen::Matrix3d to_plane;
  to_plane << turn(2, 2), 0.0, -turn(0, 2), 0.0, turn(2, 2), -turn(1, 2), 0.0, 0.0, last;
  return to_plane;
}

}  // namespace

SensorTilt::SensorTilt(double tau_x_rad, double tau_y_rad) {
  const double cx = std::cos(tau_x_rad);
  const double sx = std::sin(tau_x_rad);
  const double cy = std::cos(tau_y_rad);
  const double sy = std::sin(tau_y_rad);
  Eigen::Matrix3d about_x;
  Eigen::Matrix3d about_y;
  Eigen::Matrix3d about_x_slope;
  Eigen::Matrix3d about_y_slope;
  about_x << 1.0, 0.0, 0.0, 0.0, cx, sx, 0.0, -sx, cx;
  about_y << cy, 0.0, -sy, 0.0, 1.0, 0.0, sy, 0.0, cy;
  about_x_slope << 0.0, 0.0, 0.0, 0.0, -sx, cx, 0.0, -cx, -sx;
  about_y_slope << -sy, 0.0, -cy, 0.0, 0.0, 0.0, cy, 0.0, -sy;

  const Eigen::Matrix3d turn = about_y * about_x;
  const Eigen::Matrix3d turn_by_x = about_y * about_x_slope;
  const Eigen::Matrix3d turn_by_y = about_y_slope * about_x;
  tilted_from_flat = ToPlane(turn, 1.0) * turn;
  by_tau_x = ToPlane(turn_by_x, 0.0) * turn + ToPlane(turn, 1.0) * turn_by_x;
  by_tau_y = ToPlane(turn_by_y, 0.0) * turn + ToPlane(turn, 1.0) * turn_by_y;
}

}  // namespace lodemark
