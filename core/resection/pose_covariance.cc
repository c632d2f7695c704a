#include "core/resection/pose_covariance.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <cstddef>

namespace lodemark {
namespace {

// Ratio of the eigenvalues of a scaled normal matrix below which its directions are rounding.
constexpr double kSingular = 1e-13;

}  // namespace

std::optional<Matrix6d> InverseOfInformation(const Matrix6d& information) {
  const Vector6d diagonal = information.diagonal();
  if (!information.allFinite() || !(diagonal.minCoeff() > 0.0)) return std::nullopt;
  const Vector6d scale = diagonal.cwiseSqrt().cwiseInverse();
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled);
  if (eigen.info() != Eigen::Success) return std::nullopt;
  const Vector6d values = eigen.eigenvalues();
  if (!(values[0] > kSingular * values[5])) return std::nullopt;
  const Matrix6d inverse =
      eigen.eigenvectors() * values.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  const Matrix6d unscaled = scale.asDiagonal() * inverse * scale.asDiagonal();
  const Matrix6d symmetric = 0.5 * (unscaled + unscaled.transpose());
  return symmetric;
}

PoseCovariance CovarianceOf(const CameraPose& pose, std::span<const LandmarkSight> sights,
                            std::span<const std::uint8_t> is_used, const Lens& lens,
                            const ResectionPriors& priors, double noise_px,
                            const std::optional<IntrinsicsCovariance>& intrinsics) {
  Matrix6d of_sights = Matrix6d::Zero();
  Eigen::Matrix<double, 6, kMostIntrinsics> of_lens =
      Eigen::Matrix<double, 6, kMostIntrinsics>::Zero();
  LinearSight linear;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (is_used[i] == 0 || !Linearise(sights[i], pose, lens, &linear)) continue;
    const Eigen::Matrix2d weight =
        PixelCovariance(sights[i], linear.by_landmark, noise_px).inverse();
    const Eigen::Matrix<double, 6, 2> weighted = linear.by_pose.transpose() * weight;
    of_sights.noalias() += weighted * linear.by_pose;
    if (intrinsics) of_lens.noalias() += weighted * linear.by_intrinsics;
  }
  Matrix6d information = of_sights;
  Vector6d right = Vector6d::Zero();
  PriorCost(priors, pose, &information, &right);

  PoseCovariance result;
  const std::optional<Matrix6d> inverse = InverseOfInformation(information);
  if (!inverse) return result;
  result.is_determined = true;
  result.given_lens = *inverse;
  result.covariance = *inverse;
  result.from_sights = (*inverse * of_sights).trace();
  if (intrinsics) {
    const Eigen::Matrix<double, 6, kMostIntrinsics> sensitivity = *inverse * of_lens;
    const Matrix6d from_lens = sensitivity * *intrinsics * sensitivity.transpose();
    result.covariance += 0.5 * (from_lens + from_lens.transpose());
  }
  return result;
}

}  // namespace lodemark
