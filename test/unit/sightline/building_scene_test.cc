#include "core/sightline/building_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "test/unit/sightline/town.h"

namespace lodemark {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// By the prism's own definition: between base and roof, and left of every edge.
bool Holds(const BuildingPrism& prism, const Eigen::Vector3d& point) {
  if (point.z() < prism.base_m || point.z() > prism.top_m) return false;
  for (std::size_t i = 0; i < prism.footprint.size(); ++i) {
    const Eigen::Vector2d edge =
        prism.footprint[(i + 1) % prism.footprint.size()] - prism.footprint[i];
    const Eigen::Vector2d to_point = point.head<2>() - prism.footprint[i];
    if (edge.x() * to_point.y() - edge.y() * to_point.x() < 0.0) return false;
  }
  return true;
}

TEST(BuildingScene, AWallHidesWhatIsBehindIt) {
  const BuildingScene scene = SceneOf({Block(7, {10, -5, 0}, {12, 5, 20})});
  const Eigen::Vector3d here(0, 0, 1.5);
  EXPECT_FALSE(scene.IsFree(SightPath::To(here, {20, 0, 1.5})));
  EXPECT_TRUE(scene.IsFree(SightPath::To(here, {9, 0, 1.5})));    // before the wall
  EXPECT_TRUE(scene.IsFree(SightPath::To(here, {20, 0, 60})));    // above it
  EXPECT_TRUE(scene.IsFree(SightPath::To(here, {20, 11, 1.5})));  // beside it
  EXPECT_TRUE(scene.IsFree(SightPath::To(here, {-20, 0, 1.5})));  // away from it
  const auto blocker = scene.FirstBlocker(SightPath::To(here, {20, 0, 1.5}));
  ASSERT_TRUE(blocker.has_value());
  EXPECT_EQ(scene.building(blocker->part), 7U);
  EXPECT_NEAR(blocker->distance_m, 10.0, 1e-12);
}

TEST(BuildingScene, ASatelliteRisesAboveTheRoofAtTheAngleOfItsEdge) {
  const BuildingScene scene = SceneOf({Block(0, {10, -50, 0}, {30, 50, 21.5})});
  const Eigen::Vector3d here(0, 0, 1.5);
  const double edge_rad = std::atan2(20.0, 10.0);
  const auto towards = [&](double elevation_rad) {
    return SightPath::Towards(here, DirectionFromAngles(90.0 * kRadiansPerDegree, elevation_rad));
  };
  EXPECT_FALSE(scene.IsFree(towards(edge_rad - 1e-6)));
  EXPECT_TRUE(scene.IsFree(towards(edge_rad + 1e-6)));
  EXPECT_TRUE(scene.IsFree(SightPath::Towards(here, {0, 0, 1})));
}

TEST(BuildingScene, APassageIsOpenBelowItsCeiling) {
  const BuildingScene scene = SceneOf({Block(0, {10, -50, 4}, {30, 50, 20})});
  EXPECT_TRUE(scene.IsFree(SightPath::To({0, 0, 1.5}, {40, 0, 1.5})));
  EXPECT_FALSE(scene.IsFree(SightPath::To({20, 0, 1.5}, {20, 0, 60})));
}

TEST(BuildingScene, WhatStandsOnTheGroundLetsNothingThroughBelow) {
  const BuildingScene scene = SceneOf({Block(0, {10, -50, 0}, {30, 50, 20})});
  EXPECT_FALSE(scene.IsFree(SightPath::To({0, 0, -3}, {40, 0, -3})));
}

TEST(BuildingScene, TouchingIsFreeButNotTheWayAlongAWall) {
  const BuildingScene scene = SceneOf({Block(0, {10, 0, 0}, {20, 10, 10})});
  EXPECT_TRUE(scene.IsFree(SightPath::To({0, 10, 5}, {20, -10, 5})));  // at a corner
  EXPECT_TRUE(scene.IsFree(SightPath::To({0, 5, 5}, {10, 5, 5})));     // up to the wall
  EXPECT_FALSE(scene.IsFree(SightPath::To({15, 5, 5}, {30, 5, 5})));   // from inside
  EXPECT_TRUE(scene.IsFree(SightPath::To({15, 5, 5}, {15, 5, 5})));    // no way at all
  // Else there would be a gap where two parts of a house meet.
  EXPECT_FALSE(scene.IsFree(SightPath::To({0, 0, 5}, {30, 0, 5})));
}

TEST(BuildingScene, AnEmptyOneIsFree) {
  const BuildingScene scene;
  EXPECT_TRUE(scene.IsFree(SightPath::Towards({0, 0, 0}, {1, 0, 0})));
  EXPECT_FALSE(scene.FirstBlocker(SightPath::Towards({0, 0, 0}, {1, 0, 0})).has_value());
  EXPECT_FALSE(scene.IsInside({0, 0, 0}));
}

TEST(BuildingScene, RefusesWhatIsNoPrismAndSaysWhich) {
  const BuildingPrism good = Block(0, {0, 0, 0}, {1, 1, 1});
  const auto message = [&](const BuildingPrism& bad) {
    const auto scene = BuildingScene::Make(std::vector<BuildingPrism>{good, bad});
    return scene.ok() ? std::string("fine") : scene.error().message;
  };
  EXPECT_EQ(message(good), "fine");
  BuildingPrism bad = good;
  std::swap(bad.footprint[0], bad.footprint[1]);
  EXPECT_THAT(message(bad), HasSubstr("building part 1: the footprint is not convex"));
  bad = good;
  bad.top_m = bad.base_m;
  EXPECT_THAT(message(bad), HasSubstr("roof is not above"));
  bad = good;
  bad.base_m = NAN;
  EXPECT_THAT(message(bad), HasSubstr("not finite"));
  bad = good;
  bad.footprint[2].x() = kInfinite;
  EXPECT_THAT(message(bad), HasSubstr("corner is not finite"));
  bad = good;
  bad.top_sigma_m = -1.0;
  EXPECT_THAT(message(bad), HasSubstr("sigma"));
  bad.footprint.clear();
  EXPECT_THAT(message(bad), HasSubstr("sigma"));
}

// The chord's middle is inside, and just beyond its ends is outside, by the definition of a prism.
TEST(BuildingScene, ClipsLinesAsPointsTell) {
  Random random(41);
  int hits = 0;
  for (int round = 0; round < 20'000; ++round) {
    const BuildingPrism prism = RandomPrism(&random, 0, {0, 0});
    const BuildingScene scene = SceneOf({prism});
    Eigen::Vector3d from;
    Eigen::Vector3d to;
    for (double& value : from) value = random.Uniform(-25.0, 25.0);
    for (double& value : to) value = random.Uniform(-25.0, 25.0);
    const SightPath path = SightPath::To(from, to);
    const Chord chord = scene.ClipLine(0, from, path.direction);
    if (chord.exit_m - chord.enter_m < 1e-3) {
      for (double share = -1.0; share <= 2.0; share += 0.05) {
        const Eigen::Vector3d point = path.At(share * path.length_m);
        // A chord shorter than a millimetre can lie between.
        if (Holds(prism, point)) ADD_FAILURE() << "missed a prism in round " << round;
      }
      continue;
    }
    ++hits;
    EXPECT_TRUE(Holds(prism, path.At(0.5 * (chord.enter_m + chord.exit_m))));
    EXPECT_TRUE(Holds(prism, path.At(chord.enter_m + 1e-4)));
    EXPECT_TRUE(Holds(prism, path.At(chord.exit_m - 1e-4)));
    EXPECT_FALSE(Holds(prism, path.At(chord.enter_m - 1e-4)));
    EXPECT_FALSE(Holds(prism, path.At(chord.exit_m + 1e-4)));
  }
  EXPECT_GT(hits, 4'000);
}

TEST(BuildingScene, TheTreeFindsWhatLookingAtEachPartFinds) {
  Random random(42);
  std::vector<BuildingPrism> parts;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const double east_m = random.Uniform(-150.0, 150.0);
    parts.push_back(RandomPrism(&random, i, {east_m, random.Uniform(-150.0, 150.0)}));
  }
  const BuildingScene scene = SceneOf(parts);
  int blocked = 0;
  for (int round = 0; round < 5'000; ++round) {
    Eigen::Vector3d from;
    for (double& value : from) value = random.Uniform(-150.0, 150.0);
    from.z() = 0.1 * from.z();
    const double azimuth_rad = random.Uniform(0.0, 2.0 * kPi);
    // Straight up and along the axes too, where components are zero.
    Eigen::Vector3d direction = DirectionFromAngles(azimuth_rad, random.Uniform(-0.1, 1.0));
    if (round % 10 == 0) direction = Eigen::Vector3d::Unit(round / 10 % 3);
    SightPath path = SightPath::Towards(from, direction);
    if (round % 3 == 0) path.length_m = random.Uniform(0.0, 100.0);
    std::optional<Blocker> first;
    bool inside = false;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      inside = inside || Holds(parts[part], from);
      const Chord chord = scene.ClipLine(part, from, path.direction);
      const double enter_m = std::max(chord.enter_m, 0.0);
      if (std::min(chord.exit_m, path.length_m) - enter_m <= 1e-6) continue;
      if (!first || enter_m < first->distance_m) first = Blocker{part, enter_m};
    }
    EXPECT_EQ(scene.IsFree(path), !first.has_value());
    EXPECT_EQ(scene.IsInside(from), inside);
    const auto found = scene.FirstBlocker(path);
    ASSERT_EQ(found.has_value(), first.has_value());
    if (!first) continue;
    ++blocked;
    EXPECT_EQ(found->part, first->part);
    EXPECT_EQ(found->distance_m, first->distance_m);
  }
  EXPECT_GT(blocked, 1'000);
}

TEST(BuildingScene, DoesNotDependOnTheOrderOfItsParts) {
  std::vector<BuildingPrism> parts = Town(43, 12);
  const BuildingScene one = SceneOf(parts);
  std::reverse(parts.begin(), parts.end());
  const BuildingScene other = SceneOf(parts);
  Random random(44);
  for (int round = 0; round < 2'000; ++round) {
    const double azimuth_rad = random.Uniform(0.0, 2.0 * kPi);
    const SightPath path = SightPath::Towards(
        {0.0, 0.0, 1.5}, DirectionFromAngles(azimuth_rad, random.Uniform(0.0, 1.5)));
    const auto a = one.FirstBlocker(path);
    const auto b = other.FirstBlocker(path);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    EXPECT_EQ(one.building(a->part), other.building(b->part));
  }
}

TEST(BuildingScene, SurvivesNumbersWithoutMeaning) {
  const BuildingScene scene = SceneOf(Town(45, 6));
  for (const double bad : {std::nan(""), kInfinite, -kInfinite, 1e300, -1e300}) {
    static_cast<void>(scene.IsFree(SightPath::To({bad, 0, 0}, {0, 0, 0})));
    static_cast<void>(scene.IsFree(SightPath::Towards({0, 0, 0}, {bad, 0, 1})));
    static_cast<void>(scene.FirstBlocker(SightPath::To({0, 0, 0}, {0, bad, 0})));
    static_cast<void>(scene.IsInside({0, 0, bad}));
  }
}

}  // namespace
}  // namespace lodemark
