// Photographs whose poses are known, as poses.csv lists them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "tools/mapping/place_columns.h"
#include "tools/mapping/table_rows.h"

namespace lodemark {

struct PosedImage {
  std::string name;  // relative to the folder of the images
  Rigid3 camera_from_world;
  std::optional<LensParameters> pinhole;  // from fx, fy, ppx, ppy, width, height
};

// Columns name,qw,qx,qy,qz,tx,ty,tz (world to camera) and, where known, the centre cx,cy,cz, which
// must agree, and a pinhole camera's fx,fy,ppx,ppy,width,height. No name twice.
Result<std::vector<PosedImage>> ReadPosesTable(const std::string& path);
Result<std::vector<PosedImage>> ReadPosesTable(TableRows rows);

// Where cameras were when they took their photographs: column name and a place; role, where there
// is such a column.
struct CameraPlace {
  std::string name;
  std::string role;  // "database", "query" ...
  TablePlace place;
};
Result<std::vector<CameraPlace>> ReadCameraPlaces(const std::string& path,
                                                  const PlaceOptions& options);

}  // namespace lodemark
