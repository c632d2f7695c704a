// Which photographs a scenario takes: from where, which way, when.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geo/rigid3.h"
#include "tools/simulator/scenario.h"

namespace lodemark {

struct PlannedPhoto {
  std::string name;  // of the file, within its group's folder
  CameraHold hold;
  Rigid3 camera_from_enu;                   // in the frame of Scenario::place
  std::optional<std::int64_t> time_gps_ns;  // of a frame
  std::uint64_t seed = 1;

  Eigen::Vector3d centre_m() const { return camera_from_enu.Inverse().translation(); }
};

// Pose of a camera at a place.
Rigid3 CameraFromEnu(const Eigen::Vector3d& at_m, const CameraHold& hold);

// The photographs of a group, standpoints first; frames in the order of time.
std::vector<PlannedPhoto> PlanPhotos(const Scenario& scenario, const PhotoGroup& group);

}  // namespace lodemark
