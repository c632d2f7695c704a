#include "core/sightline/ground.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace lodemark {

Eigen::Vector3d NotBelowGround(const BuildingScene& scene, const Eigen::Vector3d& place_in_enu_m) {
  double nearest_m2 = std::numeric_limits<double>::infinity();
  double ground_m = place_in_enu_m.z();
  for (std::size_t part = 0; part < scene.part_count(); ++part) {
    if (scene.bottom_m(part) == scene.base_m(part)) continue;  // raised
    const double away_m2 = (scene.footprint(part).front() - place_in_enu_m.head<2>()).squaredNorm();
    if (!(away_m2 < nearest_m2)) continue;
    nearest_m2 = away_m2;
    ground_m = scene.base_m(part);
  }
  return {place_in_enu_m.x(), place_in_enu_m.y(), std::max(place_in_enu_m.z(), ground_m)};
}

}  // namespace lodemark
