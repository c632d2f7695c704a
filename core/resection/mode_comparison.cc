#include "core/resection/mode_comparison.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/units.h"
#include "core/resection/pose_verdict.h"
#include "core/resection/refinement.h"

namespace lodemark {
namespace {

// Squared sigmas (of six unknowns) between poses that are two.
constexpr double kApart = 100.0;

// Where a pose is a hundred times as likely, the other one is out.
constexpr double kOpenLogRatio = 4.6;

// Times as many sights, of which the fewer do not say how noisy all are.
constexpr int kManyTimes = 2;

// Sights that agree with one pose only decide where their numbers differ by this many sigmas.
constexpr double kSigmasOfCounts = 3.0;
constexpr double kFewestOfTheirOwn = 4.0;

// A target this flat (thickness relative to length) may have a second answer, or one so small
// (length relative to distance) whatever its shape.
constexpr double kFlat = 0.15;
constexpr double kSmall = 0.05;

// Squared sigmas per component up to which the second answer explains the inliers at all.
constexpr double kPoorFit = 25.0;

// Of the pose that fits more closely, unless so few sights agree with it that they may do so by
// chance.
double CommonNoise(const AdjustedPose& first, const AdjustedPose& second) {
  if (kManyTimes * first.inliers < second.inliers) return second.noise_px;
  if (kManyTimes * second.inliers < first.inliers) return first.noise_px;
  return std::min(first.noise_px, second.noise_px);
}

}  // namespace

bool AreApart(const AdjustedPose& first, const AdjustedPose& second) {
  const Eigen::AngleAxisd turn(second.pose.rotation.conjugate() * first.pose.rotation);
  Vector6d difference;
  difference << second.pose.centre_in_enu_m - first.pose.centre_in_enu_m,
      turn.angle() * turn.axis();
  if (!first.covariance.is_determined) return difference.norm() > 1e-3;
  const Vector6d weighted = first.covariance.covariance.ldlt().solve(difference);
  return difference.dot(weighted) > kApart;
}

ModePreference Compare(const AdjustedPose& first, const AdjustedPose& second,
                       std::span<const LandmarkSight> sights, const Lens& lens,
                       const ResectionPriors& priors) {
  const double noise_px = CommonNoise(first, second);
  const std::vector<double> of_first = SquaresInSigmas(first.pose, sights, lens, noise_px);
  const std::vector<double> of_second = SquaresInSigmas(second.pose, sights, lens, noise_px);
  const double image_px2 = static_cast<double>(lens.parameters().width_px) *
                           static_cast<double>(lens.parameters().height_px);
  const double anywhere =
      std::max(2.0 * std::log(image_px2 / (2.0 * kPi * noise_px * noise_px)), kSquaredGate);
  double log_ratio = PriorCost(priors, second.pose, nullptr, nullptr) -
                     PriorCost(priors, first.pose, nullptr, nullptr);
  double only_first = 0.0;
  double only_second = 0.0;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    log_ratio += 0.5 * (std::min(of_second[i], anywhere) - std::min(of_first[i], anywhere));
    if (first.is_inlier[i] != 0 && second.is_inlier[i] == 0) only_first += 1.0;
    if (first.is_inlier[i] == 0 && second.is_inlier[i] != 0) only_second += 1.0;
  }
  ModePreference preference;
  preference.second_is_likelier = log_ratio < 0.0;
  const double lead = only_first - only_second;
  const bool even_counts =
      std::min(only_first, only_second) >= kFewestOfTheirOwn &&
      lead * lead < kSigmasOfCounts * kSigmasOfCounts * (only_first + only_second);
  preference.is_open = std::abs(log_ratio) < kOpenLogRatio || even_counts;
  return preference;
}

std::optional<CameraPose> ReversedMode(const AdjustedPose& adjusted,
                                       std::span<const LandmarkSight> sights, const Lens& lens,
                                       const ResectionPriors& priors) {
  const LandmarkSpread spread = SpreadOf(sights, adjusted.is_inlier);
  const double distance_m = (spread.mean - adjusted.pose.centre_in_enu_m).norm();
  const bool is_flat = spread.sigma_m[2] < kFlat * spread.sigma_m[0];
  const bool is_small = spread.sigma_m[0] < kSmall * distance_m;
  if (adjusted.inliers < 3 || (!is_flat && !is_small)) return std::nullopt;
  RefinementOptions options;
  options.noise_px = adjusted.noise_px;
  options.kernel_sigmas = 0.0;
  options.most_iterations = 40;
  const CameraPose reversed = ReversedPose(adjusted.pose, spread);
  const RefinedPose refined =
      RefinePose(reversed.camera_from_enu(), sights, adjusted.is_inlier, lens, priors, options);
  // Half a sum of squares, two for each inlier.
  if (!(refined.cost < kPoorFit * adjusted.inliers)) return std::nullopt;
  return CameraPose(refined.camera_from_enu);
}

}  // namespace lodemark
