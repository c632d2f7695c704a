#include "core/sightline/sight_chance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "core/sightline/fresnel_zone.h"
#include "test/unit/sightline/town.h"

namespace lodemark {
namespace {

constexpr double kL1_m = 0.190293672798;  // wavelength of GPS L1

double NormalBelow(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// A wall without end to the east, whose roof is level with the path at an elevation.
struct Edge {
  explicit Edge(double elevation_deg, double roof_sigma_m = 0.0)
      : elevation_rad(elevation_deg * kRadiansPerDegree),
        scene(SceneOf(
            {Block(3, {kAway_m, -4000, -100},
                   {kAway_m + 10.0, 4000, kAway_m * std::tan(elevation_rad)}, roof_sigma_m)})) {}

  // Passing the edge at a distance, at a right angle to the path.
  SightPath Above(double clearance_m) const {
    const double up_m = clearance_m / std::cos(elevation_rad);
    return SightPath::Towards({0, 0, up_m}, DirectionFromAngles(0.5 * kPi, elevation_rad));
  }

  static constexpr double kAway_m = 30.0;
  double elevation_rad;
  BuildingScene scene;
};

TEST(SightChance, IsThePlainAnswerWithoutDoubt) {
  const BuildingScene scene = SceneOf(Town(61, 20));
  UncertainViewpoint viewpoint(&scene);
  Random random(62);
  int blocked = 0;
  for (int round = 0; round < 500; ++round) {
    const Eigen::Vector3d here(random.Uniform(-300.0, 300.0), 4.0, 1.5);
    viewpoint.Stand(here, Eigen::Matrix3d::Zero());
    const double azimuth_rad = random.Uniform(0.0, 2.0 * kPi);
    const SightPath path =
        SightPath::Towards(here, DirectionFromAngles(azimuth_rad, random.Uniform(0.1, 1.5)));
    const std::optional<Blocker> blocker = scene.FirstBlocker(path);
    // The roofs' own sigmas stay; look only where they cannot matter.
    bool sure = true;
    for (const double shift_m : {-9.0, 9.0}) {
      SightPath shifted = path;
      shifted.from_in_enu_m.z() += shift_m;
      sure = sure && scene.IsFree(shifted) == !blocker.has_value();
    }
    if (!sure) continue;
    const SightChance chance = viewpoint.Towards(path.direction, 0.0);
    EXPECT_EQ(chance.probability, blocker ? 0.0 : 1.0);
    EXPECT_EQ(chance.part.has_value(), blocker.has_value());
    if (!blocker) continue;
    ++blocked;
    EXPECT_EQ(*chance.part, blocker->part);
  }
  EXPECT_GT(blocked, 50);
}

TEST(SightChance, IsOneHalfWhereThePathGrazes) {
  for (const double elevation_deg : {5.0, 30.0, 60.0}) {
    const Edge edge(elevation_deg, 1.0);
    UncertainViewpoint viewpoint(&edge.scene);
    const SightPath path = edge.Above(0.0);
    viewpoint.Stand(path.from_in_enu_m, 4.0 * Eigen::Matrix3d::Identity());
    EXPECT_NEAR(viewpoint.Towards(path.direction, kL1_m).probability, 0.5, 0.01);
  }
}

// Only the component across the edge counts, and it has the Gaussian's own distribution.
TEST(SightChance, FollowsTheNormalDistributionOverAnEdge) {
  Eigen::Matrix3d root;
  root << 3.0, 0.5, -0.2, 0.0, 2.0, 0.7, 0.0, 0.0, 4.0;
  const Eigen::Matrix3d covariance_m2 = root * root.transpose();
  double worst = 0.0;
  for (const double elevation_deg : {10.0, 35.0, 55.0}) {
    const Edge edge(elevation_deg);
    UncertainViewpoint viewpoint(&edge.scene);
    const double elevation_rad = edge.elevation_rad;
    const Eigen::Vector3d across(-std::sin(elevation_rad), 0.0, std::cos(elevation_rad));
    const double sigma_m = std::sqrt(across.dot(covariance_m2 * across));
    for (double sigmas = -2.0; sigmas <= 2.0; sigmas += 0.25) {
      const SightPath path = edge.Above(sigmas * sigma_m);
      viewpoint.Stand(path.from_in_enu_m, covariance_m2);
      const double found = viewpoint.Towards(path.direction, 0.0).probability;
      worst = std::max(worst, std::abs(found - NormalBelow(sigmas)));
    }
  }
  EXPECT_LT(worst, 0.04);
}

TEST(SightChance, FollowsTheNormalDistributionOfARoof) {
  const Edge edge(40.0, 2.5);
  UncertainViewpoint viewpoint(&edge.scene);
  for (double sigmas = -2.0; sigmas <= 2.0; sigmas += 0.25) {
    const SightPath path = edge.Above(2.5 * sigmas * std::cos(edge.elevation_rad));
    viewpoint.Stand(path.from_in_enu_m, Eigen::Matrix3d::Zero());
    EXPECT_NEAR(viewpoint.Towards(path.direction, 0.0).probability, NormalBelow(sigmas), 0.04);
  }
}

// The clear share of a disc, and the field behind a knife edge by Fresnel's integrals, worked out
// by adding up the wave.
TEST(SightChance, FollowsTheWaveOverAnEdge) {
  const Edge edge(30.0);
  UncertainViewpoint viewpoint(&edge.scene);
  const double distance_m = Edge::kAway_m / std::cos(edge.elevation_rad);
  const double radius_m = FirstFresnelRadius(kL1_m, distance_m, INFINITY);
  for (double share = -1.5; share <= 1.5; share += 0.25) {
    const SightPath path = edge.Above(share * radius_m);
    viewpoint.Stand(path.from_in_enu_m, Eigen::Matrix3d::Zero());
    const double found = viewpoint.Towards(path.direction, kL1_m).probability;
    const double x = std::clamp(share, -1.0, 1.0);
    const double disc = 0.5 + (std::asin(x) + x * std::sqrt(1.0 - x * x)) / kPi;
    EXPECT_NEAR(found, disc, 0.05) << share;

    // ITU-R P.526-15 (24), (31): v is root 2 times the obstruction in zone radii.
    const double v = -std::sqrt(2.0) * share;
    double cosines = 0.0;
    double sines = 0.0;
    constexpr double kStep = 1e-4;
    for (double s = 0.5 * kStep; s < std::abs(v); s += kStep) {
      cosines += kStep * std::cos(0.5 * kPi * s * s);
      sines += kStep * std::sin(0.5 * kPi * s * s);
    }
    const double sign = v < 0.0 ? -1.0 : 1.0;
    const double field = std::hypot(1.0 - sign * (cosines + sines), sign * (cosines - sines)) / 2.0;
    EXPECT_NEAR(found, std::min(field, 1.0), 0.2) << share;
  }
}

TEST(SightChance, ParksNothingBetweenPartsOfOneHouse) {
  // Cut into two parts right where the path goes.
  const BuildingScene whole = SceneOf({Block(1, {20, -30, 0}, {40, 30, 25})});
  const BuildingScene halves =
      SceneOf({Block(1, {20, -30, 0}, {40, 0, 25}), Block(1, {20, 0, 0}, {40, 30, 25})});
  UncertainViewpoint of_whole(&whole);
  UncertainViewpoint of_halves(&halves);
  const Eigen::Matrix3d covariance_m2 = 9.0 * Eigen::Matrix3d::Identity();
  of_whole.Stand({0, 0, 1.5}, covariance_m2);
  of_halves.Stand({0, 0, 1.5}, covariance_m2);
  for (double elevation_deg = 5.0; elevation_deg < 80.0; elevation_deg += 5.0) {
    const Eigen::Vector3d direction =
        DirectionFromAngles(0.5 * kPi, elevation_deg * kRadiansPerDegree);
    EXPECT_NEAR(of_whole.Towards(direction, kL1_m).probability,
                of_halves.Towards(direction, kL1_m).probability, 0.02);
  }
}

// Against two thousand random draws through the exact clip, by another generator.
TEST(SightChance, AgreesWithMonteCarlo) {
  const std::vector<BuildingPrism> town = Town(63, 16);
  const BuildingScene scene = SceneOf(town);
  UncertainViewpoint viewpoint(&scene);
  Random random(64);
  Eigen::Matrix3d root;
  root << 5.0, 0.0, 0.0, 2.0, 3.0, 0.0, -1.0, 0.5, 6.0;
  double worst = 0.0;
  double total = 0.0;
  int doubtful = 0;
  for (int round = 0; round < 40; ++round) {
    const Eigen::Vector3d here(random.Uniform(-80.0, 80.0), 0.0, 8.0);
    viewpoint.Stand(here, root * root.transpose());
    const double azimuth_rad = random.Uniform(0.0, 2.0 * kPi);
    const Eigen::Vector3d direction = DirectionFromAngles(azimuth_rad, random.Uniform(0.2, 1.2));
    const Eigen::Vector3d across = direction.unitOrthogonal();
    const Eigen::Vector3d other = direction.cross(across);
    std::vector<std::size_t> parts;
    scene.VisitNear(SightPath::Towards(here, direction), {40.0, 5.0}, [&](std::size_t part) {
      parts.push_back(part);
      return true;
    });
    int free = 0;
    int possible = 0;
    for (int draw = 0; draw < 2'000; ++draw) {
      Eigen::Vector3d normal;
      for (double& value : normal) value = random.Gaussian();
      const Eigen::Vector3d start = here + root * normal;
      if (scene.IsInside(start)) continue;
      ++possible;
      const double angle_rad = random.Uniform(0.0, 2.0 * kPi);
      const double away = std::sqrt(random.Uniform());
      const Eigen::Vector3d turned = std::cos(angle_rad) * across + std::sin(angle_rad) * other;
      bool blocked = false;
      for (const std::size_t part : parts) {
        const double raise_m = random.Gaussian(0.0, town[part].top_sigma_m);
        // Straight stretches of two metres along the curve.
        for (double at_m = 0.0; at_m < 120.0 && !blocked; at_m += 2.0) {
          const auto point = [&](double t) {
            return Eigen::Vector3d(start + t * direction +
                                   away * FirstFresnelRadius(kL1_m, t, INFINITY) * turned);
          };
          const Eigen::Vector3d from = point(at_m);
          const Eigen::Vector3d step = point(at_m + 2.0) - from;
          const Chord within = scene.ClipLine(part, from, step, raise_m);
          blocked = std::min(within.exit_m, 1.0) - std::max(within.enter_m, 0.0) > 1e-9;
        }
        if (blocked) break;
      }
      if (!blocked) ++free;
    }
    const double expected = static_cast<double>(free) / possible;
    const double found = viewpoint.Towards(direction, kL1_m).probability;
    if (expected > 0.02 && expected < 0.98) ++doubtful;
    worst = std::max(worst, std::abs(found - expected));
    total += std::abs(found - expected);
  }
  EXPECT_GT(doubtful, 20);
  EXPECT_LT(worst, 0.1);
  EXPECT_LT(total / 40, 0.02);
}

TEST(SightChance, OfAPlaceThatMayBeIndoorsOnlyTheOutsideCounts) {
  // The receiver is as likely behind the wall as before it.
  const BuildingScene scene = SceneOf({Block(0, {0, -500, -50}, {200, 500, 40})});
  UncertainViewpoint viewpoint(&scene);
  viewpoint.Stand({0, 0, 2}, 4.0 * Eigen::Matrix3d::Identity());
  EXPECT_NEAR(viewpoint.outdoors(), 0.5, 0.02);
  EXPECT_EQ(viewpoint.Towards(DirectionFromAngles(-0.5 * kPi, 0.5), 0.0).probability, 1.0);
  viewpoint.Stand({100, 0, 2}, 4.0 * Eigen::Matrix3d::Identity());
  EXPECT_EQ(viewpoint.outdoors(), 0.0);
  EXPECT_EQ(viewpoint.Towards(DirectionFromAngles(-0.5 * kPi, 0.5), 0.0).probability, 0.0);
}

TEST(SightChance, ALandmarkOnAWallIsInSightAndOneBehindItIsNot) {
  const BuildingScene scene = SceneOf({Block(0, {20, -10, 0}, {40, 10, 15})});
  UncertainViewpoint viewpoint(&scene);
  viewpoint.Stand({0, 0, 1.5}, 0.25 * Eigen::Matrix3d::Identity());
  constexpr double kLight_m = 550e-9;
  EXPECT_EQ(viewpoint.To({20, 3, 6}, kLight_m, 0.3).probability, 1.0);
  EXPECT_EQ(viewpoint.To({40, 3, 6}, kLight_m, 0.3).probability, 0.0);
  EXPECT_EQ(viewpoint.To({41, 3, 6}, kLight_m, 0.3).part, std::optional<std::size_t>(0));
  EXPECT_EQ(viewpoint.To({0.1, 0, 1.5}, kLight_m, 0.3).probability, 1.0);
  // Past the corner by as much as the receiver's place is unsure there.
  const SightChance chance = viewpoint.To({40, 20, 1.5}, kLight_m, 0.3);
  EXPECT_GT(chance.probability, 0.1);
  EXPECT_LT(chance.probability, 0.9);
}

TEST(SightChance, RisesWithTheSatellite) {
  const BuildingScene scene = SceneOf({Block(0, {15, -100, 0}, {30, 100, 25}, 3.0)});
  UncertainViewpoint viewpoint(&scene);
  viewpoint.Stand({0, 0, 1.5}, 16.0 * Eigen::Matrix3d::Identity());
  double last = 0.0;
  for (double elevation_deg = 0.0; elevation_deg <= 90.0; elevation_deg += 2.0) {
    const double p =
        viewpoint.Towards(DirectionFromAngles(0.5 * kPi, elevation_deg * kRadiansPerDegree), kL1_m)
            .probability;
    EXPECT_GE(p, last - 0.03);
    last = p;
  }
  EXPECT_EQ(last, 1.0);
}

TEST(SightChance, SurvivesNumbersWithoutMeaning) {
  const BuildingScene scene = SceneOf(Town(65, 6));
  UncertainViewpoint viewpoint(&scene);
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  for (const double bad : {1e300, -1e300, 1e9, -1.0}) {
    viewpoint.Stand({0, 0, 1}, bad * unit);
    const double p = viewpoint.Towards({0, 0.8, 0.6}, kL1_m).probability;
    EXPECT_TRUE(p >= 0.0 && p <= 1.0);
    viewpoint.Stand({bad, 0, 1}, unit);
    const double q = viewpoint.To({0, 0, 100}, bad, 0.1).probability;
    EXPECT_TRUE(q >= 0.0 && q <= 1.0);
  }
}

}  // namespace
}  // namespace lodemark
