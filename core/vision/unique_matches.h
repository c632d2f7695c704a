// From features that resemble landmarks to matches in which nothing comes twice.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/map/feature_map.h"
#include "core/vision/features.h"
#include "core/vision/look_up.h"

namespace lodemark {

// A feature and the landmark that looks most like it; distances as in core/map/descriptor.h.
struct MatchCandidate {
  std::uint32_t feature = 0;
  std::uint32_t landmark_id = 0;
  std::uint32_t distance = 0;
  double ratio = 1.0;
};

// Error unless the features are of the map's kind and have a descriptor each.
Status CheckFeatures(const FeatureMap& map, const Features& features);

// Ratio of the nearest and the second nearest landmark's distances (not squared). Where there is no
// second, strangers at their usual distance stand in for it. Nothing if the nearest is itself no
// nearer than strangers are, or the ratio is above the largest allowed.
std::optional<double> AcceptedRatio(DescriptorKind kind, const NearestLandmarks& nearest,
                                    double largest_ratio);

// Of the features that want one landmark the nearest gets it. Best first: by ratio, then by
// feature.
Result<std::vector<LandmarkMatch>> UniqueMatches(const FeatureMap& map, const Features& features,
                                                 std::vector<MatchCandidate> candidates);

}  // namespace lodemark
