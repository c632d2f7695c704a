// Small rotations as vectors: about which axis, and by how many radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace lodemark {

// CrossOf(v) * w = v x w. Columns: what a rotation about each axis does to v, negated.
inline Eigen::Matrix3d CrossOf(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

inline Eigen::Quaterniond Turn(const Eigen::Vector3d& turn_rad) {
  const double angle_rad = turn_rad.norm();
  if (angle_rad < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad));
}

// The shortest, at most half a turn.
inline Eigen::Vector3d TurnOf(const Eigen::Quaterniond& rotation) {
  const double cosine = rotation.w() < 0.0 ? -rotation.w() : rotation.w();
  const Eigen::Vector3d vec =
      rotation.w() < 0.0 ? Eigen::Vector3d(-rotation.vec()) : rotation.vec();
  const double sine = vec.norm();
  if (sine < 1e-12) return 2.0 * vec;
  return (2.0 * std::atan2(sine, cosine) / sine) * vec;
}

}  // namespace lodemark
