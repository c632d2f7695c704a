// Where the sky begins, seen from a place among buildings.
#pragma once

#include <Eigen/Core>

#include "core/sightline/building_scene.h"

namespace lodemark {

// The elevation of the highest roof in a direction (clockwise from north), 0 .. pi/2. 0 where there
// is none above the horizon; pi/2 beneath a roof.
double SkylineElevation(const BuildingScene& scene, const Eigen::Vector3d& place_in_enu_m,
                        double azimuth_rad);

}  // namespace lodemark
