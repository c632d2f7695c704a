#include "core/geo/convex_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/geo/polygon.h"

namespace lodemark {
namespace {

using ::testing::HasSubstr;

// Even-odd over all rings, by the crossing numbers of a ray: knows nothing of the parts.
bool IsIn(const Outline& outline, const Eigen::Vector2d& point) {
  int crossings = 0;
  std::vector<Ring> rings = outline.holes;
  rings.push_back(outline.outer);
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d& a = ring[i];
      const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
      if ((a.x() <= point.x()) == (b.x() <= point.x())) continue;
      const double share = (point.x() - a.x()) / (b.x() - a.x());
      if (a.y() + share * (b.y() - a.y()) > point.y()) ++crossings;
    }
  }
  return crossings % 2 == 1;
}

// Convex, of the same area, without overlap, and holding the same points.
void ExpectCovers(const Outline& outline, const std::vector<Ring>& parts, Random* random) {
  double area_m2 = 0.0;
  for (const Ring& part : parts) {
    EXPECT_TRUE(IsConvexCounterclockwise(part));
    area_m2 += SignedArea(part);
  }
  EXPECT_NEAR(area_m2, AreaOf(outline), 1e-4 * AreaOf(outline) + 0.01);
  Eigen::Vector2d least = outline.outer.front();
  Eigen::Vector2d greatest = least;
  for (const Eigen::Vector2d& corner : outline.outer) {
    least = least.cwiseMin(corner);
    greatest = greatest.cwiseMax(corner);
  }
  int wrong = 0;
  constexpr int kPoints = 400;
  for (int i = 0; i < kPoints; ++i) {
    const double east = random->Uniform(least.x(), greatest.x());
    const Eigen::Vector2d point(east, random->Uniform(least.y(), greatest.y()));
    const auto holding = std::count_if(parts.begin(), parts.end(),
                                       [&](const Ring& part) { return Contains(part, point); });
    if (holding != (IsIn(outline, point) ? 1 : 0)) ++wrong;
  }
  // Corners within a millimetre of a wall were left out.
  EXPECT_LE(wrong, kPoints / 200);
}

Ring Box(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}};
}

// A star: any shape that is seen whole from its middle, most corners reflex.
Ring Star(Random* random, int corners, double least_m, double greatest_m) {
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle_rad = 2.0 * kPi * (i + random->Uniform(0.0, 0.7)) / corners;
    const double radius_m = random->Uniform(least_m, greatest_m);
    ring.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad));
  }
  return ring;
}

TEST(ConvexParts, LeavesAConvexOutlineWhole) {
  for (const Ring& ring : {Box(0, 0, 9, 5), Ring{{0, 0}, {0, 5}, {9, 5}, {9, 0}}}) {
    const auto parts = ConvexParts({ring, {}});
    ASSERT_TRUE(parts.ok()) << parts.error().message;
    ASSERT_EQ(parts->size(), 1U);
    EXPECT_EQ(parts->front().size(), 4U);
    EXPECT_NEAR(SignedArea(parts->front()), 45.0, 1e-12);
  }
}

TEST(ConvexParts, CutsLettersAsAPersonWould) {
  Random random(1);
  const Outline ell = {{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, {}};
  const Outline tee = {{{0, 3}, {2, 3}, {2, 0}, {3, 0}, {3, 3}, {5, 3}, {5, 4}, {0, 4}}, {}};
  const Outline yard = {Box(0, 0, 30, 20), {Box(10, 5, 20, 15)}};
  for (const auto& [outline, most] : {std::pair{ell, 2U}, {tee, 3U}, {yard, 5U}}) {
    const auto parts = ConvexParts(outline);
    ASSERT_TRUE(parts.ok()) << parts.error().message;
    EXPECT_LE(parts->size(), most);
    ExpectCovers(outline, *parts, &random);
  }
}

TEST(ConvexParts, CoversWhateverShape) {
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    const Outline outline = {Star(&random, 3 + round % 40, 4.0, 40.0), {}};
    const auto parts = ConvexParts(outline);
    ASSERT_TRUE(parts.ok()) << parts.error().message << " in round " << round;
    ExpectCovers(outline, *parts, &random);
  }
}

TEST(ConvexParts, CoversOutlinesWithManyCourtyards) {
  Random random(3);
  for (int round = 0; round < 150; ++round) {
    Outline outline;
    outline.outer = Star(&random, 20, 130.0, 160.0);
    // Of any orientation, on a turned grid within, some in line with each other.
    const double turn_rad = round % 3 == 0 ? 0.0 : random.Uniform(0.0, 1.0);
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        Ring hole = round % 2 == 0 ? Box(-12, -12, 12, 12) : Star(&random, 7, 5.0, 15.0);
        if (random.Index(2) == 0) std::reverse(hole.begin(), hole.end());
        for (Eigen::Vector2d& corner : hole) {
          corner += Eigen::Vector2d(40.0 * column, 40.0 * row);
          corner = {std::cos(turn_rad) * corner.x() - std::sin(turn_rad) * corner.y(),
                    std::sin(turn_rad) * corner.x() + std::cos(turn_rad) * corner.y()};
        }
        outline.holes.push_back(std::move(hole));
      }
    }
    const auto parts = ConvexParts(outline);
    ASSERT_TRUE(parts.ok()) << parts.error().message << " in round " << round;
    ExpectCovers(outline, *parts, &random);
  }
}

TEST(ConvexParts, LeavesOutCornersThatMakeNoDifference) {
  const auto parts = ConvexParts(
      {{{0, 0}, {3, 0}, {3, 0}, {6, 0.0002}, {9, 0}, {9, 5}, {9, 5.0004}, {4, 5}, {0, 5}}, {}});
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ASSERT_EQ(parts->size(), 1U);
  EXPECT_EQ(parts->front().size(), 4U);
}

TEST(ConvexParts, SaysWhatIsWrong) {
  const auto why = [](const Outline& outline) {
    const auto parts = ConvexParts(outline);
    return parts.ok() ? std::string("fine") : parts.error().message;
  };
  EXPECT_THAT(why({{}, {}}), HasSubstr("has no area"));
  EXPECT_THAT(why({{{0, 0}, {5, 0}, {9, 0}}, {}}), HasSubstr("has no area"));
  EXPECT_THAT(why({{{0, 0}, {5, 5}, {5, 0}, {0, 6}}, {}}), HasSubstr("crosses itself"));
  EXPECT_THAT(why({Box(0, 0, 5, 5), {Box(4, 4, 6, 6)}}), HasSubstr("crosses itself"));
  EXPECT_THAT(why({Box(0, 0, 5, 5), {Box(7, 7, 8, 8)}}), HasSubstr("hole that is not inside"));
  EXPECT_THAT(why({Ring(6'000, Eigen::Vector2d(1, 2)), {}}), HasSubstr("more than 5,000"));
}

TEST(ConvexParts, EndsForAnyCorners) {
  Random random(4);
  for (int round = 0; round < 3'000; ++round) {
    // Few places, so that corners coincide and edges lie on each other.
    Outline outline;
    const auto ring = [&](std::uint64_t corners) {
      Ring made;
      for (std::uint64_t i = 0; i < corners; ++i) {
        const auto east = static_cast<double>(random.Index(6));
        made.emplace_back(east, static_cast<double>(random.Index(6)));
      }
      return made;
    };
    outline.outer = ring(3 + random.Index(12));
    if (round % 2 == 0) outline.holes.push_back(ring(3 + random.Index(5)));
    const auto parts = ConvexParts(outline);
    if (!parts.ok()) continue;
    for (const Ring& part : *parts) EXPECT_TRUE(IsConvexCounterclockwise(part));
  }
}

TEST(ConvexParts, TakesAPalace) {
  Random random(5);
  const Outline outline = {Star(&random, 4'900, 100.0, 160.0), {}};
  const auto parts = ConvexParts(outline);
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ExpectCovers(outline, *parts, &random);
}

}  // namespace
}  // namespace lodemark
