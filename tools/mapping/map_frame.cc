#include "tools/mapping/map_frame.h"

#include <algorithm>

namespace lodemark {

Result<MapFrame> MapFrame::Choose(const FrameOptions& options, std::span<const TablePlace> places) {
  const bool any_local =
      std::any_of(places.begin(), places.end(), [](const TablePlace& p) { return p.is_local; });
  const bool any_global =
      std::any_of(places.begin(), places.end(), [](const TablePlace& p) { return !p.is_local; });
  if (options.local) {
    if (any_global) {
      return Error{ErrorCode::kInvalidArgument,
                   "--local: the places are given on the earth, not as east_m, north_m, up_m"};
    }
    return MapFrame(Geodetic{}, true);
  }
  if (options.origin) return MapFrame(*options.origin, false);
  if (any_local || places.empty()) {
    return Error{
        ErrorCode::kInvalidArgument,
        "say where the local frame lies: --origin LATITUDE,LONGITUDE,HEIGHT, or --local if "
        "nowhere"};
  }
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const TablePlace& place : places) {
    middle += place.point_m / static_cast<double>(places.size());
  }
  return MapFrame(GeodeticFromEcef(middle), false);
}

Eigen::Vector3d MapFrame::InEnu(const TablePlace& place) const {
  return place.is_local ? place.point_m : frame_.FromEcef(place.point_m);
}

Eigen::Matrix3d CovarianceOf(const TablePlace& place, double default_sigma_m) {
  Eigen::Vector3d sigma_m = place.sigma_enu_m;
  for (double& sigma : sigma_m) {
    if (!(sigma > 0.0)) sigma = default_sigma_m;
  }
  return sigma_m.cwiseAbs2().asDiagonal();
}

}  // namespace lodemark
