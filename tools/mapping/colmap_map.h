// A map from a COLMAP model and the descriptors in its database, laid on the earth.
#pragma once

#include <string>

#include "core/base/result.h"
#include "tools/mapping/built_map.h"
#include "tools/mapping/ties.h"
#include "tools/mapping/triangulation.h"

namespace lodemark {

struct ColmapMapInput {
  std::string model;     // folder
  std::string database;  // database.db
  // What lays the model on the earth, any of these together; none if it lies there already.
  std::string control_points;    // csv of surveyed points, and of their marks unless
  std::string marks;             // this names another
  std::string image_gps;         // folder of the photographs, for their EXIF
  std::string camera_positions;  // csv
  TieSigmas sigmas;
  PlaceOptions places;
  FrameOptions frame;
  MapLabels labels;
  TriangulationOptions triangulation;
  GeoregistrationOptions registration;
};

Result<BuiltMap> ImportColmap(const ColmapMapInput& input, const StageProgress& progress);

}  // namespace lodemark
