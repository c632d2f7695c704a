#include "core/resection/focal_search.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/random.h"
#include "core/resection/minimal_solvers.h"
#include "core/resection/sight_table.h"

namespace lodemark {
namespace {

constexpr std::size_t kDrawn = 4;

// A sample takes ten times as long as one of three sights.
constexpr int kMostSamples = 20'000;

// Of samples without a mistaken sight, the share near enough to the truth for the others to agree.
constexpr double kFortunate = 0.5;

// Focal lengths that cameras have, relative to the longer side.
constexpr double kShortest = 0.1;
constexpr double kLongest = 50.0;

// Relative to the stated focal length, at which a lens that bends is straightened at first. What
// is straightened at a focal length a fifth off still agrees near the middle of the image.
constexpr std::array<double, 5> kStarts = {1.0, 0.7, 1.4, 0.5, 2.0};
constexpr int kFirstLook = 800;  // samples
constexpr int kMostRounds = 4;
constexpr double kSteady = 0.005;  // relative change of the focal length

// Sights further than this from the optical axis are not sampled: a plane does not hold them.
constexpr double kLeastCosine = 0.1;

struct Found {
  PoseAndFocal at;
  double cost = 0.0;    // sum of truncated squares
  double wanted = 0.0;  // samples after which more agreeing sights would have been found
};

bool IsStraight(const LensParameters& parameters) {
  return (parameters.model == LensModel::kPinhole || parameters.model == LensModel::kBrown) &&
         std::all_of(parameters.coefficients.begin(), parameters.coefficients.end(),
                     [](double coefficient) { return coefficient == 0.0; });
}

// The samples of one round, from sights straightened at one focal length.
class FocalSamples {
 public:
  FocalSamples(std::span<const LandmarkSight> sights, std::span<const std::size_t> order,
               const Lens& lens, const ResectionOptions& options)
      : options_(options), random_(options.seed) {
    const LensParameters& parameters = lens.parameters();
    const double longer_px = std::max(parameters.width_px, parameters.height_px);
    shortest_px_ = kShortest * longer_px;
    longest_px_ = kLongest * longer_px;
    limit_ = options.inlier_threshold_px * options.inlier_threshold_px;
    for (const std::size_t i : order) {
      const LandmarkSight& sight = sights[i];
      const std::optional<Eigen::Vector3d> bearing = lens.Unproject(sight.pixel);
      if (!bearing || bearing->z() < kLeastCosine) {
        lost_ += limit_;
        continue;
      }
      rows_.push_back({parameters.fx_px * bearing->hnormalized(), sight.landmark_in_enu_m,
                       1.0 / (sight.pixel_sigma_px * sight.pixel_sigma_px),
                       sight.landmark_covariance_m2.trace() / 3.0});
    }
  }

  std::optional<Found> Run(double most_samples, int* samples) {
    if (rows_.size() <= kDrawn) return std::nullopt;
    double wanted = most_samples;
    double least = limit_ * static_cast<double>(rows_.size() - kDrawn);
    std::optional<Found> best;
    for (int tried = 0; tried < wanted; ++tried) {
      ++*samples;
      std::array<Eigen::Vector2d, kDrawn> pixels;
      std::array<Eigen::Vector3d, kDrawn> landmarks;
      Draw(&pixels, &landmarks);
      const FocalPoseSet set = PoseAndFocalFromFourPoints(pixels, landmarks);
      for (int k = 0; k < set.count; ++k) {
        const FocalPose& pose = set.poses[static_cast<std::size_t>(k)];
        if (!(pose.focal_px > shortest_px_ && pose.focal_px < longest_px_)) continue;
        std::size_t agreeing = 0;
        const double cost = Cost(pose, least, &agreeing);
        if (!(cost < least)) continue;
        least = cost;
        const double share = static_cast<double>(agreeing) / static_cast<double>(rows_.size());
        const double success = kFortunate * std::pow(share, kDrawn);
        const double missing = std::log(std::max(1.0 - options_.wanted_confidence, 1e-12));
        wanted = std::min(wanted, std::ceil(missing / std::log1p(-success)));
        best = Found{{pose.camera_from_world, pose.focal_px}, cost + lost_, wanted};
      }
    }
    return best;
  }

 private:
  struct Row {
    Eigen::Vector2d centred_px;  // straightened, at one focal length along both axes
    Eigen::Vector3d landmark;
    double weight = 1.0;
    double spread_m2 = 0.0;
  };

  void Draw(std::array<Eigen::Vector2d, kDrawn>* pixels,
            std::array<Eigen::Vector3d, kDrawn>* landmarks) {
    std::array<std::size_t, kDrawn> drawn = {};
    for (std::size_t k = 0; k < kDrawn; ++k) {
      const auto end = drawn.begin() + static_cast<std::ptrdiff_t>(k);
      do {
        drawn[k] = random_.Index(rows_.size());
      } while (std::find(drawn.begin(), end, drawn[k]) != end);
      (*pixels)[k] = rows_[drawn[k]].centred_px;
      (*landmarks)[k] = rows_[drawn[k]].landmark;
    }
  }

  // Sum of truncated squares; given up on where it reaches most.
  double Cost(const FocalPose& pose, double most, std::size_t* agreeing) const {
    const Eigen::Matrix3d rotation = pose.camera_from_world.rotation().toRotationMatrix();
    const Eigen::Vector3d& translation = pose.camera_from_world.translation();
    double cost = 0.0;
    for (const Row& row : rows_) {
      const Eigen::Vector3d there = rotation * row.landmark + translation;
      double square = limit_;
      if (there.z() > 0.0) {
        const double scale = pose.focal_px / there.z();
        square = (row.centred_px - scale * there.head<2>()).squaredNorm() /
                 (1.0 / row.weight + scale * scale * row.spread_m2);
      }
      if (square < limit_) ++*agreeing;
      cost += std::min(square, limit_);
      if (cost >= most) break;
    }
    return cost;
  }

  const ResectionOptions& options_;
  Random random_;
  std::vector<Row> rows_;
  double shortest_px_ = 0.0;
  double longest_px_ = 0.0;
  double limit_ = 0.0;
  double lost_ = 0.0;  // cost of the sights that are not sampled
};

}  // namespace

std::optional<Lens> WithFocal(const Lens& lens, double focal_px) {
  LensParameters parameters = lens.parameters();
  parameters.fy_px *= focal_px / parameters.fx_px;
  parameters.fx_px = focal_px;
  Result<Lens> made = Lens::Create(parameters);
  if (!made) return std::nullopt;
  return *made;
}

std::optional<PoseAndFocal> SearchPoseAndFocal(std::span<const LandmarkSight> sights,
                                               const Lens& lens, const ResectionOptions& options,
                                               int* samples) {
  *samples = 0;
  const std::vector<std::size_t> order = ShuffledOrder(sights, options.seed);
  const bool is_straight = IsStraight(lens.parameters());
  const int most = std::min(options.most_samples, kMostSamples);
  std::optional<Found> best;
  const auto look_at = [&](double focal_px, double most_samples) {
    const std::optional<Lens> here = WithFocal(lens, focal_px);
    if (!here) return;
    const double wanted = best ? std::min(best->wanted, most_samples) : most_samples;
    const std::optional<Found> found =
        FocalSamples(sights, order, *here, options).Run(wanted, samples);
    if (found && (!best || found->cost < best->cost)) best = found;
  };
  const double stated_px = lens.parameters().fx_px;
  if (is_straight) {
    look_at(stated_px, most);
  } else {
    for (const double start : kStarts) look_at(start * stated_px, std::min(most, kFirstLook));
    double straightened_at_px = 0.0;
    for (int round = 0; best && round < kMostRounds; ++round) {
      const double change_px = std::abs(best->at.focal_px - straightened_at_px);
      if (change_px < kSteady * straightened_at_px) break;
      straightened_at_px = best->at.focal_px;
      look_at(straightened_at_px, most / kMostRounds);
    }
  }
  if (!best) return std::nullopt;
  return best->at;
}

}  // namespace lodemark
