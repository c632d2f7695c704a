// The buildings of a scenario as others would have them from a public map.
#pragma once

#include <string>
#include <vector>

#include "core/geo/geodetic.h"
#include "tools/renderer/scene.h"

namespace lodemark {

// GeoJSON (RFC 7946) of footprints with height and min_height above the ground in metres, as
// OpenStreetMap names them. frame: where the buildings' east, north and up are measured in.
std::string FootprintsText(const std::vector<Building>& buildings, const EnuFrame& frame);

}  // namespace lodemark
