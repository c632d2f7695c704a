#include "test/experiments/photo_bound.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace lodemark {

Matrix6d PhotoInformation(const std::vector<LandmarkSight>& sights, const Lens& lens,
                          const Eigen::Quaterniond& camera_from_enu,
                          const Eigen::Vector3d& centre_in_enu_m, double gravity_sigma_rad) {
  const CameraPose pose(Rigid3(camera_from_enu, -(camera_from_enu * centre_in_enu_m)));
  Matrix6d information = Matrix6d::Zero();
  LinearSight linear;
  for (const LandmarkSight& sight : sights) {
    if (!Linearise(sight, pose, lens, &linear)) continue;
    const Eigen::Matrix2d covariance = PixelCovariance(sight, linear.by_landmark, 1.0);
    information += linear.by_pose.transpose() * covariance.inverse() * linear.by_pose;
  }
  // Gravity tells the turns about east and north.
  for (const int turn : {3, 4}) {
    information(turn, turn) += 1.0 / (gravity_sigma_rad * gravity_sigma_rad);
  }
  return information;
}

Eigen::Matrix3d CentreBound(const Matrix6d& information) {
  const Eigen::LLT<Matrix6d> factor(information);
  if (factor.info() != Eigen::Success) {
    return std::numeric_limits<double>::infinity() * Eigen::Matrix3d::Ones();
  }
  const Matrix6d covariance = factor.solve(Matrix6d::Identity());
  return covariance.topLeftCorner<3, 3>();
}

Eigen::Matrix3d CentreInformation(const Matrix6d& information) {
  const Eigen::Matrix3d cross = information.topRightCorner<3, 3>();
  const Eigen::LLT<Eigen::Matrix3d> attitude(information.bottomRightCorner<3, 3>());
  return information.topLeftCorner<3, 3>() -
         cross * attitude.solve(Eigen::Matrix3d(cross.transpose()));
}

Eigen::Quaterniond LevelCamera(double heading_rad, double pitch_rad, double roll_rad) {
  // Level first: right, down, forward in rows.
  Eigen::Matrix3d level;
  level << std::cos(heading_rad), -std::sin(heading_rad), 0.0, 0.0, 0.0, -1.0,
      std::sin(heading_rad), std::cos(heading_rad), 0.0;
  return Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(-pitch_rad, Eigen::Vector3d::UnitX()) * Eigen::Quaterniond(level);
}

}  // namespace lodemark
