// From a pose that sights agree on to the adjusted one: which sights are mistaken, how noisy the
// others are, and where they put the camera, each by the other two until nothing changes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/resection/pose_covariance.h"
#include "core/resection/sights.h"

namespace lodemark {

struct AdjustedPose {
  CameraPose pose;
  double noise_px = 0.0;
  // Of the distribution that the covariance stands for: noise_px, and the doubt that few sights
  // leave about it.
  double covariance_noise_px = 0.0;
  double gate_noise_px = 0.0;  // no less than noise_px: what a gate should allow for
  std::vector<std::uint8_t> is_inlier;
  std::vector<Eigen::Vector2d> residuals_px;  // not a number where there is none
  int inliers = 0;
  PoseCovariance covariance;    // with what the errors of neighbouring landmarks have in common
  double shared_sigma_m = 0.0;  // of that
};

// threshold_px: within it, sights agree at the start.
AdjustedPose AdjustPose(const Rigid3& start, std::span<const LandmarkSight> sights,
                        const Lens& lens, const ResectionPriors& priors, double threshold_px,
                        const std::optional<IntrinsicsCovariance>& intrinsics);

// Squares of the residuals in sigmas at the given noise, infinite where there is none.
std::vector<double> SquaresInSigmas(const CameraPose& pose, std::span<const LandmarkSight> sights,
                                    const Lens& lens, double noise_px);

// Squared sigmas that all but one in a thousand residuals keep within (chi-square, two degrees of
// freedom).
inline constexpr double kSquaredGate = 13.815510557964274;

}  // namespace lodemark
