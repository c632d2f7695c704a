// A map from photographs whose poses are known: their features, matched and triangulated.
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "tools/mapping/built_map.h"
#include "tools/mapping/feature_matching.h"
#include "tools/mapping/place_columns.h"
#include "tools/mapping/triangulation.h"

namespace lodemark {

struct PosedMapInput {
  std::string images;                  // folder
  std::string poses;                   // csv
  std::optional<LensParameters> lens;  // of all images; else the pinhole of each row
  // Where the cameras were on the earth (csv). Without it the poses are in the frame given.
  std::string camera_positions;
  std::string role;               // only the images that have this role there
  double position_sigma_m = 0.1;  // of a camera whose table says none
  PlaceOptions places;
  FrameOptions frame;
  MapLabels labels;
  DetectorOptions detector;
  MatchingOptions matching;
  TriangulationOptions triangulation;
  GeoregistrationOptions registration;
};

Result<BuiltMap> BuildPosedMap(const PosedMapInput& input, const StageProgress& progress);

}  // namespace lodemark
