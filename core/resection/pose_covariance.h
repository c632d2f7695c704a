// How well the sights hold a pose: the inverse of its normal equations, and what the lens's own
// uncertainty adds.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "core/camera/lens.h"
#include "core/resection/collinearity.h"
#include "core/resection/sights.h"

namespace lodemark {

using IntrinsicsCovariance = Eigen::Matrix<double, kMostIntrinsics, kMostIntrinsics>;

struct PoseCovariance {
  bool is_determined = false;              // the others are meaningless where it is not
  Matrix6d given_lens = Matrix6d::Zero();  // were the lens known exactly
  Matrix6d covariance = Matrix6d::Zero();
  // How many of the six unknowns' worth the sights determine, the priors the rest.
  double from_sights = 6.0;
};

// Normal matrix of the sights with is_used, each at its own covariance, and of the priors.
//
// The sights' residuals are taken as independent, the landmarks' errors with them. An error of the
// lens moves all pixels at once: with N the normal matrix, V a sight's covariance, J and K its
// derivatives by the pose and by the lens, the pose moves by N^-1 sum(J' V^-1 K) times it.
PoseCovariance CovarianceOf(const CameraPose& pose, std::span<const LandmarkSight> sights,
                            std::span<const std::uint8_t> is_used, const Lens& lens,
                            const ResectionPriors& priors, double noise_px,
                            const std::optional<IntrinsicsCovariance>& intrinsics);

// The inverse of a symmetric matrix whose rows may differ in unit; nothing if it is not positive
// definite to within rounding.
std::optional<Matrix6d> InverseOfInformation(const Matrix6d& information);

}  // namespace lodemark
