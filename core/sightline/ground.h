// The ground that the houses around stand on.
#pragma once

#include <Eigen/Core>

#include "core/sightline/building_scene.h"

namespace lodemark {

// The place, or straight above it the ground: nobody is lower, and satellites alone tell heights so
// badly that houses, looked at from below, would stand higher than they are. The ground is where
// the nearest house that is not raised has its base; without any, the place is left as it is.
Eigen::Vector3d NotBelowGround(const BuildingScene& scene, const Eigen::Vector3d& place_in_enu_m);

}  // namespace lodemark
