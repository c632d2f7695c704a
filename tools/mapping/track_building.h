// Tracks of features through photographs: which of them to compare, and how matches join.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tools/mapping/feature_matching.h"
#include "tools/mapping/reconstruction.h"

namespace lodemark {

// Pairs of images worth comparing: all if there are few, else for each image those taken nearest to
// it of the ones that look the same way.
std::vector<std::pair<std::uint32_t, std::uint32_t>> PairsToMatch(
    const std::vector<ReconstructedImage>& images);

// A match between features of two images.
struct TrackLink {
  ImageFeature a;
  ImageFeature b;
  double ratio = 1.0;
};

// Joins links into tracks, the surest first; a link that would bring two features of one image into
// a track is left out. No feature is in two tracks. Deterministic, whatever the links' order.
std::vector<FeatureTrack> JoinTracks(std::vector<TrackLink> links);

// Matches all pairs worth it and joins what was found.
std::vector<FeatureTrack> BuildTracks(const std::vector<ReconstructedImage>& images,
                                      const MatchingOptions& options, const Progress& progress);

}  // namespace lodemark
