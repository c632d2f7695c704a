#include "core/sightline/skyline.h"

#include <algorithm>
#include <cmath>

namespace lodemark {

double SkylineElevation(const BuildingScene& scene, const Eigen::Vector3d& place_in_enu_m,
                        double azimuth_rad) {
  const Eigen::Vector3d level = DirectionFromAngles(azimuth_rad, 0.0);
  double elevation_rad = 0.0;
  for (std::size_t part = 0; part < scene.part_count(); ++part) {
    const double above_m = scene.top_m(part) - place_in_enu_m.z();
    if (!(above_m > 0.0)) continue;
    // At the height of the part's middle, where the line crosses its walls if it does.
    Eigen::Vector3d from = place_in_enu_m;
    from.z() = 0.5 * (scene.base_m(part) + scene.top_m(part));
    const Chord chord = scene.ClipLine(part, from, level);
    if (!(chord.exit_m > std::max(chord.enter_m, 0.0))) continue;
    elevation_rad = std::max(elevation_rad, std::atan2(above_m, std::max(chord.enter_m, 0.0)));
  }
  return elevation_rad;
}

}  // namespace lodemark
