// One sight under the collinearity equations (Xu et al., equation 9), linearised as their
// equations 10 and 11 do: what refinement, covariance and visual ranges have in common.
#pragma once

#include <Eigen/Core>

#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/resection/sights.h"

namespace lodemark {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

// A pose by its rotation and its centre. Its six unknowns are a shift of the centre (metres) and a
// small rotation of the camera, both along east, north and up:
// enu_from_camera = exp(rotation) * estimate.
struct CameraPose {
  CameraPose() = default;
  explicit CameraPose(const Rigid3& camera_from_enu)
      : rotation(camera_from_enu.rotation()),
        matrix(rotation.toRotationMatrix()),
        centre_in_enu_m(-(matrix.transpose() * camera_from_enu.translation())) {}

  Rigid3 camera_from_enu() const { return {rotation, -(rotation * centre_in_enu_m)}; }
  CameraPose Moved(const Vector6d& step) const;

  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // camera from ENU
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();          // the same
  Eigen::Vector3d centre_in_enu_m = Eigen::Vector3d::Zero();
};

struct LinearSight {
  Eigen::Vector2d residual_px;              // seen minus predicted
  Eigen::Matrix<double, 2, 6> by_pose;      // of the predicted pixel, by the six unknowns
  Eigen::Matrix<double, 2, 3> by_landmark;  // by the landmark in ENU
  Eigen::Matrix<double, 2, kMostIntrinsics> by_intrinsics;
};

// False where the lens does not image the landmark.
bool Linearise(const LandmarkSight& sight, const CameraPose& pose, const Lens& lens,
               LinearSight* linear);

// Of a sight's residual: noise_px times its own sigma, and what its landmark's covariance does.
inline Eigen::Matrix2d PixelCovariance(const LandmarkSight& sight,
                                       const Eigen::Matrix<double, 2, 3>& by_landmark,
                                       double noise_px) {
  const double sigma_px = noise_px * sight.pixel_sigma_px;
  Eigen::Matrix2d covariance = by_landmark * sight.landmark_covariance_m2 * by_landmark.transpose();
  covariance.diagonal().array() += sigma_px * sigma_px;
  return covariance;
}

// Half the sum of squares of what the priors say against the pose. Adds their normal equations
// where given: information, and the right side for residuals "said minus predicted".
double PriorCost(const ResectionPriors& priors, const CameraPose& pose, Matrix6d* information,
                 Vector6d* right);

}  // namespace lodemark
