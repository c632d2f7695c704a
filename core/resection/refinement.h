// The collinearity adjustment: a pose refined on the pixels of its sights (Xu et al., equations 9
// to 12), by Levenberg-Marquardt with a robust kernel, and its covariance.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/resection/sights.h"

namespace lodemark {

struct RefinementOptions {
  double noise_px = 1.0;  // of a sight with pixel_sigma_px 1
  // Truncated-quadratic-like kernel: sights beyond this many sigma stop counting. 0: least squares.
  double kernel_sigmas = 3.0;
  int most_iterations = 25;
};

struct RefinedPose {
  Rigid3 camera_from_enu;
  double cost = 0.0;  // half the sum of squared, weighted, robustified residuals
  int iterations = 0;
  bool converged = false;
  // Normal equations at the end, order as ResectedPose::covariance, for the noise given.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

// Uses the sights with is_used[i] != 0; an empty span means all. Never gives a worse cost than the
// start has.
RefinedPose RefinePose(const Rigid3& start_camera_from_enu, std::span<const LandmarkSight> sights,
                       std::span<const std::uint8_t> is_used, const Lens& lens,
                       const ResectionPriors& priors, const RefinementOptions& options);

}  // namespace lodemark
