#include "core/resection/pose_adjustment.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/units.h"
#include "core/resection/noise_scale.h"
#include "core/resection/refinement.h"
#include "core/resection/shared_errors.h"

namespace lodemark {
namespace {

constexpr int kMostRounds = 8;
constexpr double kSteady = 1e-3;         // relative change of the noise
constexpr double kLeastNoise_px = 0.02;  // of what detectors give, and of rounding
constexpr double kWidestGate = 2.5;      // thresholds

// What is known of noise before any sight, for the gate, which it only widens: as much as so many
// residual components of a fifth of the threshold. It keeps the gate of a handful of sights from
// closing on those that happen to fit.
constexpr double kGateDegrees = 4.0;
constexpr double kGateShare = 0.2;
constexpr double kFewestDegrees = 6.0;

// Noise relative to the threshold that some sights are still within, for so many rounds; and the
// degrees of freedom below which noise may be that much although it does not show.
constexpr double kMostNoise = 0.7;
constexpr int kRoundsHeld = 2;
constexpr double kDoubtfulDegrees = 40.0;

// A sight that the pose was not made from strays by its own noise and by the pose's. Where the
// latter is more than so many times the former, agreement says nothing.
constexpr double kMostLeverage = 15.0;

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

  // is_noisy: from the most noise that the threshold allows down, else from what the sights within
  // the threshold show.
  void Settle(const Rigid3& start, bool is_noisy) {
    adjusted_.pose = CameraPose(start);
    residuals_ = ResidualsAt(adjusted_.pose, sights_, lens_);
    GuessNoise();
    if (is_noisy) adjusted_.noise_px = kMostNoise * threshold_px_;
    int rounds_held = is_noisy ? kRoundsHeld : 0;
    for (int round = 0; round < kMostRounds; ++round) {
      const bool same_inliers = !Gate(round > 0);
      RefinementOptions options;
      options.noise_px = adjusted_.noise_px;
      options.kernel_sigmas = 0.0;
      const RefinedPose refined = RefinePose(adjusted_.pose.camera_from_enu(), sights_,
                                             adjusted_.is_inlier, lens_, priors_, options);
      adjusted_.pose = CameraPose(refined.camera_from_enu);
      information_ = refined.information;
      residuals_ = ResidualsAt(adjusted_.pose, sights_, lens_);
      information_noise_px_ = adjusted_.noise_px;
      if (rounds_held-- > 0) continue;
      const double before_px = adjusted_.noise_px;
      EstimateNoise(FromSights(adjusted_.pose, refined.information, priors_));
      if (same_inliers && std::abs(adjusted_.noise_px - before_px) < kSteady * before_px) break;
    }
  }

  // Whether so few sights are left over that their noise may be another.
  bool IsInDoubt() const { return degrees_ < kDoubtfulDegrees; }

  // Logarithm of the probability of all sights, any pose, noise and share of mistaken ones being
  // alike beforehand: of these inliers about the pose, by Laplace's approximation about it, and of
  // the others anywhere in the image.
  double LogEvidence() const {
    const double image_px2 = static_cast<double>(lens_.parameters().width_px) *
                             static_cast<double>(lens_.parameters().height_px);
    double log_evidence = -PriorCost(priors_, adjusted_.pose, nullptr, nullptr);
    double inliers = 0.0;
    double outside = 0.0;
    for (std::size_t i = 0; i < residuals_.size(); ++i) {
      if (adjusted_.is_inlier[i] == 0 || !residuals_[i].is_seen) {
        log_evidence -= std::log(image_px2);
        outside += 1.0;
        continue;
      }
      Eigen::Matrix2d covariance = residuals_[i].noisy.others_px2;
      covariance.diagonal().array() +=
          adjusted_.noise_px * adjusted_.noise_px * residuals_[i].noisy.own_variance;
      log_evidence -= 0.5 * residuals_[i].SquareInSigmas(adjusted_.noise_px) +
                      0.5 * std::log(4.0 * kPi * kPi * covariance.determinant());
      inliers += 1.0;
    }
    const std::optional<Matrix6d> pose_covariance = InverseOfInformation(information_);
    if (!pose_covariance) return -std::numeric_limits<double>::infinity();
    const double scale = adjusted_.noise_px / information_noise_px_;
    log_evidence += 0.5 * std::log(pose_covariance->determinant()) + 6.0 * std::log(scale) -
                    0.5 * std::log(std::max(degrees_, 1.0));
    return log_evidence + std::lgamma(inliers + 1.0) + std::lgamma(outside + 1.0) -
           std::lgamma(inliers + outside + 2.0);
  }

  AdjustedPose Finish(const std::optional<IntrinsicsCovariance>& intrinsics) {
    // What the gate cuts off of good sights costs accuracy too.
    adjusted_.covariance_noise_px =
        NoiseThatCovers(adjusted_.noise_px, std::max(degrees_, 0.0),
                        gate_noise_px_ * std::sqrt(squared_gate_), kLeastNoise_px, threshold_px_) /
        std::sqrt(std::max(kept_, 0.5));
    adjusted_.covariance = CovarianceOf(adjusted_.pose, sights_, adjusted_.is_inlier, lens_,
                                        priors_, adjusted_.covariance_noise_px, intrinsics);
    if (adjusted_.covariance.is_determined) {
      const SharedErrors shared = FindSharedErrors(adjusted_.pose, sights_, adjusted_.is_inlier,
                                                   lens_, adjusted_.covariance_noise_px,
                                                   adjusted_.covariance.given_lens, intrinsics);
      adjusted_.covariance.covariance += shared.of_pose;
      adjusted_.shared_sigma_m = shared.sigma_m;
    }
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

  // True if the inliers change. has_pose: the inliers so far made the pose.
  bool Gate(bool has_pose) {
    gate_noise_px_ = GateNoise();
    squared_gate_ = SquaredGate();
    adjusted_.gate_noise_px = gate_noise_px_;
    const std::optional<Matrix6d> pose_covariance =
        has_pose ? InverseOfInformation(information_) : std::nullopt;
    // The information is that of another noise.
    const double scale = gate_noise_px_ / information_noise_px_;
    const double outside = static_cast<double>(sights_.size()) - adjusted_.inliers;
    const double odds = adjusted_.inliers / std::max(outside, 1.0);
    int inliers = 0;
    bool changes = false;
    for (std::size_t i = 0; i < residuals_.size(); ++i) {
      const double square = residuals_[i].SquareInSigmas(gate_noise_px_);
      std::uint8_t inlier = square < squared_gate_ ? 1 : 0;
      if (pose_covariance && inlier == 0 && adjusted_.is_inlier[i] == 0 &&
          square < (1.0 + kMostLeverage) * squared_gate_) {
        inlier = MayBelong(i, scale * scale * *pose_covariance, odds) ? 1 : 0;
      }
      changes = changes || inlier != adjusted_.is_inlier[i];
      adjusted_.is_inlier[i] = inlier;
      inliers += inlier;
    }
    adjusted_.inliers = inliers;
    return changes;
  }

  // Of a sight that the pose was not made from: whether it strays no further than both may make it,
  // and is likelier there than a mistaken one, which may be anywhere in the image.
  bool MayBelong(std::size_t i, const Matrix6d& pose_covariance, double odds) const {
    LinearSight linear;
    if (!Linearise(sights_[i], adjusted_.pose, lens_, &linear)) return false;
    const Eigen::Matrix2d own = PixelCovariance(sights_[i], linear.by_landmark, gate_noise_px_);
    const Eigen::Matrix2d of_pose = linear.by_pose * pose_covariance * linear.by_pose.transpose();
    if (!(of_pose.trace() < kMostLeverage * own.trace())) return false;
    const Eigen::Matrix2d both = own + of_pose;
    const Eigen::Vector2d weighted = both.inverse() * linear.residual_px;
    const double image_px2 = static_cast<double>(lens_.parameters().width_px) *
                             static_cast<double>(lens_.parameters().height_px);
    const double likelier =
        2.0 * std::log(odds * image_px2 / (2.0 * kPi * std::sqrt(both.determinant())));
    return linear.residual_px.dot(weighted) < std::min(squared_gate_, likelier);
  }

  // From the inliers, whose squares the gate cut off and the pose made less.
  void EstimateNoise(double from_sights) {
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
    if (degrees_ < 0.5) return;
    adjusted_.noise_px = NoiseFromSquares(inliers, degrees_, kLeastNoise_px, threshold_px_);
  }

  std::span<const LandmarkSight> sights_;
  const Lens& lens_;
  const ResectionPriors& priors_;
  double threshold_px_;
  std::vector<Residual> residuals_;
  Matrix6d information_ = Matrix6d::Zero();  // of the last adjustment, at this noise:
  double information_noise_px_ = 1.0;
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
  Adjustment adjustment(sights, lens, priors, threshold_px);
  adjustment.Settle(start, false);
  if (adjustment.IsInDoubt()) {
    // A few of the sights agree with each other to within little noise, or more of them to within
    // more.
    Adjustment noisy(sights, lens, priors, threshold_px);
    noisy.Settle(start, true);
    if (noisy.LogEvidence() > adjustment.LogEvidence()) return noisy.Finish(intrinsics);
  }
  return adjustment.Finish(intrinsics);
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
