#include "core/vision/unique_matches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>

namespace lodemark {
namespace {

// Distances that descriptors of different things hardly ever fall below: 0.7 of the norm of 512
// (a right angle is 1.4), and 64 of 256 bits.
constexpr std::uint32_t kStrangersRootSift = 128'450;
constexpr std::uint32_t kStrangersOrb = 64;

// How well a feature is placed. Of 9,400 SIFT features of photographs with surveyed poses the sigma
// grew with their size as here, and in proportion to the distance of their descriptors from those
// of the landmarks: what looks different was seen from elsewhere, and is found elsewhere.
double PixelSigma(DescriptorKind kind, float size_px, std::uint32_t distance) {
  if (kind == DescriptorKind::kOrb) return std::hypot(0.2, 0.02 * size_px);
  const double unlikeness = std::max(40.0, std::sqrt(static_cast<double>(distance)));
  return std::hypot(0.2, 0.04 * size_px) * unlikeness / 60.0;
}

double RatioOf(DescriptorKind kind, std::uint32_t distance, std::uint32_t second) {
  if (second == 0) return 1.0;
  const double ratio = static_cast<double>(distance) / second;
  return kind == DescriptorKind::kOrb ? ratio : std::sqrt(ratio);
}

}  // namespace

Status CheckFeatures(const FeatureMap& map, const Features& features) {
  const DescriptorKind kind = map.info().descriptor_kind;
  if (features.kind != kind) {
    return Error{ErrorCode::kInvalidArgument,
                 std::string("features: of another kind than the map's, which holds ") +
                     (kind == DescriptorKind::kOrb ? "ORB" : "RootSIFT")};
  }
  if (features.descriptors.size() != features.keypoints.size() * DescriptorBytes(kind)) {
    return Error{ErrorCode::kInvalidArgument,
                 "features: " + std::to_string(features.keypoints.size()) + " keypoints have " +
                     std::to_string(features.descriptors.size()) + " bytes of descriptors"};
  }
  return {};
}

std::optional<double> AcceptedRatio(DescriptorKind kind, const NearestLandmarks& nearest,
                                    double largest_ratio) {
  if (nearest.landmark_id == NearestLandmarks::kNone) return std::nullopt;
  const std::uint32_t strangers = kind == DescriptorKind::kOrb ? kStrangersOrb : kStrangersRootSift;
  if (nearest.distance >= strangers) return std::nullopt;
  const bool is_alone = nearest.second_landmark_id == NearestLandmarks::kNone;
  const double ratio =
      RatioOf(kind, nearest.distance, is_alone ? strangers : nearest.second_distance);
  if (!(ratio <= largest_ratio)) return std::nullopt;
  return ratio;
}

Result<std::vector<LandmarkMatch>> UniqueMatches(const FeatureMap& map, const Features& features,
                                                 std::vector<MatchCandidate> candidates) {
  // For each landmark the nearest feature; among equals the surer, then the first.
  std::sort(candidates.begin(), candidates.end(),
            [](const MatchCandidate& a, const MatchCandidate& b) {
              return std::tie(a.landmark_id, a.distance, a.ratio, a.feature) <
                     std::tie(b.landmark_id, b.distance, b.ratio, b.feature);
            });
  const auto end = std::unique(candidates.begin(), candidates.end(),
                               [](const MatchCandidate& a, const MatchCandidate& b) {
                                 return a.landmark_id == b.landmark_id;
                               });
  candidates.erase(end, candidates.end());

  std::vector<std::uint32_t> ids;
  ids.reserve(candidates.size());
  for (const MatchCandidate& candidate : candidates) ids.push_back(candidate.landmark_id);
  const Result<std::vector<Landmark>> landmarks = map.LandmarksById(ids);
  if (!landmarks) return landmarks.error();

  std::vector<LandmarkMatch> matches;
  matches.reserve(candidates.size());
  auto landmark = landmarks->begin();
  for (const MatchCandidate& candidate : candidates) {
    while (landmark != landmarks->end() && landmark->id < candidate.landmark_id) ++landmark;
    if (landmark == landmarks->end()) break;
    if (landmark->id != candidate.landmark_id) continue;
    const Keypoint& keypoint = features.keypoints[candidate.feature];
    LandmarkMatch match;
    match.feature = candidate.feature;
    match.pixel = {keypoint.x_px, keypoint.y_px};
    match.pixel_sigma_px = PixelSigma(features.kind, keypoint.size_px, candidate.distance);
    match.landmark = *landmark;
    match.ratio = candidate.ratio;
    matches.push_back(match);
  }
  std::sort(matches.begin(), matches.end(), [](const LandmarkMatch& a, const LandmarkMatch& b) {
    return std::tie(a.ratio, a.feature) < std::tie(b.ratio, b.feature);
  });
  return matches;
}

}  // namespace lodemark
