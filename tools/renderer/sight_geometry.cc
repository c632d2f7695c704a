#include "tools/renderer/sight_geometry.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {

double Upright::radius_m() const { return 0.5 * std::hypot(width_m, height_m); }

std::optional<UprightHit> Meet(const Ray& ray, const Upright& upright, Sides sides) {
  const Eigen::Vector2d normal = upright.normal();
  const double against = ray.direction.x() * normal.x() + ray.direction.y() * normal.y();
  if (sides == Sides::kFront ? against >= 0.0 : against == 0.0) return std::nullopt;
  const double du = upright.foot.x() - ray.from.x();
  const double dv = upright.foot.y() - ray.from.y();
  UprightHit hit;
  hit.way = (du * normal.x() + dv * normal.y()) / against;
  if (!(hit.way > 0.0)) return std::nullopt;
  hit.at.u_m = (hit.way * ray.direction.x() - du) * upright.along.x() +
               (hit.way * ray.direction.y() - dv) * upright.along.y();
  if (!(hit.at.u_m >= 0.0 && hit.at.u_m <= upright.width_m)) return std::nullopt;
  hit.at.v_m = ray.from.z() + hit.way * ray.direction.z() - upright.base_m;
  if (!(hit.at.v_m >= 0.0 && hit.at.v_m <= upright.height_m)) return std::nullopt;
  return hit;
}

std::vector<Upright> WallsOf(const Building& building) {
  std::vector<Upright> walls;
  const std::size_t corners = building.footprint_m.size();
  for (std::size_t i = 0; i < corners; ++i) {
    const Eigen::Vector2d edge = building.footprint_m[(i + 1) % corners] - building.footprint_m[i];
    Upright wall;
    wall.foot = building.footprint_m[i];
    wall.width_m = edge.norm();
    wall.along = edge / wall.width_m;
    wall.base_m = building.base_m;
    wall.height_m = building.height_m;
    walls.push_back(wall);
  }
  return walls;
}

std::optional<double> MeetRoof(const Ray& ray, const Building& building) {
  const double drop_m = building.base_m + building.height_m - ray.from.z();
  if (!(ray.direction.z() < 0.0 && drop_m < 0.0)) return std::nullopt;
  const double way = drop_m / ray.direction.z();
  const Eigen::Vector2d at = (ray.from + way * ray.direction).head<2>();
  // Crossings of a half-line to the east: odd inside.
  bool inside = false;
  const std::size_t corners = building.footprint_m.size();
  for (std::size_t i = 0; i < corners; ++i) {
    const Eigen::Vector2d& a = building.footprint_m[i];
    const Eigen::Vector2d& b = building.footprint_m[(i + 1) % corners];
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    const double crossing_m = a.x() + (at.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (crossing_m > at.x()) inside = !inside;
  }
  if (!inside) return std::nullopt;
  return way;
}

bool ViewCone::MayMeet(const Eigen::Vector3d& from, const Eigen::Vector3d& centre,
                       double radius_m) const {
  const Eigen::Vector3d to = centre - from;
  const double distance_m = to.norm();
  if (distance_m <= radius_m) return true;
  const double off_rad = std::acos(std::clamp(axis.dot(to) / distance_m, -1.0, 1.0));
  return off_rad <= half_angle_rad + std::asin(radius_m / distance_m) + 1e-9;
}

ViewCone ConeAround(std::span<const Eigen::Vector3d> directions) {
  ViewCone cone;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& direction : directions) sum += direction.normalized();
  cone.half_angle_rad = kPi;
  if (!(sum.norm() > 1e-6)) return cone;
  cone.axis = sum.normalized();
  cone.half_angle_rad = 0.0;
  for (const Eigen::Vector3d& direction : directions) {
    const double off = std::clamp(cone.axis.dot(direction.normalized()), -1.0, 1.0);
    cone.half_angle_rad = std::max(cone.half_angle_rad, std::acos(off));
  }
  return cone;
}

}  // namespace lodemark
