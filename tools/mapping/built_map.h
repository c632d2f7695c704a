// What every way of making a map takes and gives.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/map/feature_map.h"
#include "tools/mapping/georegistration.h"
#include "tools/mapping/map_content.h"
#include "tools/mapping/map_frame.h"

namespace lodemark {

// Told what is being done, and the share of it.
using StageProgress = std::function<void(const char* stage, double share)>;

struct MapLabels {
  std::string datum = "WGS 84";
  double epoch_year = 0.0;  // 0: not said
};

struct BuiltMap {
  MapInfo info;  // but for the provenance
  MapContent content;
  // Where a model was laid on the earth, and the names of the places that held it.
  std::optional<Georegistration> registration;
  std::vector<std::string> tie_names;
  std::size_t buildings = 0;       // whose parts are in the content
  double noise_px = 0.0;           // of the features; 0 where nothing was triangulated
  std::vector<std::string> notes;  // sentences on what was passed over
};

// Origin, datum, epoch and kind.
MapInfo InfoFor(const MapFrame& frame, const MapLabels& labels, DescriptorKind kind);

}  // namespace lodemark
