#include "core/geo/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

Polygon Regular(int corners, double radius, int step = 1) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle_rad = 2.0 * kPi * i * step / corners;
    polygon.emplace_back(radius * std::cos(angle_rad), radius * std::sin(angle_rad));
  }
  return polygon;
}

TEST(Polygon, HasTheAreaOfTheTextbook) {
  EXPECT_DOUBLE_EQ(SignedArea(Polygon{{0, 0}, {4, 0}, {4, 3}}), 6.0);
  EXPECT_DOUBLE_EQ(SignedArea(Polygon{{0, 0}, {4, 3}, {4, 0}}), -6.0);
  EXPECT_EQ(SignedArea(Polygon{{0, 0}, {4, 3}}), 0.0);
  EXPECT_NEAR(SignedArea(Regular(6, 2.0)), 6.0 * std::sqrt(3.0), 1e-12);
}

TEST(Polygon, AreaDoesNotDependOnWhereItLies) {
  Polygon polygon = Regular(7, 10.0);
  const double area = SignedArea(polygon);
  for (Eigen::Vector2d& corner : polygon) corner += Eigen::Vector2d(9e4, -8e4);
  EXPECT_NEAR(SignedArea(polygon), area, 1e-8);
}

TEST(Polygon, KnowsConvexOnesFromAllOthers) {
  EXPECT_TRUE(IsConvexCounterclockwise(Regular(3, 1.0)));
  EXPECT_TRUE(IsConvexCounterclockwise(Regular(50, 1.0)));
  EXPECT_TRUE(IsConvexCounterclockwise(Polygon{{0, 0}, {1, 0}, {2, 0}, {2, 2}}));  // on one line
  EXPECT_FALSE(IsConvexCounterclockwise(Regular(5, 1.0, 2)));                      // a pentagram
  EXPECT_FALSE(IsConvexCounterclockwise(Polygon{{0, 0}, {2, 0}, {2, 2}, {1, 0.5}}));
  EXPECT_FALSE(IsConvexCounterclockwise(Polygon{{0, 0}, {0, 1}, {1, 0}}));  // clockwise
  EXPECT_FALSE(IsConvexCounterclockwise(Polygon{{0, 0}, {1, 0}, {1, 0}, {0, 1}}));
  EXPECT_FALSE(IsConvexCounterclockwise(Polygon{{0, 0}, {1, 0}, {2, 0}}));
  EXPECT_FALSE(IsConvexCounterclockwise(Polygon{{0, 0}, {1, 0}}));
  EXPECT_FALSE(IsConvexCounterclockwise(Polygon{{0, 0}, {1, 0}, {NAN, 1}}));
}

TEST(Polygon, ContainsWhatIsInsideAConvexOneByItsEdges) {
  Random random(3);
  for (int round = 0; round < 2000; ++round) {
    const Polygon polygon = Regular(3 + round % 9, random.Uniform(1.0, 5.0));
    const double east = random.Uniform(-5.0, 5.0);
    const Eigen::Vector2d point(east, random.Uniform(-5.0, 5.0));
    bool inside = true;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
      const Eigen::Vector2d to_point = point - polygon[i];
      inside = inside && edge.x() * to_point.y() - edge.y() * to_point.x() > 0.0;
    }
    EXPECT_EQ(Contains(polygon, point), inside);
  }
}

TEST(Polygon, ContainsNothingWhereThereIsNone) {
  EXPECT_FALSE(Contains(Polygon{}, {0, 0}));
  // The notch of an L is outside.
  const Polygon ell = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
  EXPECT_TRUE(Contains(ell, {0.5, 3}));
  EXPECT_FALSE(Contains(ell, {2, 2}));
}

}  // namespace
}  // namespace lodemark
