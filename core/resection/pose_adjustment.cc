#include "core/resection/pose_adjustment.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/resection/noise_scale.h"
#include "core/resection/refinement.h"

namespace lodemark {
namespace {

constexpr int kMostRounds = 8;
constexpr double kSteady = 1e-3;         // relative change of the noise
constexpr double kLeastNoise_px = 0.02;  // of what detectors give, and of rounding
constexpr double kWidestGate = 2.5;      // thresholds

// What is known of noise before any sight: as much as so many residual components of a fifth of the
// threshold for the gate, which it only widens, of a tenth of it for the covariance. It keeps the
// gate of a handful of sights from closing on those that happen to fit.
constexpr double kGateDegrees = 4.0;
constexpr double kGateShare = 0.2;
constexpr double kFewestDegrees = 6.0;
constexpr double kCovarianceDegrees = 1.0;
constexpr double kCovarianceShare = 0.1;

// Residuals at a pose with what their covariance is made of.
struct Residual {
  bool is_seen = false;
  NoisyResidual noisy;

  double SquareInSigmas(double noise_px) const {
    if (!is_seen) return std::numeric_limits<double>::infinity();
    Eigen::Matrix2d covariance = noisy.others_px2;
    covariance.diagonal().array() += noise_px * noise_px * noisy.own_variance;
    const Eigen::Vector2d weighted = covariance.inverse() * noisy.residual_px;
    return noisy.residual_px.dot(weighted);
  }
};

std::vector<Residual> ResidualsAt(const CameraPose& pose, std::span<const LandmarkSight> sights,
                                  const Lens& lens) {
  std::vector<Residual> residuals(sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const LandmarkSight& sight = sights[i];
    NoisyResidual& noisy = residuals[i].noisy;
    noisy.own_variance = sight.pixel_sigma_px * sight.pixel_sigma_px;
    if (sight.landmark_covariance_m2.isZero(0.0)) {
      const std::optional<Eigen::Vector2d> pixel =
          lens.Project(pose.matrix * (sight.landmark_in_enu_m - pose.centre_in_enu_m));
      if (!pixel) continue;
      noisy.residual_px = sight.pixel - *pixel;
    } else {
      LinearSight linear;
      if (!Linearise(sight, pose, lens, &linear)) continue;
      noisy.residual_px = linear.residual_px;
      noisy.others_px2 = PixelCovariance(sight, linear.by_landmark, 0.0);
    }
    residuals[i].is_seen = noisy.residual_px.allFinite();
  }
  return residuals;
}

double FromSights(const CameraPose& pose, const Matrix6d& information,
                  const ResectionPriors& priors) {
  if (!priors.gravity && !priors.position) return 6.0;
  const std::optional<Matrix6d> inverse = InverseOfInformation(information);
  if (!inverse) return 6.0;
  Matrix6d of_priors = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  PriorCost(priors, pose, &of_priors, &right);
  return std::clamp(6.0 - (*inverse * of_priors).trace(), 0.0, 6.0);
}

class Adjustment {
 public:
  Adjustment(std::span<const LandmarkSight> sights, const Lens& lens, const ResectionPriors& priors,
             double threshold_px)
      : sights_(sights), lens_(lens), priors_(priors), threshold_px_(threshold_px) {
    adjusted_.is_inlier.assign(sights.size(), 0);
  }

  AdjustedPose Run(const Rigid3& start, const std::optional<IntrinsicsCovariance>& intrinsics) {
    adjusted_.pose = CameraPose(start);
    residuals_ = ResidualsAt(adjusted_.pose, sights_, lens_);
    GuessNoise();
    double degrees = 1.0;
    for (int round = 0; round < kMostRounds; ++round) {
      const bool same_inliers = !Gate();
      RefinementOptions options;
      options.noise_px = adjusted_.noise_px;
      options.kernel_sigmas = 0.0;
      const RefinedPose refined = RefinePose(adjusted_.pose.camera_from_enu(), sights_,
                                             adjusted_.is_inlier, lens_, priors_, options);
      adjusted_.pose = CameraPose(refined.camera_from_enu);
      residuals_ = ResidualsAt(adjusted_.pose, sights_, lens_);
      const double before_px = adjusted_.noise_px;
      degrees = EstimateNoise(FromSights(adjusted_.pose, refined.information, priors_));
      if (same_inliers && std::abs(adjusted_.noise_px - before_px) < kSteady * before_px) break;
    }
    adjusted_.covariance_noise_px = NoiseOfCovariance(degrees);
    adjusted_.covariance = CovarianceOf(adjusted_.pose, sights_, adjusted_.is_inlier, lens_,
                                        priors_, adjusted_.covariance_noise_px, intrinsics);
    adjusted_.residuals_px.reserve(sights_.size());
    for (const Residual& residual : residuals_) {
      adjusted_.residuals_px.push_back(
          residual.is_seen ? residual.noisy.residual_px
                           : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    return std::move(adjusted_);
  }

 private:
  // From the sights within the threshold, whose share of the noise is not known yet.
  void GuessNoise() {
    const double guess_px = threshold_px_ / 3.0;
    std::vector<double> squares;
    for (const Residual& residual : residuals_) {
      const double square = residual.SquareInSigmas(guess_px);
      if (square < 9.0) squares.push_back(square);
    }
    degrees_ = 2.0 * static_cast<double>(squares.size()) - 6.0;
    adjusted_.noise_px = std::max(guess_px * ScaleFromMedian(squares, 9.0), kLeastNoise_px);
  }

  // Noise that the gate is set by, given as many degrees of freedom as there are.
  double GateNoise() const {
    const double degrees = std::max(degrees_, 0.0);
    const double prior_px = kGateShare * threshold_px_;
    const double variance =
        (degrees * adjusted_.noise_px * adjusted_.noise_px + kGateDegrees * prior_px * prior_px) /
        (degrees + kGateDegrees);
    return std::max(std::sqrt(variance), adjusted_.noise_px);
  }

  // Squares of residuals over an estimated variance have an F distribution, whose tail for two
  // degrees of freedom is (1 + x / n)^(-n / 2).
  double SquaredGate() const {
    const double degrees = std::max(degrees_, kFewestDegrees);
    const double square = degrees * std::expm1(kSquaredGate / degrees);
    const double widest = kWidestGate * threshold_px_ / gate_noise_px_;
    return std::min(square, widest * widest);
  }

  // True if the inliers change.
  bool Gate() {
    gate_noise_px_ = GateNoise();
    squared_gate_ = SquaredGate();
    adjusted_.gate_noise_px = gate_noise_px_;
    adjusted_.inliers = 0;
    bool changes = false;
    for (std::size_t i = 0; i < residuals_.size(); ++i) {
      const std::uint8_t inlier =
          residuals_[i].SquareInSigmas(gate_noise_px_) < squared_gate_ ? 1 : 0;
      changes = changes || inlier != adjusted_.is_inlier[i];
      adjusted_.is_inlier[i] = inlier;
      adjusted_.inliers += inlier;
    }
    return changes;
  }

  // From the inliers, whose squares the gate cut off and the pose made less. Gives the degrees of
  // freedom.
  double EstimateNoise(double from_sights) {
    std::vector<NoisyResidual> inliers;
    inliers.reserve(residuals_.size());
    for (std::size_t i = 0; i < residuals_.size(); ++i) {
      if (adjusted_.is_inlier[i] != 0 && residuals_[i].is_seen) {
        inliers.push_back(residuals_[i].noisy);
      }
    }
    const double ratio = gate_noise_px_ / adjusted_.noise_px;
    kept_ = KeptVariance(squared_gate_ * ratio * ratio);
    degrees_ = 2.0 * kept_ * static_cast<double>(inliers.size()) - from_sights;
    if (degrees_ < 0.5) return degrees_;
    adjusted_.noise_px = NoiseFromSquares(inliers, degrees_, kLeastNoise_px, threshold_px_);
    return degrees_;
  }

  // The mean of the noise's variance given the residuals, which is larger than the estimate by what
  // few residuals leave open. What the gate cuts off of good sights costs accuracy too.
  double NoiseOfCovariance(double degrees) const {
    const double prior_px = kCovarianceShare * threshold_px_;
    const double squares = std::max(degrees, 0.0) * adjusted_.noise_px * adjusted_.noise_px +
                           kCovarianceDegrees * prior_px * prior_px;
    const double mean = squares / std::max(degrees + kCovarianceDegrees - 2.0, 1.0);
    return std::sqrt(mean / std::max(kept_, 0.5));
  }

  std::span<const LandmarkSight> sights_;
  const Lens& lens_;
  const ResectionPriors& priors_;
  double threshold_px_;
  std::vector<Residual> residuals_;
  double degrees_ = 0.0;
  double gate_noise_px_ = 0.0;
  double squared_gate_ = kSquaredGate;
  double kept_ = 1.0;
  AdjustedPose adjusted_;
};

}  // namespace

AdjustedPose AdjustPose(const Rigid3& start, std::span<const LandmarkSight> sights,
                        const Lens& lens, const ResectionPriors& priors, double threshold_px,
                        const std::optional<IntrinsicsCovariance>& intrinsics) {
  return Adjustment(sights, lens, priors, threshold_px).Run(start, intrinsics);
}

std::vector<double> SquaresInSigmas(const CameraPose& pose, std::span<const LandmarkSight> sights,
                                    const Lens& lens, double noise_px) {
  std::vector<double> squares;
  squares.reserve(sights.size());
  for (const Residual& residual : ResidualsAt(pose, sights, lens)) {
    squares.push_back(residual.SquareInSigmas(noise_px));
  }
  return squares;
}

}  // namespace lodemark
