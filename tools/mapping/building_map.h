// Buildings for a feature map: footprints in the map's frame, cut into convex parts.
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "tools/mapping/built_map.h"
#include "tools/mapping/footprints.h"

namespace lodemark {

struct BuildingInput {
  std::string footprints;          // GeoJSON
  std::optional<double> ground_m;  // height of the ground above the ellipsoid; else the origin's
  HeightRules heights;
};

// Adds buildings to what a map will hold, in its frame. Outlines that describe the same building as
// its own building:parts, and those that cross themselves, are passed over with a note. Fails for a
// map that lies nowhere on the earth, and for buildings more than 100 km from its origin.
Status AddBuildings(const BuildingInput& input, const StageProgress& progress, BuiltMap* built);

// A map of buildings alone. Its origin is the one given, or the middle of the footprints on the
// ground, whose height must then be said.
Result<BuiltMap> BuildBuildingMap(const BuildingInput& input, const FrameOptions& frame,
                                  const MapLabels& labels, const StageProgress& progress);

}  // namespace lodemark
