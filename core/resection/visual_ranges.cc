#include "core/resection/visual_ranges.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/resection/collinearity.h"

namespace lodemark {
namespace {

// The inliers to give, by index.
std::vector<std::size_t> Chosen(const ResectedPose& pose, std::span<const LandmarkSight> sights,
                                std::size_t most) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (pose.is_inlier[i] != 0) chosen.push_back(i);
  }
  if (chosen.size() <= most) return chosen;
  std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
    return sights[a].quality > sights[b].quality;
  });
  chosen.resize(most);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

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

}  // namespace

// With d the errors (estimated or mapped minus true), N the normal matrix of the adjustment, V_i
// the covariance of residual i, J_i and P_i its derivatives by the pose and by the landmark, S_i
// the landmark's covariance, the joint adjustment gives
//   d_pose = N^-1 sum J_i' V_i^-1 (noise_i - P_i d_landmark_i),
//   Cov(d_pose, d_landmark_i) = -N^-1 J_i' V_i^-1 P_i S_i,
// and a range errs by direction_i . (d_landmark_i - d_centre).
VisualRanges VisualRangesFrom(const ResectedPose& pose, std::span<const LandmarkSight> sights,
                              const Lens& lens, const VisualRangeOptions& options) {
  VisualRanges visual;
  const bool is_usable = pose.verdict == PoseVerdict::kPose || pose.verdict == PoseVerdict::kWeak;
  if (!is_usable || pose.is_inlier.size() != sights.size()) return visual;
  const CameraPose camera(pose.camera_from_enu);

  // For each range: its direction, Cov(d_centre, d_landmark) direction, and the landmark's own
  // part.
  std::vector<Eigen::Vector3d> with_centre;
  std::vector<double> own_m2;
  LinearSight linear;
  for (const std::size_t i : Chosen(pose, sights, options.most_ranges)) {
    const LandmarkSight& sight = sights[i];
    const Eigen::Vector3d ray = sight.landmark_in_enu_m - camera.centre_in_enu_m;
    if (!(ray.norm() > 0.0) || !Linearise(sight, camera, lens, &linear)) continue;
    VisualRange range;
    range.sight = i;
    range.range_m = ray.norm();
    range.direction_in_enu = ray / range.range_m;
    const Eigen::Matrix2d weight =
        PixelCovariance(sight, linear.by_landmark, pose.noise_px).inverse();
    const Eigen::Vector3d landmark = sight.landmark_covariance_m2 * range.direction_in_enu;
    const Vector6d pull = linear.by_pose.transpose() * (weight * (linear.by_landmark * landmark));
    with_centre.push_back(-(pose.covariance_given_lens.topRows<3>() * pull));
    own_m2.push_back(range.direction_in_enu.dot(landmark));
    visual.ranges.push_back(range);
  }

  const Eigen::Index count = static_cast<Eigen::Index>(visual.ranges.size());
  const Eigen::Matrix3d of_centre = pose.covariance.topLeftCorner<3, 3>();
  visual.covariance_m2.resize(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    const std::size_t i = static_cast<std::size_t>(a);
    const Eigen::Vector3d& from = visual.ranges[i].direction_in_enu;
    const Eigen::Vector3d centre_with_from = of_centre * from;
    for (Eigen::Index b = 0; b <= a; ++b) {
      const std::size_t j = static_cast<std::size_t>(b);
      const Eigen::Vector3d& to = visual.ranges[j].direction_in_enu;
      double covariance =
          centre_with_from.dot(to) - with_centre[i].dot(to) - with_centre[j].dot(from);
      if (a == b) covariance += own_m2[i];
      visual.covariance_m2(a, b) = covariance;
      visual.covariance_m2(b, a) = covariance;
    }
    visual.ranges[i].sigma_m = std::sqrt(std::max(visual.covariance_m2(a, a), 0.0));
  }
  if (count > 0) visual.model = Fitted(visual.ranges);
  return visual;
}

}  // namespace lodemark
