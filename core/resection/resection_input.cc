#include "core/resection/resection_input.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <string>

namespace lodemark {
namespace {

// A unit vector given in single precision is one to this.
constexpr double kUnitLength = 1e-3;

// Numbers beyond these have lost what a resection needs of them.
constexpr double kFarthest_m = 1e9;
constexpr double kFarthest_px = 1e7;
constexpr double kLeastSigma = 1e-6;
constexpr double kMostSigma = 1e6;

Error Invalid(const std::string& what) { return {ErrorCode::kInvalidArgument, what}; }

bool IsWithin(double value, double least, double most) { return value >= least && value <= most; }

// Symmetric to rounding, with no negative variance along any direction.
template <typename Matrix>
bool IsCovariance(const Matrix& matrix) {
  if (!matrix.allFinite()) return false;
  const double size = matrix.cwiseAbs().maxCoeff();
  if (size == 0.0) return true;
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > 1e-6 * size) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(matrix / size, Eigen::EigenvaluesOnly);
  return eigen.info() == Eigen::Success && eigen.eigenvalues()[0] > -1e-6;
}

Status CheckSight(const LandmarkSight& sight, const std::string& name) {
  if (!sight.pixel.allFinite() || sight.pixel.cwiseAbs().maxCoeff() > kFarthest_px) {
    return Invalid(name + ": its pixel is not finite, or 1e7 px away");
  }
  if (!IsWithin(sight.pixel_sigma_px, kLeastSigma, kMostSigma)) {
    return Invalid(name + ": its pixel sigma is not within 1e-6 to 1e6");
  }
  if (!sight.landmark_in_enu_m.allFinite() ||
      sight.landmark_in_enu_m.cwiseAbs().maxCoeff() > kFarthest_m) {
    return Invalid(name + ": its landmark is not finite, or 1e9 m away");
  }
  if (std::isnan(sight.quality)) return Invalid(name + ": its quality is not a number");
  const Eigen::Matrix3d& covariance = sight.landmark_covariance_m2;
  if (!covariance.isZero(0.0) && (!IsCovariance(covariance) || covariance.trace() > 1e18)) {
    return Invalid(name + ": its landmark's covariance is none");
  }
  return {};
}

Status CheckPriors(const ResectionPriors& priors) {
  if (priors.gravity) {
    if (!(std::abs(priors.gravity->up_in_camera.norm() - 1.0) < kUnitLength)) {
      return Invalid("gravity prior: up is not a unit vector");
    }
    if (!IsWithin(priors.gravity->sigma_rad, kLeastSigma, kMostSigma)) {
      return Invalid("gravity prior: its sigma is not within 1e-6 to 1e6 rad");
    }
  }
  if (!priors.position) return {};
  const PositionPrior& position = *priors.position;
  if (!position.position_in_enu_m.allFinite() ||
      position.position_in_enu_m.cwiseAbs().maxCoeff() > kFarthest_m) {
    return Invalid("position prior: it is not finite, or 1e9 m away");
  }
  const Eigen::Matrix3d& covariance = position.covariance_m2;
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
  if (!IsCovariance(covariance) || factor.info() != Eigen::Success ||
      !(covariance.diagonal().minCoeff() >= kLeastSigma * kLeastSigma) ||
      !(covariance.trace() < 1e24) || !(factor.rcond() > 1e-14)) {
    return Invalid("position prior: its covariance is not positive definite");
  }
  return {};
}

}  // namespace

Status CheckResectionInput(std::span<const LandmarkSight> sights, const ResectionPriors& priors,
                           const ResectionOptions& options) {
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (Status status = CheckSight(sights[i], "sight " + std::to_string(i)); !status) return status;
  }
  if (Status status = CheckPriors(priors); !status) return status;
  if (!IsWithin(options.inlier_threshold_px, 1e-3, 1e4)) {
    return Invalid("resection: the inlier threshold is not within 1e-3 to 1e4 px");
  }
  if (options.most_samples < 1) return Invalid("resection: most_samples is less than 1");
  if (!(options.wanted_confidence > 0.0 && options.wanted_confidence < 1.0)) {
    return Invalid("resection: wanted_confidence is not between 0 and 1");
  }
  if (options.intrinsics_covariance && !IsCovariance(*options.intrinsics_covariance)) {
    return Invalid("resection: the covariance of the intrinsics is none");
  }
  return {};
}

}  // namespace lodemark
