#include "core/resection/collinearity.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "core/geo/rotation.h"

namespace lodemark {
CameraPose CameraPose::Moved(const Vector6d& step) const {
  CameraPose moved;
  moved.centre_in_enu_m = centre_in_enu_m + step.head<3>();
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle_rad = turn.norm();
  // sin(a / 2) / a, by its series where the angle is small.
  const double scale =
      angle_rad > 1e-4 ? std::sin(0.5 * angle_rad) / angle_rad : 0.5 - angle_rad * angle_rad / 48.0;
  const Eigen::Vector3d half = -scale * turn;
  const Eigen::Quaterniond inverse_turn(std::cos(0.5 * angle_rad), half.x(), half.y(), half.z());
  moved.rotation = (rotation * inverse_turn).normalized();
  moved.matrix = moved.rotation.toRotationMatrix();
  return moved;
}

bool Linearise(const LandmarkSight& sight, const CameraPose& pose, const Lens& lens,
               LinearSight* linear) {
  const Eigen::Vector3d ray_in_enu = sight.landmark_in_enu_m - pose.centre_in_enu_m;
  const Eigen::Vector3d point_in_camera = pose.matrix * ray_in_enu;
  ProjectionJacobian jacobian;
  const std::optional<Eigen::Vector2d> pixel = lens.Project(point_in_camera, &jacobian);
  if (!pixel || !pixel->allFinite()) return false;
  linear->residual_px = sight.pixel - *pixel;
  linear->by_landmark = jacobian.by_point * pose.matrix;
  linear->by_pose.leftCols<3>() = -linear->by_landmark;
  linear->by_pose.rightCols<3>() = linear->by_landmark * CrossOf(ray_in_enu);
  linear->by_intrinsics = jacobian.by_intrinsics;
  return true;
}

double PriorCost(const ResectionPriors& priors, const CameraPose& pose, Matrix6d* information,
                 Vector6d* right) {
  double cost = 0.0;
  if (priors.gravity) {
    // The chord between both verticals grows with their angle up to half a turn.
    const double weight = 1.0 / (priors.gravity->sigma_rad * priors.gravity->sigma_rad);
    const Eigen::Vector3d up_in_camera = pose.matrix.col(2);
    const Eigen::Vector3d residual = priors.gravity->up_in_camera - up_in_camera;
    cost += 0.5 * weight * residual.squaredNorm();
    if (information != nullptr) {
      const Eigen::Matrix3d by_rotation = pose.matrix * CrossOf(Eigen::Vector3d::UnitZ());
      information->bottomRightCorner<3, 3>() += weight * by_rotation.transpose() * by_rotation;
      right->tail<3>() += weight * by_rotation.transpose() * residual;
    }
  }
  if (priors.position) {
    const Eigen::LLT<Eigen::Matrix3d> factor(priors.position->covariance_m2);
    const Eigen::Vector3d residual = priors.position->position_in_enu_m - pose.centre_in_enu_m;
    const Eigen::Vector3d weighted = factor.solve(residual);
    cost += 0.5 * residual.dot(weighted);
    if (information != nullptr) {
      information->topLeftCorner<3, 3>() += factor.solve(Eigen::Matrix3d::Identity());
      right->head<3>() += weighted;
    }
  }
  return cost;
}

}  // namespace lodemark
