// What a scenario has photographed: the scene, the camera, the days, and which photographs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/lens.h"
#include "tools/renderer/scene.h"

namespace lodemark {

// How the camera is held.
struct CameraHold {
  double heading_rad = 0.0;  // of the optical axis, clockwise from north
  double tilt_rad = 0.0;     // of it, upwards
  double roll_rad = 0.0;     // of the camera about it, clockwise as its user sees it
};

// Photographs from one place that is not where the phone is: those of a database.
struct Standpoint {
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  // east, north, up
  std::vector<CameraHold> holds;
};

// Photographs that the phone takes one after another where it is.
struct FrameSeries {
  double first_s = 0.0;  // after the start
  double every_s = 1.0;
  bool ahead = false;  // headings count from that of the way
  std::vector<CameraHold> holds;
};

// Photographs of one folder, on one day.
struct PhotoGroup {
  std::string folder = "cam0";
  Daylight day;
  std::vector<Standpoint> standpoints;
  std::vector<FrameSeries> frames;
  bool survey = false;     // with a table of surveyed points and their marks
  int most_people = 0;     // in one photograph
  double bus_share = 0.0;  // of photographs with a bus in them
  double exposure_sigma_ev = 0.15;
  double blur_sigma_px = 0.6;
  double shake_px = 0.0;       // the longest; each photograph has its own
  double electrons = 4'000.0;  // at full scale
  int jpeg_quality = 88;
};

struct Photography {
  Scene scene;
  LensParameters lens;
  std::vector<PhotoGroup> groups;  // none: no photographs
};

}  // namespace lodemark
