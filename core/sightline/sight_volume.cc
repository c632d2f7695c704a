#include "core/sightline/sight_volume.h"

#include <ccd/ccd.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/sightline/fresnel_zone.h"

namespace lodemark {
namespace {

constexpr unsigned long kMostSteps = 100;

struct Prism {
  std::span<const Eigen::Vector2d> footprint;
  double base_m;
  double top_m;
};

// The functions that libccd asks for.
void PrismSupport(const void* body, const ccd_vec3_t* direction, ccd_vec3_t* farthest) {
  const Prism& prism = *static_cast<const Prism*>(body);
  const Eigen::Vector2d level(ccdVec3X(direction), ccdVec3Y(direction));
  const Eigen::Vector2d* corner = &prism.footprint.front();
  double reach = corner->dot(level);
  for (const Eigen::Vector2d& other : prism.footprint) {
    const double other_reach = other.dot(level);
    if (other_reach <= reach) continue;
    reach = other_reach;
    corner = &other;
  }
  ccdVec3Set(farthest, corner->x(), corner->y(),
             ccdVec3Z(direction) > 0.0 ? prism.top_m : prism.base_m);
}

void VolumeSupport(const void* body, const ccd_vec3_t* direction, ccd_vec3_t* farthest) {
  const Eigen::Vector3d point = static_cast<const SightVolume*>(body)->Support(
      {ccdVec3X(direction), ccdVec3Y(direction), ccdVec3Z(direction)});
  ccdVec3Set(farthest, point.x(), point.y(), point.z());
}

// At the far end, where the body was cut, the ellipsoid has this share of its size left.
double ShareAt(const SightVolume& volume, double distance_m) {
  return std::isinf(volume.path.length_m) ? 1.0 : 1.0 - distance_m / volume.path.length_m;
}

}  // namespace

Eigen::Vector3d SightVolume::Support(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d in_root = receiver_root_m.transpose() * direction;
  const double root_reach = in_root.norm();
  const double along = direction.dot(path.direction);
  const Eigen::Vector3d across = direction - along * path.direction;
  const double across_reach = across.norm();

  // At t along the path the body reaches along * t + share(t) * root_reach + radius(t) *
  // across_reach; the t at which this is largest follows from its derivative.
  double at_m = 0.0;
  if (std::isinf(path.length_m)) {
    if (along >= 0.0) {
      at_m = cut_m;
    } else {
      at_m = 0.25 * wavelength_m * across_reach * across_reach / (along * along);
    }
  } else if (path.length_m > 0.0) {
    // With t = length/2 * (1 + cos x) the radius is half the root of wavelength * length times sin
    // x.
    const double even = 0.5 * (along * path.length_m - root_reach);
    const double bulge = 0.5 * std::sqrt(wavelength_m * path.length_m) * across_reach;
    const double both = std::hypot(even, bulge);
    at_m = both > 0.0 ? 0.5 * path.length_m * (1.0 + even / both) : 0.0;
  }
  at_m = std::clamp(at_m, 0.0, cut_m);

  Eigen::Vector3d point = path.At(at_m);
  if (root_reach > 0.0) {
    point += ShareAt(*this, at_m) / root_reach * (receiver_root_m * in_root);
  }
  if (across_reach > 0.0) {
    point += FirstFresnelRadius(wavelength_m, at_m, path.length_m) / across_reach * across;
  }
  return point;
}

double SightVolume::LargestRadius() const {
  const double widest_at_m = std::min(cut_m, 0.5 * path.length_m);
  return receiver_root_m.norm() + FirstFresnelRadius(wavelength_m, widest_at_m, path.length_m);
}

bool Meets(const SightVolume& volume, const BuildingScene& scene, std::size_t part,
           double raise_m) {
  const Prism prism = {scene.footprint(part), scene.bottom_m(part), scene.top_m(part) + raise_m};
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = PrismSupport;
  ccd.support2 = VolumeSupport;
  ccd.max_iterations = kMostSteps;
  return ccdGJKIntersect(&prism, &volume, &ccd) != 0;
}

bool IsFree(const SightVolume& volume, const BuildingScene& scene, double sigmas) {
  bool is_free = true;
  SightPath path = volume.path;
  path.length_m = volume.cut_m;
  scene.VisitNear(path, {volume.LargestRadius(), sigmas}, [&](std::size_t part) {
    is_free = !Meets(volume, scene, part, sigmas * scene.top_sigma_m(part));
    return is_free;
  });
  return is_free;
}

}  // namespace lodemark
