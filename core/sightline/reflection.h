// Signals that come off a wall as off a mirror, a longer way than the straight one.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

#include "core/sightline/building_scene.h"

namespace lodemark {

struct Reflection {
  std::size_t part = 0;
  std::size_t wall = 0;  // from corner wall of the part's footprint to the next
  Eigen::Vector3d point_in_enu_m = Eigen::Vector3d::Zero();  // on the wall
  double extra_path_m = 0.0;                                 // longer than the straight path
  double incidence_rad = 0.0;  // between the signal and the wall's normal: 0 head-on
};

// The path's single bounce off a wall, angle in equal to angle out, found by mirroring its near end
// in the plane of the wall. None if that point is not on the wall, if either end is behind it, or
// if a building stands in the way before or after. Whether the straight path is free does not
// matter.
std::optional<Reflection> ReflectionOff(const BuildingScene& scene, const SightPath& path,
                                        std::size_t part, std::size_t wall);

// All of them off parts within a distance of the near end, the shortest extra path first; as many
// as there is room for, the shortest. Gives how many were written. Allocates nothing.
std::size_t FindReflections(const BuildingScene& scene, const SightPath& path, double distance_m,
                            std::span<Reflection> out);

}  // namespace lodemark
