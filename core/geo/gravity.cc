#include "core/geo/gravity.h"

#include <GeographicLib/NormalGravity.hpp>

namespace lodemark {

Eigen::Vector3d GravityInEcef(const Eigen::Vector3d& position_in_ecef) {
  Eigen::Vector3d gravity;
  GeographicLib::NormalGravity::WGS84().U(position_in_ecef.x(), position_in_ecef.y(),
                                          position_in_ecef.z(), gravity.x(), gravity.y(),
                                          gravity.z());
  return gravity;
}

}  // namespace lodemark
