// Distances from a resected camera to the landmarks it saw: the paper's visual pseudolites.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

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
  double range_m = 0.0;
  double sigma_m = 0.0;  // of this range alone, from the pose's covariance
};

struct VisualRanges {
  std::vector<VisualRange> ranges;  // of the inliers
  // The full covariance of the ranges: they all come from one pose, so they share its errors.
  Eigen::MatrixXd covariance_m2;
  RangeVarianceModel model;  // fitted to the sigmas of these ranges by least squares
};

// No ranges if the pose is not one to use.
VisualRanges VisualRangesFrom(const ResectedPose& pose, std::span<const LandmarkSight> sights);

}  // namespace lodemark
