// Polygons in a plane: corners in order, the last joined to the first, counterclockwise as a rule.
#pragma once

#include <Eigen/Core>
#include <span>

namespace lodemark {

// Positive if the corners go counterclockwise; zero for fewer than three.
double SignedArea(std::span<const Eigen::Vector2d> corners);

// Whether the corners go counterclockwise once around an area above zero and never turn right by
// more than a millionth of a radian. No two corners that follow each other may coincide.
bool IsConvexCounterclockwise(std::span<const Eigen::Vector2d> corners);

// Whether the point is inside, whatever the polygon's shape, by the even-odd rule: of outlines that
// cross themselves, or lists of several rings tested one by one, count the answers. On the edge
// either answer may come.
bool Contains(std::span<const Eigen::Vector2d> corners, const Eigen::Vector2d& point);

}  // namespace lodemark
