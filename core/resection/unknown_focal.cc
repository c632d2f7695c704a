#include "core/resection/unknown_focal.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/resection/collinearity.h"
#include "core/resection/focal_search.h"
#include "core/resection/pose_adjustment.h"
#include "core/resection/resection_input.h"

namespace lodemark {
namespace {

// Four leave one equation over.
constexpr std::size_t kFewestSights = 5;

constexpr int kMostSteps = 30;
constexpr int kMostRounds = 6;
constexpr double kSteady = 1e-6;  // relative change of the focal length

// Searches for a start, each by draws of its own: on a flat facade, one search in ten ended where a
// focal length tens of pixels off settles. The later ones take no more samples than this together.
constexpr std::uint64_t kStarts = 4;
constexpr int kLaterSamples = 3'000;

// Sigma of the focal length's logarithm beyond which there is none to speak of: a plane seen
// straight on may be near or far.
constexpr double kMostLogSigma = 0.5;

// The most that chance may do as well, as for a lens that is known.
constexpr double kMostLog10Chance = -3.0;

using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

// Normal equations of the pose's six unknowns and the logarithm of the focal length.
struct FocalNormals {
  double cost = 0.0;
  Matrix7d information = Matrix7d::Zero();
  Vector7d right = Vector7d::Zero();
};

FocalNormals NormalsAt(const PoseAndFocal& at, std::span<const LandmarkSight> sights,
                       std::span<const std::uint8_t> is_used, const Lens& lens,
                       const ResectionPriors& priors, double noise_px) {
  FocalNormals normals;
  const CameraPose pose(at.camera_from_enu);
  LinearSight linear;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (is_used[i] == 0) continue;
    if (!Linearise(sights[i], pose, lens, &linear)) {
      normals.cost = std::numeric_limits<double>::infinity();
      return normals;
    }
    const Eigen::Matrix2d weight =
        PixelCovariance(sights[i], linear.by_landmark, noise_px).inverse();
    Eigen::Matrix<double, 2, 7> design;
    design.leftCols<6>() = linear.by_pose;
    design.col(6) = lens.parameters().fx_px * linear.by_intrinsics.col(0) +
                    lens.parameters().fy_px * linear.by_intrinsics.col(1);
    const Eigen::Matrix<double, 2, 7> weighted = weight * design;
    normals.information.noalias() += design.transpose() * weighted;
    normals.right.noalias() += weighted.transpose() * linear.residual_px;
    normals.cost += 0.5 * linear.residual_px.dot(weight * linear.residual_px);
  }
  Matrix6d of_priors = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  normals.cost += PriorCost(priors, pose, &of_priors, &right);
  normals.information.topLeftCorner<6, 6>() += of_priors;
  normals.right.head<6>() += right;
  return normals;
}

// Levenberg-Marquardt steps. Gives the normal equations at the end, or nothing where the lens
// cannot be made.
std::optional<FocalNormals> Adjust(std::span<const LandmarkSight> sights,
                                   std::span<const std::uint8_t> is_used, const Lens& lens,
                                   const ResectionPriors& priors, double noise_px,
                                   PoseAndFocal* at) {
  std::optional<Lens> here = WithFocal(lens, at->focal_px);
  if (!here) return std::nullopt;
  FocalNormals normals = NormalsAt(*at, sights, is_used, *here, priors, noise_px);
  double damping = 1e-6;
  for (int step = 0; step < kMostSteps && damping < 1e8; ++step) {
    Matrix7d damped = normals.information;
    damped.diagonal() *= 1.0 + damping;
    const Vector7d change = damped.ldlt().solve(normals.right);
    if (!change.allFinite()) break;
    if (damping < 1e-3 && change.dot(normals.information * change) < 1e-12) break;
    const PoseAndFocal moved = {
        CameraPose(at->camera_from_enu).Moved(change.head<6>()).camera_from_enu(),
        at->focal_px * std::exp(std::clamp(change[6], -0.5, 0.5))};
    const std::optional<Lens> there = WithFocal(lens, moved.focal_px);
    if (!there) return std::nullopt;
    const FocalNormals next = NormalsAt(moved, sights, is_used, *there, priors, noise_px);
    if (next.cost < normals.cost) {
      *at = moved;
      normals = next;
      damping = std::max(0.1 * damping, 1e-10);
    } else {
      damping = std::max(10.0 * damping, 1e-5);
    }
  }
  return normals;
}

// Variance of the logarithm of the focal length; nothing if the sights do not hold it.
std::optional<double> FocalVariance(const Matrix7d& information) {
  const Matrix6d of_pose = information.topLeftCorner<6, 6>();
  const Vector6d with_focal = information.topRightCorner<6, 1>();
  const Eigen::LDLT<Matrix6d> factor(of_pose);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Vector6d taken = factor.solve(with_focal);
  const double left = information(6, 6) - with_focal.dot(taken);
  if (!(left > 1e-12 * information(6, 6))) return std::nullopt;
  return 1.0 / left;
}

// A pose found by sights and by chance is likelier where four are drawn than where three are: there
// are more samples, each with more answers, and one sight less to agree.
double ChanceOfFour(double log10_chance, std::size_t sights, const Lens& lens,
                    const ResectionOptions& options) {
  const double samples = (static_cast<double>(sights) - 3.0) / 4.0 * 10.0 / 4.0;
  const double gate_px2 = kPi * options.inlier_threshold_px * options.inlier_threshold_px;
  const double image_px2 = static_cast<double>(lens.parameters().width_px) *
                           static_cast<double>(lens.parameters().height_px);
  return log10_chance + std::log10(samples * std::max(image_px2 / gate_px2, 1.0));
}

// About the landmarks' mean, where their coordinates are small.
class FocalResection {
 public:
  FocalResection(std::span<const LandmarkSight> given, const Lens& lens,
                 const ResectionPriors& priors, const ResectionOptions& options)
      : lens_(lens), priors_(priors), options_(options), sights_(given.begin(), given.end()) {
    for (const LandmarkSight& sight : given) {
      origin_ += sight.landmark_in_enu_m / static_cast<double>(given.size());
    }
    for (LandmarkSight& sight : sights_) sight.landmark_in_enu_m -= origin_;
    if (priors_.position) priors_.position->position_in_enu_m -= origin_;
  }

  Result<ResectedCamera> Run() {
    if (sights_.size() < kFewestSights) return Refused(PoseVerdict::kTooFew);
    std::optional<PoseAndFocal> at = SearchPoseAndFocal(sights_, lens_, options_, &samples_);
    if (!at) return Refused(PoseVerdict::kNotHere);
    std::optional<Settled> settled = Settle(*at);
    ResectionOptions later = options_;
    later.most_samples = std::min(later.most_samples, kLaterSamples / static_cast<int>(kStarts));
    for (std::uint64_t start = 1; start < kStarts; ++start) {
      ++later.seed;
      int samples = 0;
      at = SearchPoseAndFocal(sights_, lens_, later, &samples);
      samples_ += samples;
      if (!at) continue;
      const std::optional<Settled> other = Settle(*at);
      if (other && (!settled || other->cost < settled->cost)) settled = other;
    }
    if (!settled) return Refused(PoseVerdict::kDegenerate);
    at = settled->at;
    const std::optional<double> variance = settled->variance;
    const std::optional<Lens> found = WithFocal(lens_, at->focal_px);
    if (!found) return Refused(PoseVerdict::kDegenerate);

    // An error of the focal length moves the pose as one of the lens does: the covariance of the
    // seven unknowns together, by the Schur complement of their normal matrix.
    const Eigen::Vector2d by_log(found->parameters().fx_px, found->parameters().fy_px);
    if (!options_.intrinsics_covariance) options_.intrinsics_covariance.emplace().setZero();
    options_.intrinsics_covariance->topRows<2>().setZero();
    options_.intrinsics_covariance->leftCols<2>().setZero();
    options_.intrinsics_covariance->topLeftCorner<2, 2>() = *variance * by_log * by_log.transpose();
    Result<ResectedPose> pose = Resect(sights_, *found, priors_, options_);
    if (!pose) return pose.error();
    pose->log10_chance = ChanceOfFour(pose->log10_chance, sights_.size(), lens_, options_);
    const bool has_pose = pose->verdict == PoseVerdict::kPose ||
                          pose->verdict == PoseVerdict::kWeak ||
                          pose->verdict == PoseVerdict::kAmbiguous;
    if (!has_pose) return Refused(pose->verdict);
    if (!(pose->log10_chance < kMostLog10Chance) ||
        pose->inliers < static_cast<int>(kFewestSights)) {
      return Refused(PoseVerdict::kNotHere);
    }
    ResectedCamera camera;
    camera.pose = std::move(*pose);
    camera.pose.samples = samples_;
    camera.pose.camera_from_enu = Uncentred(camera.pose.camera_from_enu);
    if (camera.pose.alternative) camera.pose.alternative = Uncentred(*camera.pose.alternative);
    camera.lens = found;
    camera.focal_px = at->focal_px;
    camera.focal_sigma_px = at->focal_px * std::sqrt(*variance);
    return camera;
  }

 private:
  struct Settled {
    PoseAndFocal at;
    double variance = 0.0;  // of the logarithm of the focal length
    double cost = 0.0;      // of all sights, those that disagree as much as may be
  };

  // The sights that agree with a pose at this focal length, then pose and focal length of these
  // sights, until it stays. Nothing if the sights do not hold the focal length.
  std::optional<Settled> Settle(PoseAndFocal at) const {
    std::optional<Settled> settled;
    for (int round = 0; round < kMostRounds; ++round) {
      const std::optional<Lens> here = WithFocal(lens_, at.focal_px);
      if (!here) return std::nullopt;
      const AdjustedPose adjusted = AdjustPose(at.camera_from_enu, sights_, *here, priors_,
                                               options_.inlier_threshold_px, std::nullopt);
      const double before_px = at.focal_px;
      at.camera_from_enu = adjusted.pose.camera_from_enu();
      // What few sights leave open of the noise, as the pose's covariance counts it.
      const std::optional<FocalNormals> normals =
          Adjust(sights_, adjusted.is_inlier, lens_, priors_, adjusted.covariance_noise_px, &at);
      const std::optional<double> variance =
          normals ? FocalVariance(normals->information) : std::nullopt;
      if (!variance) return std::nullopt;
      settled = Settled{at, *variance, TruncatedCost(at)};
      if (std::abs(at.focal_px / before_px - 1.0) < kSteady) break;
    }
    if (settled && !(settled->variance < kMostLogSigma * kMostLogSigma)) return std::nullopt;
    return settled;
  }

  double TruncatedCost(const PoseAndFocal& at) const {
    const std::optional<Lens> lens = WithFocal(lens_, at.focal_px);
    const double limit = options_.inlier_threshold_px * options_.inlier_threshold_px;
    double cost = 0.0;
    for (const LandmarkSight& sight : sights_) {
      const Eigen::Vector3d there = at.camera_from_enu * sight.landmark_in_enu_m;
      const std::optional<Eigen::Vector2d> pixel = lens ? lens->Project(there) : std::nullopt;
      const double square = pixel ? (sight.pixel - *pixel).squaredNorm() /
                                        (sight.pixel_sigma_px * sight.pixel_sigma_px)
                                  : limit;
      cost += std::min(square, limit);
    }
    return cost;
  }

  ResectedCamera Refused(PoseVerdict verdict) const {
    ResectedCamera camera;
    camera.pose.verdict = verdict;
    camera.pose.samples = samples_;
    camera.pose.is_inlier.assign(sights_.size(), 0);
    camera.pose.residuals_px.assign(
        sights_.size(), Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    return camera;
  }

  Rigid3 Uncentred(const Rigid3& pose) const {
    const Eigen::Vector3d shift = pose.rotation() * origin_;
    return {pose.rotation(), pose.translation() - shift};
  }

  const Lens& lens_;
  ResectionPriors priors_;
  ResectionOptions options_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<LandmarkSight> sights_;
  int samples_ = 0;
};

}  // namespace

Result<ResectedCamera> ResectWithFocal(std::span<const LandmarkSight> sights, const Lens& lens,
                                       const ResectionPriors& priors,
                                       const ResectionOptions& options) {
  if (Status status = CheckResectionInput(sights, priors, options); !status) return status.error();
  return FocalResection(sights, lens, priors, options).Run();
}

}  // namespace lodemark
