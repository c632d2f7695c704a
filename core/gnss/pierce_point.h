// Where a ray goes through a thin ionosphere around a spherical earth.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/geo/geodetic.h"

namespace lodemark {

struct PiercePoint {
  // Unit vector from the centre of a sphere on which the receiver's latitude is geocentric: what
  // the broadcast models' formulas for latitude and longitude amount to.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double sin_zenith = 0.0;  // of the ray's angle to the vertical in the shell
};

// Where a point beyond the pole lies: there, or, as formulas have it that take the arcsine for the
// step in longitude, mirrored to this side of the pole at the same latitude.
enum class BeyondPole { kThere, kMirrored };

// earth_over_shell is the radius of the earth over that of the shell, below 1. A satellite below
// the horizon counts as on it. Sums of angles are taken by their sines and cosines: no arcs.
inline PiercePoint PierceThinShell(const Geodetic& receiver, const LookAngles& satellite,
                                   double earth_over_shell, BeyondPole beyond_pole) {
  const double elevation_rad = std::max(satellite.elevation_rad, 0.0);
  const double sin_elevation = std::sin(elevation_rad);
  const double cos_elevation = std::cos(elevation_rad);
  PiercePoint pierce;
  pierce.sin_zenith = earth_over_shell * cos_elevation;
  const double cos_zenith = std::sqrt(1.0 - pierce.sin_zenith * pierce.sin_zenith);
  // The angle at the centre is the zenith angle below less the one in the shell.
  const double cos_centre = sin_elevation * cos_zenith + cos_elevation * pierce.sin_zenith;
  const double sin_centre = cos_elevation * cos_zenith - sin_elevation * pierce.sin_zenith;

  const double sin_latitude = std::sin(receiver.latitude_rad);
  const double cos_latitude = std::cos(receiver.latitude_rad);
  const double sin_longitude = std::sin(receiver.longitude_rad);
  const double cos_longitude = std::cos(receiver.longitude_rad);
  const double north = sin_centre * std::cos(satellite.azimuth_rad);
  const double east = sin_centre * std::sin(satellite.azimuth_rad);
  double outwards = cos_centre * cos_latitude - north * sin_latitude;  // from the axis
  if (beyond_pole == BeyondPole::kMirrored) outwards = std::abs(outwards);
  pierce.direction = {outwards * cos_longitude - east * sin_longitude,
                      outwards * sin_longitude + east * cos_longitude,
                      cos_centre * sin_latitude + north * cos_latitude};
  return pierce;
}

}  // namespace lodemark
