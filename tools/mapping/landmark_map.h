// A map from a table of landmarks with their descriptors.
#pragma once

#include <string>

#include "core/base/result.h"
#include "tools/mapping/built_map.h"
#include "tools/mapping/place_columns.h"

namespace lodemark {

struct LandmarkMapInput {
  std::string landmarks;  // csv
  std::string descriptors;
  std::string descriptor_ids;
  DescriptorKind kind = DescriptorKind::kRootSift;
  PlaceOptions places;
  FrameOptions frame;
  MapLabels labels;
  // Of a landmark whose table says none. With 0 its error counts as noise of the photographs that
  // see it, which a resection estimates.
  double default_sigma_m = 0.0;
};

Result<BuiltMap> BuildLandmarkMap(const LandmarkMapInput& input, const StageProgress& progress);

}  // namespace lodemark
