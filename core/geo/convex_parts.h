// Outlines with notches and courtyards cut into convex parts, as sight lines need them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace lodemark {

// Corners in order, either way around; the last is joined to the first and not the same.
using Ring = std::vector<Eigen::Vector2d>;

// An outline and the holes in it.
struct Outline {
  Ring outer;
  std::vector<Ring> holes;
};

constexpr std::size_t kMostOutlineCorners = 5'000;

// Convex, counterclockwise parts that together cover the outline without its holes, and do not
// overlap. Corners closer than 1 mm, or within 1 mm of a straight wall, are left out before.
// kBadData, in a few words that follow the outline's name, if it crosses itself, a hole is not
// inside, it has no area, or more than kMostOutlineCorners corners.
//
// Ears are clipped (Meisters 1975) after holes are joined to the outside by bridges, and triangles
// merged as long as they stay convex (Hertel and Mehlhorn 1983): at most four times as many parts
// as there have to be.
Result<std::vector<Ring>> ConvexParts(const Outline& outline);

// The area of the outline less that of the holes.
double AreaOf(const Outline& outline);

}  // namespace lodemark
