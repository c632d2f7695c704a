// What a resection starts from: landmarks, the pixels they were seen at, and what else is known.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace lodemark {

// A landmark and where the photograph shows it.
struct LandmarkSight {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double pixel_sigma_px = 1.0;  // relative to the other sights; the common scale is estimated
  Eigen::Vector3d landmark_in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d landmark_covariance_m2 = Eigen::Matrix3d::Zero();
  double quality = 0.0;  // larger is surer; only the order matters: sampling begins with the surest
};

// Up, as the accelerometer at rest feels it.
struct GravityPrior {
  Eigen::Vector3d up_in_camera = Eigen::Vector3d::Zero();  // unit vector, camera axes
  double sigma_rad = 0.0;
};

// Where the camera is, as satellites say. The frame is the landmarks'.
struct PositionPrior {
  Eigen::Vector3d position_in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  // positive definite
};

struct ResectionPriors {
  std::optional<GravityPrior> gravity;
  std::optional<PositionPrior> position;
};

}  // namespace lodemark
