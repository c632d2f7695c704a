#include "core/geo/geodetic.h"

#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {

Eigen::Vector3d EcefFromGeodetic(const Geodetic& geodetic) {
  Eigen::Vector3d point;
  GeographicLib::Geocentric::WGS84().Forward(geodetic.latitude_rad * kDegreesPerRadian,
                                             geodetic.longitude_rad * kDegreesPerRadian,
                                             geodetic.height_m, point.x(), point.y(), point.z());
  return point;
}

Geodetic GeodeticFromEcef(const Eigen::Vector3d& point) {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  Geodetic geodetic;
  GeographicLib::Geocentric::WGS84().Reverse(point.x(), point.y(), point.z(), latitude_deg,
                                             longitude_deg, geodetic.height_m);
  geodetic.latitude_rad = latitude_deg * kRadiansPerDegree;
  geodetic.longitude_rad = longitude_deg * kRadiansPerDegree;
  return geodetic;
}

Eigen::Matrix3d EnuFromEcefRotation(const Geodetic& place) {
  const double sin_lat = std::sin(place.latitude_rad);
  const double cos_lat = std::cos(place.latitude_rad);
  const double sin_lon = std::sin(place.longitude_rad);
  const double cos_lon = std::cos(place.longitude_rad);
  Eigen::Matrix3d enu_from_ecef;
  enu_from_ecef << -sin_lon, cos_lon, 0.0,              //
      -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat,  //
      cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
  return enu_from_ecef;
}

EnuFrame::EnuFrame(const Geodetic& origin)
    : origin_(origin),
      origin_in_ecef_(EcefFromGeodetic(origin)),
      enu_from_ecef_(EnuFromEcefRotation(origin)) {}

Eigen::Vector3d EnuFrame::FromEcef(const Eigen::Vector3d& point_in_ecef) const {
  return enu_from_ecef_ * (point_in_ecef - origin_in_ecef_);
}

Eigen::Vector3d EnuFrame::ToEcef(const Eigen::Vector3d& point_in_enu) const {
  return enu_from_ecef_.transpose() * point_in_enu + origin_in_ecef_;
}

LookAngles LookAnglesTo(const Eigen::Vector3d& target_in_ecef, const Eigen::Vector3d& place_in_ecef,
                        const Eigen::Matrix3d& enu_from_ecef) {
  const Eigen::Vector3d line = enu_from_ecef * (target_in_ecef - place_in_ecef).normalized();
  double azimuth_rad = std::atan2(line.x(), line.y());
  if (azimuth_rad < 0.0) azimuth_rad += 2.0 * kPi;
  return {azimuth_rad, std::asin(std::clamp(line.z(), -1.0, 1.0))};
}

}  // namespace lodemark
