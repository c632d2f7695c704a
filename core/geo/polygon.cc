#include "core/geo/polygon.h"

#include <cstddef>

namespace lodemark {
namespace {

constexpr double kLargestRightTurn = 1e-6;  // sine

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// An edge points to the right half of the plane, straight up counting as right.
bool PointsRight(const Eigen::Vector2d& edge) {
  return edge.x() > 0.0 || (edge.x() == 0.0 && edge.y() > 0.0);
}

}  // namespace

double SignedArea(std::span<const Eigen::Vector2d> corners) {
  double twice = 0.0;
  // Seen from the first corner, so that coordinates far from zero cost no digits.
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Eigen::Vector2d last = corners[i - 1] - corners[0];
    const Eigen::Vector2d next = corners[i] - corners[0];
    twice += Cross(last, next);
  }
  return 0.5 * twice;
}

bool IsConvexCounterclockwise(std::span<const Eigen::Vector2d> corners) {
  const std::size_t count = corners.size();
  if (count < 3 || !(SignedArea(corners) > 0.0)) return false;
  // Going once around, the edges change from right to left and back; a star does so more often.
  int changes = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % count] - corners[i];
    const Eigen::Vector2d next = corners[(i + 2) % count] - corners[(i + 1) % count];
    const double lengths = edge.norm() * next.norm();
    if (!(lengths > 0.0)) return false;
    if (!(Cross(edge, next) >= -kLargestRightTurn * lengths)) return false;
    if (PointsRight(edge) != PointsRight(next)) ++changes;
  }
  return changes == 2;
}

bool Contains(std::span<const Eigen::Vector2d> corners, const Eigen::Vector2d& point) {
  bool inside = false;
  const std::size_t count = corners.size();
  for (std::size_t i = 0, j = count - 1; i < count; j = i++) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

}  // namespace lodemark
