// Places that a model and the earth have in common: marked survey points and camera positions.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "tools/mapping/georegistration.h"
#include "tools/mapping/map_frame.h"
#include "tools/mapping/poses_table.h"
#include "tools/mapping/reconstruction.h"
#include "tools/mapping/survey_table.h"

namespace lodemark {

// Sigmas of what notes none itself.
struct TieSigmas {
  double survey_m = 0.02;
  double mark_px = 1.0;
  double camera_m = 0.1;
  double gps_horizontal_m = 5.0;  // of positions in EXIF
  double gps_vertical_m = 15.0;   // the standard's altitude is not above the ellipsoid
};

// A photograph whose pose in the model is known. Only marks need its lens.
struct PosedCamera {
  std::string name;
  const Lens* lens = nullptr;
  const Rigid3* camera_from_world = nullptr;
};

// Where cameras were, by the EXIF of their photographs in a folder. Photographs that are not there
// or say nothing are left out; an error if none says anything.
Result<std::vector<CameraPlace>> ReadExifPlaces(const std::string& folder,
                                                const std::vector<std::string>& names,
                                                const TieSigmas& sigmas);

std::vector<TiePoint> TiesOfCameras(const std::vector<CameraPlace>& places,
                                    const std::vector<PosedCamera>& cameras, const MapFrame& frame,
                                    double default_sigma_m);

// Surveyed points that at least two cameras have marked, triangulated in the model. notes gets a
// sentence for each that could not be.
std::vector<TiePoint> TiesOfMarks(const std::vector<SurveyedPoint>& points,
                                  const std::vector<ImageMark>& marks,
                                  const std::vector<PosedCamera>& cameras, const MapFrame& frame,
                                  const TieSigmas& sigmas, std::vector<std::string>* notes);

}  // namespace lodemark
