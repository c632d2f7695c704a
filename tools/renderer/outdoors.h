// What lies round the buildings: the ground and the sky.
#pragma once

#include <Eigen/Core>

#include "tools/renderer/colour.h"
#include "tools/renderer/scene.h"

namespace lodemark {

// The share of light that the ground at a place sends back, a mean over the footprint (width along
// east and north).
Colour GroundColour(const Scene& scene, const Daylight& day, const Eigen::Vector2d& at_m,
                    const Eigen::Vector2d& footprint_m);

// The light of the sun on a surface that faces it, and of the whole sky on one that lies flat. The
// two together are about 1.
struct LightLevels {
  Colour sun;
  Colour sky;
  Eigen::Vector3d to_sun_in_enu = Eigen::Vector3d::UnitZ();
};
LightLevels LevelsOf(const Daylight& day);

// The sky in a direction (unit), clouds included, and the outline of the town far away.
Colour SkyColour(const Scene& scene, const Daylight& day, const LightLevels& levels,
                 const Eigen::Vector3d& direction_in_enu);

// What air adds to a distant thing's light, per unit of what it takes.
Colour HazeColour(const LightLevels& levels);

}  // namespace lodemark
