#include "core/sightline/reflection.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "test/unit/sightline/town.h"

namespace lodemark {
namespace {

// The wall of the first part that faces west, number 3 of a Block.
constexpr std::size_t kWest = 3;

TEST(Reflection, IsTheMirrorImageOfTheTextbook) {
  // The wall is 10 m east, the satellite due west at 40 degrees: 2 * 10 m * cos 40.
  const BuildingScene scene = SceneOf({Block(0, {10, -20, 0}, {20, 20, 30})});
  const double elevation_rad = 40.0 * kRadiansPerDegree;
  const SightPath path =
      SightPath::Towards({0, 0, 1.5}, DirectionFromAngles(-0.5 * kPi, elevation_rad));
  const auto reflection = ReflectionOff(scene, path, 0, kWest);
  ASSERT_TRUE(reflection.has_value());
  EXPECT_NEAR(reflection->extra_path_m, 20.0 * std::cos(elevation_rad), 1e-9);
  EXPECT_NEAR(reflection->point_in_enu_m.x(), 10.0, 1e-9);
  EXPECT_NEAR(reflection->point_in_enu_m.z(), 1.5 + 10.0 * std::tan(elevation_rad), 1e-9);
  EXPECT_NEAR(reflection->incidence_rad, elevation_rad, 1e-9);
}

TEST(Reflection, NeedsAWallWhereTheSignalMeetsIt) {
  const SightPath path =
      SightPath::Towards({0, 0, 1.5}, DirectionFromAngles(-0.5 * kPi, 40.0 * kRadiansPerDegree));
  // It meets the plane 9.9 m up.
  EXPECT_FALSE(ReflectionOff(SceneOf({Block(0, {10, -20, 0}, {20, 20, 9.8})}), path, 0, kWest));
  EXPECT_TRUE(ReflectionOff(SceneOf({Block(0, {10, -20, 0}, {20, 20, 10})}), path, 0, kWest));
  EXPECT_FALSE(ReflectionOff(SceneOf({Block(0, {10, -20, 10}, {20, 20, 30})}), path, 0, kWest));
  EXPECT_FALSE(ReflectionOff(SceneOf({Block(0, {10, 1, 0}, {20, 20, 30})}), path, 0, kWest));
  // Off the walls that face away, or whose front the satellite does not see, there is none.
  const BuildingScene scene = SceneOf({Block(0, {10, -20, 0}, {20, 20, 30})});
  for (std::size_t wall = 0; wall < 3; ++wall) EXPECT_FALSE(ReflectionOff(scene, path, 0, wall));
  const SightPath from_behind =
      SightPath::Towards({0, 0, 1.5}, DirectionFromAngles(0.5 * kPi, 1.0));
  EXPECT_FALSE(ReflectionOff(scene, from_behind, 0, kWest));
}

TEST(Reflection, IsBlockedByWhatStandsBeforeOrAfter) {
  const SightPath path =
      SightPath::Towards({0, 0, 1.5}, DirectionFromAngles(-0.5 * kPi, 40.0 * kRadiansPerDegree));
  const BuildingPrism wall = Block(0, {10, -20, 0}, {20, 20, 30});
  EXPECT_FALSE(ReflectionOff(SceneOf({wall, Block(1, {5, -1, 0}, {6, 1, 8})}), path, 0, kWest));
  EXPECT_TRUE(ReflectionOff(SceneOf({wall, Block(1, {5, -1, 0}, {6, 1, 4})}), path, 0, kWest));
  // A tower in the west that the incoming signal has to pass; the straight path passes it too.
  EXPECT_FALSE(
      ReflectionOff(SceneOf({wall, Block(1, {-30, -5, 0}, {-20, 5, 60})}), path, 0, kWest));
}

// Angle in equals angle out, the way is the shortest over the wall, and both ways have the length
// that is said; over random walls and ends.
TEST(Reflection, ObeysFermatAndTheLawOfReflection) {
  Random random(71);
  int found = 0;
  for (int round = 0; round < 300'000 && found < 500; ++round) {
    const BuildingPrism prism = RandomPrism(&random, 0, {0, 0});
    const BuildingScene scene = SceneOf({prism});
    Eigen::Vector3d near;
    Eigen::Vector3d far;
    for (double& value : near) value = random.Uniform(-60.0, 60.0);
    for (double& value : far) value = random.Uniform(-60.0, 60.0);
    const std::size_t wall = random.Index(prism.footprint.size());
    const SightPath path = SightPath::To(near, far);
    const auto reflection = ReflectionOff(scene, path, 0, wall);
    if (!reflection) continue;
    ++found;
    const Eigen::Vector3d& point = reflection->point_in_enu_m;
    const auto length = [&](const Eigen::Vector3d& over) {
      return (near - over).norm() + (over - far).norm();
    };
    EXPECT_NEAR(reflection->extra_path_m, length(point) - path.length_m, 1e-9);
    const Eigen::Vector2d edge =
        prism.footprint[(wall + 1) % prism.footprint.size()] - prism.footprint[wall];
    const Eigen::Vector3d along = Eigen::Vector3d(edge.x(), edge.y(), 0.0).normalized();
    for (const Eigen::Vector3d& shift : {along, Eigen::Vector3d(0, 0, 1)}) {
      EXPECT_GE(length(point + 1e-3 * shift), length(point));
      EXPECT_GE(length(point - 1e-3 * shift), length(point));
    }
    const Eigen::Vector3d normal(along.y(), -along.x(), 0.0);
    const Eigen::Vector3d in = (point - near).normalized();
    const Eigen::Vector3d out = (far - point).normalized();
    EXPECT_LT((out - (in - 2.0 * in.dot(normal) * normal)).norm(), 1e-9);
    EXPECT_NEAR(std::cos(reflection->incidence_rad), out.dot(normal), 1e-9);
  }
  EXPECT_EQ(found, 500);
}

TEST(Reflection, OfASatelliteIsThatOfAVeryFarPoint) {
  const BuildingScene scene = SceneOf({Block(0, {10, -20, 0}, {20, 20, 30})});
  const Eigen::Vector3d here(1, 2, 1.5);
  const Eigen::Vector3d direction = DirectionFromAngles(-1.2, 0.6);
  const auto at_infinity = ReflectionOff(scene, SightPath::Towards(here, direction), 0, kWest);
  const auto far = ReflectionOff(scene, SightPath::To(here, here + 2e7 * direction), 0, kWest);
  ASSERT_TRUE(at_infinity && far);
  EXPECT_NEAR(at_infinity->extra_path_m, far->extra_path_m, 1e-4);
  EXPECT_LT((at_infinity->point_in_enu_m - far->point_in_enu_m).norm(), 1e-4);
}

TEST(Reflection, FindsAllOfAStreetInOrder) {
  const BuildingScene scene = SceneOf(Town(72, 10));
  Random random(73);
  std::size_t most = 0;
  for (int round = 0; round < 200; ++round) {
    const double azimuth_rad = random.Uniform(0.0, 2.0 * kPi);
    const SightPath path =
        SightPath::Towards({random.Uniform(-60.0, 60.0), 0, 1.5},
                           DirectionFromAngles(azimuth_rad, random.Uniform(0.2, 1.4)));
    std::array<Reflection, 16> out;
    const std::size_t count = FindReflections(scene, path, 300.0, out);
    std::size_t expected = 0;
    for (std::size_t part = 0; part < scene.part_count(); ++part) {
      for (std::size_t wall = 0; wall < 4; ++wall) {
        if (ReflectionOff(scene, path, part, wall)) ++expected;
      }
    }
    EXPECT_EQ(count, expected);
    for (std::size_t i = 1; i < count; ++i) {
      EXPECT_LE(out[i - 1].extra_path_m, out[i].extra_path_m);
    }
    // With room for one, it is the shortest.
    std::array<Reflection, 1> one;
    EXPECT_EQ(FindReflections(scene, path, 300.0, one), std::min<std::size_t>(count, 1));
    most = std::max(most, count);
    if (count == 0) continue;
    EXPECT_EQ(one[0].extra_path_m, out[0].extra_path_m);
  }
  EXPECT_GT(most, 1U);
}

}  // namespace
}  // namespace lodemark
