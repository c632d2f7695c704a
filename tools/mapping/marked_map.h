// A map of surveyed points, made from photographs in which somebody marked them (Xu et al., section
// 4.1): each point looks like the features that are found at its marks.
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "tools/mapping/built_map.h"
#include "tools/mapping/place_columns.h"

namespace lodemark {

struct MarkedMapInput {
  std::string images;  // folder
  std::string marks;   // csv: image, point, x_px, y_px
  std::string survey;  // csv: point and its place
  // With it each photograph's pose is found from its marks, and the map knows from where its
  // descriptors were seen, and counts how far the features lie from their marks as an error of the
  // landmarks.
  std::optional<LensParameters> lens;
  PlaceOptions places;
  FrameOptions frame;
  MapLabels labels;
  DetectorOptions detector;
  double default_sigma_m = 0.02;  // of a point whose table says none
  double mark_sigma_px = 1.0;     // of a mark whose table says none
};

Result<BuiltMap> BuildMarkedMap(const MarkedMapInput& input, const StageProgress& progress);

}  // namespace lodemark
