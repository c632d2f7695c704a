#include "core/resection/visual_ranges.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/resection/collinearity.h"

namespace lodemark {
namespace {

RangeVarianceModel Fitted(const std::vector<VisualRange>& ranges) {
  double mean_range = 0.0;
  double mean_sigma = 0.0;
  const double count = static_cast<double>(ranges.size());
  for (const VisualRange& range : ranges) {
    mean_range += range.range_m / count;
    mean_sigma += range.sigma_m / count;
  }
  double square = 0.0;
  double product = 0.0;
  for (const VisualRange& range : ranges) {
    const double offset = range.range_m - mean_range;
    square += offset * offset;
    product += offset * (range.sigma_m - mean_sigma);
  }
  RangeVarianceModel model;
  // All but one distance has no slope.
  if (square > 1e-12 * count * mean_range * mean_range) model.slope = product / square;
  model.offset_m = mean_sigma - model.slope * mean_range;
  return model;
}

// Between two different ranges.
double SharedCovariance(const Eigen::Matrix3d& of_centre, const VisualRange& a,
                        const VisualRange& b) {
  const Eigen::Vector3d centre_with_b = of_centre * b.direction_in_enu;
  return a.direction_in_enu.dot(centre_with_b) - a.landmark_with_centre_m2.dot(b.direction_in_enu) -
         b.landmark_with_centre_m2.dot(a.direction_in_enu);
}

}  // namespace

Eigen::MatrixXd VisualRanges::Covariance() const {
  const Eigen::Index count = static_cast<Eigen::Index>(ranges.size());
  Eigen::MatrixXd covariance(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    const VisualRange& from = ranges[static_cast<std::size_t>(a)];
    covariance(a, a) = from.sigma_m * from.sigma_m;
    for (Eigen::Index b = 0; b < a; ++b) {
      covariance(a, b) =
          SharedCovariance(centre_covariance_m2, from, ranges[static_cast<std::size_t>(b)]);
      covariance(b, a) = covariance(a, b);
    }
  }
  return covariance;
}

// With d the errors (estimated or mapped minus true), N the normal matrix of the adjustment, V_i
// the covariance of residual i, J_i and P_i its derivatives by the pose and by the landmark, S_i
// the landmark's covariance, the joint adjustment gives
//   d_pose = N^-1 sum J_i' V_i^-1 (noise_i - P_i d_landmark_i),
//   Cov(d_pose, d_landmark_i) = -N^-1 J_i' V_i^-1 P_i S_i,
// and a range errs by direction_i . (d_landmark_i - d_centre).
VisualRanges VisualRangesFrom(const ResectedPose& pose, std::span<const LandmarkSight> sights,
                              const Lens& lens) {
  VisualRanges visual;
  const bool is_usable = pose.verdict == PoseVerdict::kPose || pose.verdict == PoseVerdict::kWeak;
  if (!is_usable || pose.is_inlier.size() != sights.size()) return visual;
  const CameraPose camera(pose.camera_from_enu);
  visual.centre_covariance_m2 = pose.covariance.topLeftCorner<3, 3>();
  LinearSight linear;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const LandmarkSight& sight = sights[i];
    const Eigen::Vector3d ray = sight.landmark_in_enu_m - camera.centre_in_enu_m;
    if (pose.is_inlier[i] == 0 || !(ray.norm() > 0.0)) continue;
    if (!Linearise(sight, camera, lens, &linear)) continue;
    VisualRange range;
    range.sight = i;
    range.range_m = ray.norm();
    range.direction_in_enu = ray / range.range_m;
    const Eigen::Matrix2d weight =
        PixelCovariance(sight, linear.by_landmark, pose.noise_px).inverse();
    const Eigen::Vector3d landmark = sight.landmark_covariance_m2 * range.direction_in_enu;
    const Vector6d pull = linear.by_pose.transpose() * (weight * (linear.by_landmark * landmark));
    range.landmark_with_centre_m2 = -(pose.covariance_given_lens.topRows<3>() * pull);
    range.landmark_variance_m2 = range.direction_in_enu.dot(landmark);
    const double variance_m2 =
        SharedCovariance(visual.centre_covariance_m2, range, range) + range.landmark_variance_m2;
    range.sigma_m = std::sqrt(std::max(variance_m2, 0.0));
    visual.ranges.push_back(range);
  }
  if (!visual.ranges.empty()) visual.model = Fitted(visual.ranges);
  return visual;
}

}  // namespace lodemark
