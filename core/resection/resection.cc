#include "core/resection/resection.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/resection/consensus.h"
#include "core/resection/mode_comparison.h"
#include "core/resection/pose_adjustment.h"
#include "core/resection/pose_verdict.h"
#include "core/resection/resection_input.h"
#include "core/resection/sight_table.h"

namespace lodemark {
namespace {

// Decimal logarithm of how often chance may do as well as a pose that is believed. Where most
// sights disagree with it, those that agree may be mistaken alike, as on a facade that repeats
// itself: a photograph of another place reached -3.5 with one sight in nine.
constexpr double kMostLog10Chance = -3.0;
constexpr double kMostLog10ChanceOfFew = -4.0;
constexpr double kFew = 0.25;  // of the sights

// Spread of the landmarks across their longest axis, relative to that, below which they are on one
// line.
constexpr double kOneLine = 1e-6;

// Sigma of the centre relative to the distance of the landmarks, and of the rotation in radians:
// beyond the first the geometry is weak, beyond the second there is none to speak of.
constexpr double kWeak = 0.03;
constexpr double kUndetermined = 0.5;

// Inliers within so small a part of the image (root mean square from their middle, relative to the
// image's diagonal) hold a pose badly, whatever their number makes of it.
constexpr double kCorner = 0.02;

std::size_t FewestSights(const ResectionPriors& priors) { return priors.gravity ? 3 : 4; }

double MedianDistance(const AdjustedPose& adjusted, std::span<const LandmarkSight> sights) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (adjusted.is_inlier[i] == 0) continue;
    distances.push_back((sights[i].landmark_in_enu_m - adjusted.pose.centre_in_enu_m).norm());
  }
  if (distances.empty()) return 0.0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

// Largest standard deviation along any direction.
double LargestSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(eigen.eigenvalues()[2], 0.0));
}

// Larger of the sigmas that kWeak and kUndetermined are about.
double Looseness(const AdjustedPose& adjusted, std::span<const LandmarkSight> sights) {
  if (!adjusted.covariance.is_determined) return std::numeric_limits<double>::infinity();
  const Matrix6d& covariance = adjusted.covariance.covariance;
  const double distance_m = MedianDistance(adjusted, sights);
  return std::max(LargestSigma(covariance.topLeftCorner<3, 3>()) / distance_m,
                  LargestSigma(covariance.bottomRightCorner<3, 3>()));
}

bool AreInOneCorner(const AdjustedPose& adjusted, std::span<const LandmarkSight> sights,
                    const Lens& lens) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double mean_square = 0.0;
  const double share = 1.0 / std::max(adjusted.inliers, 1);
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (adjusted.is_inlier[i] != 0) mean += share * sights[i].pixel;
  }
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (adjusted.is_inlier[i] != 0) mean_square += share * (sights[i].pixel - mean).squaredNorm();
  }
  return std::sqrt(mean_square) <
         kCorner * std::hypot(lens.parameters().width_px, lens.parameters().height_px);
}

// The same sights in the order and about the origin that everything is worked out in.
struct CentredInput {
  CentredInput(std::span<const LandmarkSight> given, const ResectionPriors& given_priors,
               std::uint64_t seed)
      : order(ShuffledOrder(given, seed)), priors(given_priors) {
    sights.reserve(given.size());
    for (const std::size_t i : order) {
      sights.push_back(given[i]);
      origin += given[i].landmark_in_enu_m / static_cast<double>(given.size());
    }
    for (LandmarkSight& sight : sights) sight.landmark_in_enu_m -= origin;
    if (priors.position) priors.position->position_in_enu_m -= origin;
  }

  Rigid3 CameraFromEnu(const CameraPose& pose) const {
    CameraPose moved = pose;
    moved.centre_in_enu_m += origin;
    return moved.camera_from_enu();
  }

  std::vector<std::size_t> order;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<LandmarkSight> sights;
  ResectionPriors priors;
};

// What a mode came to, and the decimal logarithm of its chance.
struct Mode {
  AdjustedPose adjusted;
  double log10_chance = 0.0;
};

class Resection {
 public:
  Resection(const CentredInput& input, const Lens& lens, const ResectionOptions& options)
      : input_(input), lens_(lens), options_(options) {}

  ResectedPose Run() {
    const std::size_t count = input_.sights.size();
    result_.is_inlier.assign(count, 0);
    result_.residuals_px.assign(
        count, Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    const SightTable table(input_.sights, lens_, options_.inlier_threshold_px);
    if (table.size() < FewestSights(input_.priors)) return std::move(result_);
    if (!LandmarksAreSpread()) {
      result_.verdict = PoseVerdict::kDegenerate;
      return std::move(result_);
    }
    ConsensusOptions search;
    search.threshold = options_.inlier_threshold_px;
    search.seed = options_.seed;
    search.most_samples = options_.most_samples;
    search.wanted_confidence = options_.wanted_confidence;
    const Consensus consensus = FindConsensus(table, input_.priors, search);
    result_.samples = consensus.samples;
    sights_per_sample_ = consensus.sights_per_sample;
    if (!consensus.best) {
      result_.verdict = PoseVerdict::kNotHere;
      return std::move(result_);
    }
    Judge(consensus);
    return std::move(result_);
  }

 private:
  // Not all on one line, or, where gravity helps, not all in one place.
  bool LandmarksAreSpread() const {
    const LandmarkSpread spread = SpreadOf(input_.sights, {});
    if (!(spread.sigma_m[0] > 0.0)) return false;
    return input_.priors.gravity || spread.sigma_m[1] > kOneLine * spread.sigma_m[0];
  }

  Mode ModeFrom(const Rigid3& start) const {
    Mode mode;
    mode.adjusted = AdjustPose(start, input_.sights, lens_, input_.priors,
                               options_.inlier_threshold_px, options_.intrinsics_covariance);
    // Few sights have a wide gate, lest a good one be lost; what chance does is judged by the plain
    // one.
    const double noise_px = mode.adjusted.gate_noise_px;
    std::vector<std::uint8_t> agrees;
    for (const double square :
         SquaresInSigmas(mode.adjusted.pose, input_.sights, lens_, noise_px)) {
      agrees.push_back(square < kSquaredGate ? 1 : 0);
    }
    mode.log10_chance = Log10Chance(mode.adjusted.pose, input_.sights, agrees, lens_,
                                    noise_px * std::sqrt(kSquaredGate), sights_per_sample_);
    return mode;
  }

  bool IsBelievable(const Mode& mode) const {
    const bool are_few = mode.adjusted.inliers < kFew * static_cast<double>(input_.sights.size());
    return mode.log10_chance < (are_few ? kMostLog10ChanceOfFew : kMostLog10Chance) &&
           mode.adjusted.inliers >= static_cast<int>(FewestSights(input_.priors));
  }

  void Judge(const Consensus& consensus) {
    Mode best = ModeFrom(consensus.best->camera_from_world);
    std::optional<Mode> other;
    if (consensus.rival) Consider(ModeFrom(consensus.rival->camera_from_world), &best, &other);
    if (const std::optional<CameraPose> reversed =
            ReversedMode(best.adjusted, input_.sights, lens_, input_.priors)) {
      Consider(ModeFrom(reversed->camera_from_enu()), &best, &other);
    }
    result_.log10_chance = best.log10_chance;
    result_.noise_px = best.adjusted.noise_px;
    result_.inliers = best.adjusted.inliers;
    if (!IsBelievable(best)) {
      result_.verdict = PoseVerdict::kNotHere;
      return;
    }
    const double looseness = Looseness(best.adjusted, input_.sights);
    if (!(looseness < kUndetermined)) {
      result_.verdict = PoseVerdict::kDegenerate;
      return;
    }
    const bool is_weak = looseness > kWeak || AreInOneCorner(best.adjusted, input_.sights, lens_);
    result_.verdict = is_weak ? PoseVerdict::kWeak : PoseVerdict::kPose;
    if (other) {
      result_.verdict = PoseVerdict::kAmbiguous;
      result_.alternative = input_.CameraFromEnu(other->adjusted.pose);
    }
    Report(std::move(best.adjusted));
  }

  // Keeps the likelier one as best, the other where it is nearly as likely.
  void Consider(Mode mode, Mode* best, std::optional<Mode>* other) const {
    if (!IsBelievable(mode) || !AreApart(best->adjusted, mode.adjusted)) return;
    ModePreference preference =
        Compare(best->adjusted, mode.adjusted, input_.sights, lens_, input_.priors);
    if (preference.second_is_likelier) std::swap(*best, mode);
    if (preference.is_open) *other = std::move(mode);
  }

  void Report(AdjustedPose adjusted) {
    result_.camera_from_enu = input_.CameraFromEnu(adjusted.pose);
    result_.covariance = adjusted.covariance.covariance;
    result_.covariance_given_lens = adjusted.covariance.given_lens;
    result_.shared_sigma_m = adjusted.shared_sigma_m;
    for (std::size_t k = 0; k < input_.order.size(); ++k) {
      result_.is_inlier[input_.order[k]] = adjusted.is_inlier[k];
      result_.residuals_px[input_.order[k]] = adjusted.residuals_px[k];
    }
  }

  const CentredInput& input_;
  const Lens& lens_;
  const ResectionOptions& options_;
  int sights_per_sample_ = 3;
  ResectedPose result_;
};

}  // namespace

std::string_view NameOf(PoseVerdict verdict) {
  switch (verdict) {
    case PoseVerdict::kPose:
      return "pose";
    case PoseVerdict::kWeak:
      return "weak";
    case PoseVerdict::kAmbiguous:
      return "ambiguous";
    case PoseVerdict::kTooFew:
      return "too few";
    case PoseVerdict::kDegenerate:
      return "degenerate";
    case PoseVerdict::kNotHere:
      return "not here";
  }
  return "unknown";
}

Result<ResectedPose> Resect(std::span<const LandmarkSight> sights, const Lens& lens,
                            const ResectionPriors& priors, const ResectionOptions& options) {
  if (Status status = CheckResectionInput(sights, priors, options); !status) {
    return status.error();
  }
  const CentredInput input(sights, priors, options.seed);
  return Resection(input, lens, options).Run();
}

}  // namespace lodemark
