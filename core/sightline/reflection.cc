#include "core/sightline/reflection.h"

#include <algorithm>
#include <cmath>

namespace lodemark {

std::optional<Reflection> ReflectionOff(const BuildingScene& scene, const SightPath& path,
                                        std::size_t part, std::size_t wall) {
  const std::span<const Eigen::Vector2d> corners = scene.footprint(part);
  const Eigen::Vector2d& corner = corners[wall];
  const Eigen::Vector2d edge = corners[(wall + 1) % corners.size()] - corner;
  const double length_m = edge.norm();
  const Eigen::Vector3d normal = Eigen::Vector3d(edge.y(), -edge.x(), 0.0) / length_m;
  const Eigen::Vector3d& near = path.from_in_enu_m;
  const Eigen::Vector3d foot(corner.x(), corner.y(), 0.0);
  const double ahead_m = normal.dot(near - foot);
  if (!(ahead_m > 0.0)) return std::nullopt;
  const Eigen::Vector3d mirrored = near - 2.0 * ahead_m * normal;

  // The straight path from the mirror image crosses the wall's plane where the signal bounces.
  const bool at_infinity = std::isinf(path.length_m);
  const Eigen::Vector3d far = at_infinity ? path.direction : path.At(path.length_m);
  if (!at_infinity && !(normal.dot(far - foot) > 0.0)) return std::nullopt;
  const SightPath from_mirror =
      at_infinity ? SightPath::Towards(mirrored, far) : SightPath::To(mirrored, far);
  const double rise = normal.dot(from_mirror.direction);
  if (!(rise > 0.0)) return std::nullopt;

  Reflection reflection;
  reflection.part = part;
  reflection.wall = wall;
  reflection.point_in_enu_m = from_mirror.At(ahead_m / rise);
  const Eigen::Vector3d& point = reflection.point_in_enu_m;
  const double along_m = (point.head<2>() - corner).dot(edge) / length_m;
  if (along_m < 0.0 || along_m > length_m) return std::nullopt;
  if (point.z() < scene.base_m(part) || point.z() > scene.top_m(part)) return std::nullopt;

  // The wall's own part is convex and behind the wall, so it blocks neither way.
  const SightPath onward = at_infinity ? SightPath::Towards(point, far) : SightPath::To(point, far);
  if (!scene.IsFree(SightPath::To(near, point), part) || !scene.IsFree(onward, part)) {
    return std::nullopt;
  }
  reflection.extra_path_m =
      at_infinity ? 2.0 * ahead_m * rise : from_mirror.length_m - path.length_m;
  reflection.incidence_rad = std::acos(std::min(rise, 1.0));
  return reflection;
}

std::size_t FindReflections(const BuildingScene& scene, const SightPath& path, double distance_m,
                            std::span<Reflection> out) {
  std::size_t count = 0;
  if (out.empty()) return 0;
  // A path without length is near what is within the distance.
  const SightPath here = {path.from_in_enu_m, Eigen::Vector3d::UnitZ(), 0.0};
  scene.VisitNear(here, {distance_m, 0.0}, [&](std::size_t part) {
    const std::size_t walls = scene.footprint(part).size();
    for (std::size_t wall = 0; wall < walls; ++wall) {
      const std::optional<Reflection> found = ReflectionOff(scene, path, part, wall);
      if (!found) continue;
      const auto longer = [](const Reflection& a, const Reflection& b) {
        return a.extra_path_m < b.extra_path_m;
      };
      const auto filled = out.first(count);
      const auto place = std::upper_bound(filled.begin(), filled.end(), *found, longer);
      const auto at = static_cast<std::size_t>(place - filled.begin());
      if (at == out.size()) continue;
      if (count < out.size()) ++count;
      std::move_backward(out.begin() + static_cast<std::ptrdiff_t>(at),
                         out.begin() + static_cast<std::ptrdiff_t>(count - 1),
                         out.begin() + static_cast<std::ptrdiff_t>(count));
      out[at] = *found;
    }
    return true;
  });
  return count;
}

}  // namespace lodemark
