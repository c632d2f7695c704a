#include "tools/mapping/track_building.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <tuple>

namespace lodemark {
namespace {

constexpr std::size_t kCompareAllUpTo = 40;
constexpr std::size_t kPartners = 24;
constexpr double kLeastAxisCosine = 0.25;  // 75 degrees between the optical axes

auto Key(const ImageFeature& one) { return std::tie(one.image, one.feature); }

// Sets of features that grow together; each knows its images.
class Groups {
 public:
  explicit Groups(std::vector<ImageFeature> members) : members_(std::move(members)) {
    parent_.resize(members_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    images_.resize(members_.size());
    for (std::size_t i = 0; i < members_.size(); ++i) images_[i] = {members_[i].image};
  }

  std::size_t IndexOf(const ImageFeature& one) const {
    const auto at = std::lower_bound(
        members_.begin(), members_.end(), one,
        [](const ImageFeature& a, const ImageFeature& b) { return Key(a) < Key(b); });
    return static_cast<std::size_t>(at - members_.begin());
  }

  std::size_t RootOf(std::size_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  // Leaves both as they are if they have an image in common.
  void Join(std::size_t a, std::size_t b) {
    a = RootOf(a);
    b = RootOf(b);
    if (a == b) return;
    if (images_[a].size() < images_[b].size()) std::swap(a, b);
    std::vector<std::uint32_t> both;
    both.reserve(images_[a].size() + images_[b].size());
    std::merge(images_[a].begin(), images_[a].end(), images_[b].begin(), images_[b].end(),
               std::back_inserter(both));
    if (std::adjacent_find(both.begin(), both.end()) != both.end()) return;
    images_[a] = std::move(both);
    images_[b].clear();
    parent_[b] = a;
  }

  std::vector<FeatureTrack> Tracks() {
    std::vector<FeatureTrack> by_root(members_.size());
    for (std::size_t i = 0; i < members_.size(); ++i) by_root[RootOf(i)].push_back(members_[i]);
    std::erase_if(by_root, [](const FeatureTrack& track) { return track.size() < 2; });
    std::sort(by_root.begin(), by_root.end(), [](const FeatureTrack& a, const FeatureTrack& b) {
      return Key(a.front()) < Key(b.front());
    });
    return by_root;
  }

 private:
  std::vector<ImageFeature> members_;  // ascending
  std::vector<std::size_t> parent_;
  std::vector<std::vector<std::uint32_t>> images_;  // of the group, at its root, ascending
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> PairsToMatch(
    const std::vector<ReconstructedImage>& images) {
  const auto count = static_cast<std::uint32_t>(images.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::vector<Eigen::Vector3d> centres;
  std::vector<Eigen::Vector3d> axes;
  for (const ReconstructedImage& image : images) {
    const Rigid3 world_from_camera = image.camera_from_world.Inverse();
    centres.push_back(world_from_camera.translation());
    axes.push_back(world_from_camera.rotation() * Eigen::Vector3d::UnitZ());
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    std::vector<std::pair<double, std::uint32_t>> partners;
    for (std::uint32_t j = 0; j < count; ++j) {
      if (i == j) continue;
      if (count > kCompareAllUpTo && axes[i].dot(axes[j]) < kLeastAxisCosine) continue;
      partners.emplace_back((centres[i] - centres[j]).squaredNorm(), j);
    }
    if (count > kCompareAllUpTo) {
      std::sort(partners.begin(), partners.end());
      partners.resize(std::min(partners.size(), kPartners));
    }
    for (const auto& [distance, j] : partners) pairs.emplace(std::min(i, j), std::max(i, j));
  }
  return {pairs.begin(), pairs.end()};
}

std::vector<FeatureTrack> JoinTracks(std::vector<TrackLink> links) {
  std::vector<ImageFeature> members;
  for (TrackLink& link : links) {
    if (Key(link.b) < Key(link.a)) std::swap(link.a, link.b);
    members.push_back(link.a);
    members.push_back(link.b);
  }
  std::sort(links.begin(), links.end(), [](const TrackLink& x, const TrackLink& y) {
    return std::tie(x.ratio, x.a.image, x.a.feature, x.b.image, x.b.feature) <
           std::tie(y.ratio, y.a.image, y.a.feature, y.b.image, y.b.feature);
  });
  std::sort(members.begin(), members.end(),
            [](const ImageFeature& a, const ImageFeature& b) { return Key(a) < Key(b); });
  members.erase(std::unique(members.begin(), members.end()), members.end());
  Groups groups(std::move(members));
  for (const TrackLink& link : links) {
    if (link.a.image == link.b.image) continue;
    groups.Join(groups.IndexOf(link.a), groups.IndexOf(link.b));
  }
  return groups.Tracks();
}

std::vector<FeatureTrack> BuildTracks(const std::vector<ReconstructedImage>& images,
                                      const MatchingOptions& options, const Progress& progress) {
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs = PairsToMatch(images);
  const std::vector<MatchableImage> matchable(images.begin(), images.end());
  std::vector<TrackLink> links;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    progress(static_cast<double>(p) / static_cast<double>(pairs.size()));
    const auto [i, j] = pairs[p];
    for (const FeatureMatch& match : MatchFeatures(matchable[i], matchable[j], options)) {
      links.push_back({{i, match.first}, {j, match.second}, match.ratio});
    }
  }
  progress(1.0);
  return JoinTracks(std::move(links));
}

}  // namespace lodemark
