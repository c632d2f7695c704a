// The buildings of a map, as sight lines ask for them.
#pragma once

#include "core/base/result.h"
#include "core/map/feature_map.h"
#include "core/sightline/building_scene.h"

namespace lodemark {

// In the map's frame, part by part in the map's order; parts of the same name are one building, and
// one without a name is a building of its own. Empty if the map has none. Error if the map is
// damaged.
Result<BuildingScene> BuildingsOf(const FeatureMap& map);

}  // namespace lodemark
