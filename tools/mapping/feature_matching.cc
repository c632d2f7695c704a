#include "tools/mapping/feature_matching.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "core/map/descriptor.h"

namespace lodemark {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Distances that descriptors of different things hardly ever fall below, as in the look-up.
constexpr std::uint32_t kStrangersRootSift = 128'450;
constexpr std::uint32_t kStrangersOrb = 64;

// SIFT describes a place once for each strong direction: a rival this near is the same thing.
constexpr float kSameThing_px = 2.0F;

// Nearer together they are one place: nothing of depth can be seen.
constexpr double kLeastBaseline = 1e-9;  // in the world's unit

double RatioOf(DescriptorKind kind, std::uint32_t distance, std::uint32_t second) {
  if (second == 0) return 1.0;
  const double ratio = static_cast<double>(distance) / second;
  return kind == DescriptorKind::kOrb ? ratio : std::sqrt(ratio);
}

struct Nearest {
  std::uint32_t feature = kNone;
  double ratio = 1.0;
};

// Finds for features of one image their nearest along the epipolar curves in the other.
class EpipolarSearch {
 public:
  EpipolarSearch(const MatchableImage& from, const MatchableImage& to,
                 const MatchingOptions& options)
      : from_(from),
        to_(to),
        options_(options),
        kind_(from.image().features.kind),
        bytes_(DescriptorBytes(kind_)),
        baseline_((to.centre() - from.centre()).cast<float>()),
        band_(static_cast<float>(options.epipolar_px / from.pixels_per_radian() +
                                 options.epipolar_px / to.pixels_per_radian())) {}

  Nearest Find(std::uint32_t feature) {
    const Eigen::Vector3f ray = from_.rays().col(static_cast<Eigen::Index>(feature));
    const Eigen::Vector3f normal = baseline_.cross(ray);
    const float length = normal.norm();
    // Along the baseline every feature would do.
    if (!(length > 1e-4F * baseline_.norm())) return {};
    GatherCandidates(normal / length, ray);
    if (candidates_.empty()) return {};
    distances_.resize(candidates_.size());
    DistancesTo(kind_, from_.image().features.descriptors.data() + feature * bytes_,
                described_.data(), candidates_.size(), distances_.data());
    return Judge();
  }

 private:
  // Features within the band of the epipolar plane, on the side the ray points to.
  void GatherCandidates(const Eigen::Vector3f& normal, const Eigen::Vector3f& ray) {
    off_plane_.noalias() = normal.transpose() * to_.rays();
    candidates_.clear();
    described_.clear();
    const std::uint8_t* const descriptors = to_.image().features.descriptors.data();
    // In the plane, both rays are on one side of the baseline, and the other one turns back further
    // from it: they meet in front of both.
    const Eigen::Vector3f across = normal.cross(baseline_);
    const float least_turn = ray.dot(baseline_) + band_ * baseline_.norm();
    for (Eigen::Index i = 0; i < off_plane_.size(); ++i) {
      if (!(std::abs(off_plane_(i)) < band_)) continue;
      const Eigen::Vector3f other = to_.rays().col(i);
      if (!(other.dot(across) > 0.0F) || !(other.dot(baseline_) < least_turn)) continue;
      candidates_.push_back(static_cast<std::uint32_t>(i));
      const std::uint8_t* const from = descriptors + static_cast<std::size_t>(i) * bytes_;
      described_.insert(described_.end(), from, from + bytes_);
    }
  }

  Nearest Judge() const {
    const std::uint32_t strangers =
        kind_ == DescriptorKind::kOrb ? kStrangersOrb : kStrangersRootSift;
    const auto best = std::min_element(distances_.begin(), distances_.end());
    if (*best >= strangers) return {};
    const std::uint32_t feature = candidates_[static_cast<std::size_t>(best - distances_.begin())];
    const std::vector<Keypoint>& keypoints = to_.image().features.keypoints;
    std::uint32_t second = strangers;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (distances_[i] >= second || candidates_[i] == feature) continue;
      const float dx = keypoints[candidates_[i]].x_px - keypoints[feature].x_px;
      const float dy = keypoints[candidates_[i]].y_px - keypoints[feature].y_px;
      if (dx * dx + dy * dy > kSameThing_px * kSameThing_px) second = distances_[i];
    }
    const double ratio = RatioOf(kind_, *best, second);
    return ratio <= options_.largest_ratio ? Nearest{feature, ratio} : Nearest{};
  }

  const MatchableImage& from_;
  const MatchableImage& to_;
  const MatchingOptions& options_;
  DescriptorKind kind_;
  std::size_t bytes_;
  Eigen::Vector3f baseline_;
  float band_;  // sine of the angle a ray may leave the epipolar plane by
  Eigen::RowVectorXf off_plane_;
  std::vector<std::uint32_t> candidates_;
  std::vector<std::uint8_t> described_;  // their descriptors
  std::vector<std::uint32_t> distances_;
};

}  // namespace

MatchableImage::MatchableImage(const ReconstructedImage& image)
    : image_(&image), centre_(image.camera_from_world.Inverse().translation()) {
  const std::vector<Keypoint>& keypoints = image.features.keypoints;
  rays_.resize(3, static_cast<Eigen::Index>(keypoints.size()));
  const Eigen::Matrix3d world_from_camera =
      image.camera_from_world.rotation().conjugate().toRotationMatrix();
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const std::optional<Eigen::Vector3d> bearing =
        image.lens.Unproject({keypoints[i].x_px, keypoints[i].y_px});
    rays_.col(static_cast<Eigen::Index>(i)) =
        bearing ? Eigen::Vector3f((world_from_camera * *bearing).cast<float>())
                : Eigen::Vector3f::Zero();
  }
  const LensParameters& lens = image.lens.parameters();
  pixels_per_radian_ = std::sqrt(lens.fx_px * lens.fy_px);
}

std::vector<FeatureMatch> MatchFeatures(const MatchableImage& first, const MatchableImage& second,
                                        const MatchingOptions& options) {
  std::vector<FeatureMatch> matches;
  if (!((first.centre() - second.centre()).norm() > kLeastBaseline)) return matches;
  EpipolarSearch there(first, second, options);
  EpipolarSearch back(second, first, options);
  const std::size_t count = first.image().features.keypoints.size();
  std::vector<std::uint32_t> back_of(second.image().features.keypoints.size(), kNone);
  std::vector<std::uint8_t> is_asked(back_of.size(), 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Nearest nearest = there.Find(i);
    if (nearest.feature == kNone) continue;
    if (is_asked[nearest.feature] == 0) {
      is_asked[nearest.feature] = 1;
      back_of[nearest.feature] = back.Find(nearest.feature).feature;
    }
    if (back_of[nearest.feature] == i) matches.push_back({i, nearest.feature, nearest.ratio});
  }
  return matches;
}

}  // namespace lodemark
