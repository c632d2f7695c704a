// Rays against walls, roofs and flat cards.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tools/renderer/canvas.h"
#include "tools/renderer/scene.h"

namespace lodemark {

struct Ray {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();  // of any length
};

// An upright rectangle, looked at from the side its normal points to.
struct Upright {
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();    // its lower left corner
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  // unit, to the right
  double width_m = 1.0;
  double base_m = 0.0;
  double height_m = 1.0;

  Eigen::Vector2d normal() const { return {along.y(), -along.x()}; }
  Eigen::Vector3d At(CanvasPoint point) const {
    return {foot.x() + point.u_m * along.x(), foot.y() + point.u_m * along.y(), base_m + point.v_m};
  }
  Eigen::Vector3d centre() const { return At({0.5 * width_m, 0.5 * height_m}); }
  double radius_m() const;
};

enum class Sides : std::uint8_t { kFront, kBoth };

// Where a ray meets one: how many lengths of its direction away, and where on the rectangle.
struct UprightHit {
  double way = 0.0;
  CanvasPoint at;
};
std::optional<UprightHit> Meet(const Ray& ray, const Upright& upright, Sides sides);

// The walls of a prism, each as it is seen from outside, in the order of its footprint's edges.
std::vector<Upright> WallsOf(const Building& building);

// How far a ray is from the prism's flat roof, met from above.
std::optional<double> MeetRoof(const Ray& ray, const Building& building);

// Where a rectangle's pixels' rays lead: all those in a cone can be passed over at once.
struct ViewCone {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  double half_angle_rad = 0.0;

  // Whether it may meet a ball. from: its tip.
  bool MayMeet(const Eigen::Vector3d& from, const Eigen::Vector3d& centre, double radius_m) const;
};
ViewCone ConeAround(std::span<const Eigen::Vector3d> directions);

}  // namespace lodemark
