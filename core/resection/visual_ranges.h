// Distances from a resected camera to the landmarks it saw: the paper's visual pseudolites.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/camera/lens.h"
#include "core/resection/resection.h"
#include "core/resection/sights.h"

namespace lodemark {

// How the standard deviation of a visual range grows with distance: the line Xu et al. (section 3)
// fit, sigma = offset + slope * distance.
struct RangeVarianceModel {
  double offset_m = 0.0;
  double slope = 0.0;
};

struct VisualRange {
  std::size_t sight = 0;  // index into the sights
  double range_m = 0.0;   // from the camera's estimated centre to the landmark as mapped
  double sigma_m = 0.0;   // of this range alone, against the true distance of camera and landmark
  Eigen::Vector3d direction_in_enu = Eigen::Vector3d::Zero();  // unit, from the camera
  // Of the landmark's error along the direction, and of that with the centre's error.
  double landmark_variance_m2 = 0.0;
  Eigen::Vector3d landmark_with_centre_m2 = Eigen::Vector3d::Zero();
};

struct VisualRanges {
  std::vector<VisualRange> ranges;  // of the inliers
  Eigen::Matrix3d centre_covariance_m2 = Eigen::Matrix3d::Zero();
  RangeVarianceModel model;  // fitted to the sigmas of these ranges by least squares

  // The full covariance of the ranges: they all come from one pose, so they share its errors.
  //
  // Against the distances of the camera to the landmarks as they truly stand. Where the mapped
  // coordinates are to be held fixed instead, the landmarks' errors drop out of what is left, and
  // the covariance of ranges i and j is direction_i' C direction_j, with C that of the centre: of
  // rank three, all ranges together say what the centre says.
  Eigen::MatrixXd Covariance() const;
};

// No ranges if the pose is not one to use. sights and lens: those of the resection.
VisualRanges VisualRangesFrom(const ResectedPose& pose, std::span<const LandmarkSight> sights,
                              const Lens& lens);

}  // namespace lodemark
