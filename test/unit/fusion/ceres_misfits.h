// Ranges and bearings as residuals of Ceres, which knows nothing of ours.
#pragma once

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Core>

#include "core/fusion/observation.h"

namespace lodemark {

// Unknowns: metres from the origin in ECEF axes; clock; rotation vector of the camera's attitude
// against the start.
struct RangeMisfit {
  template <typename T>
  bool operator()(const T* offset, const T* clock, T* residual) const {
    const Eigen::Matrix<T, 3, 1> line = (range.point_in_ecef - origin).template cast<T>() -
                                        Eigen::Map<const Eigen::Matrix<T, 3, 1>>(offset);
    residual[0] = (range.range_m - line.norm() - clock[0]) / range.error.sigma_m;
    return true;
  }
  RangeObservation range;
  Eigen::Vector3d origin;
};

struct BearingMisfit {
  template <typename T>
  bool operator()(const T* offset, const T* turn, T* residual) const {
    const Eigen::Matrix<T, 3, 1> line = (bearing.point_in_ecef - origin).template cast<T>() -
                                        Eigen::Map<const Eigen::Matrix<T, 3, 1>>(offset);
    const Eigen::Matrix<T, 3, 1> unturned = camera_from_ecef.template cast<T>() * line;
    Eigen::Matrix<T, 3, 1> q;
    ceres::AngleAxisRotatePoint(turn, unturned.data(), q.data());
    const T along = bearing.direction_in_camera.template cast<T>().dot(q);
    Eigen::Map<Eigen::Matrix<T, 2, 1>> out(residual);
    out = bearing.whitener.template cast<T>() * q / along;
    return true;
  }
  BearingObservation bearing;
  Eigen::Vector3d origin;
  Eigen::Matrix3d camera_from_ecef;
};

}  // namespace lodemark
