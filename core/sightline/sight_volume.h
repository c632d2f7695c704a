// The volume around a path that decides whether it is free, as a convex body, and its meeting with
// buildings: the first Fresnel zone, widened by where the receiver may be.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>

#include "core/sightline/building_scene.h"

namespace lodemark {

// All paths from the receiver's ellipsoid to the target, with the first Fresnel zone around each.
// To a target at infinity the ellipsoid keeps its size and the zone is a paraboloid; to a point the
// ellipsoid shrinks to nothing and the zone is an ellipsoid of revolution.
struct SightVolume {
  SightPath path;
  double cut_m = 0.0;  // the body ends there: finite, and at most the path's length
  // The ellipsoid is receiver_root_m * unit ball: k sigma if the matrix is k times a root of the
  // covariance.
  Eigen::Matrix3d receiver_root_m = Eigen::Matrix3d::Zero();
  double wavelength_m = 0.0;

  // The point of the body that lies farthest in a direction of any length.
  Eigen::Vector3d Support(const Eigen::Vector3d& direction) const;
  // No point of the body is farther from the path than this.
  double LargestRadius() const;
};

// Whether the body and the part, whose roof is higher by raise_m than given, have a point in
// common: the algorithm of Gilbert, Johnson and Keerthi (1988) as libccd has it. Of bodies that
// touch or miss each other by micrometres either answer may come. Bounded: at most 100 steps, no
// allocation.
bool Meets(const SightVolume& volume, const BuildingScene& scene, std::size_t part,
           double raise_m = 0.0);

// Whether the body meets no part of the scene, with roofs raised by sigmas times their sigma.
bool IsFree(const SightVolume& volume, const BuildingScene& scene, double sigmas = 0.0);

}  // namespace lodemark
