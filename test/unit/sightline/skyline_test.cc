#include "core/sightline/skyline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/unit/sightline/town.h"

namespace lodemark {
namespace {

TEST(Skyline, IsTheAngleOfTheRoofInTheTextbook) {
  const BuildingScene scene = SceneOf({Block(0, {10, -5, 0}, {20, 5, 11.5})});
  EXPECT_NEAR(SkylineElevation(scene, {0, 0, 1.5}, 0.5 * kPi), std::atan2(10.0, 10.0), 1e-12);
  EXPECT_EQ(SkylineElevation(scene, {0, 0, 1.5}, 0.0), 0.0);
  EXPECT_EQ(SkylineElevation(scene, {0, 0, 1.5}, -0.5 * kPi), 0.0);
  EXPECT_EQ(SkylineElevation(scene, {0, 0, 15}, 0.5 * kPi), 0.0);             // from above
  EXPECT_NEAR(SkylineElevation(scene, {15, 0, 1.5}, 1.0), 0.5 * kPi, 1e-12);  // from within
}

// Just above the skyline the path is free, just below the top of the building it is not.
TEST(Skyline, PartsFreePathsFromBlockedOnes) {
  const BuildingScene scene = SceneOf(Town(81, 14));
  const Eigen::Vector3d here(3.0, -2.0, 1.5);
  int walls = 0;
  for (double azimuth_rad = 0.003; azimuth_rad < 2.0 * kPi; azimuth_rad += 0.01) {
    const double elevation_rad = SkylineElevation(scene, here, azimuth_rad);
    const auto towards = [&](double rad) {
      return SightPath::Towards(here, DirectionFromAngles(azimuth_rad, rad));
    };
    EXPECT_TRUE(scene.IsFree(towards(elevation_rad + 1e-6)));
    if (elevation_rad <= 0.0) continue;
    ++walls;
    EXPECT_FALSE(scene.IsFree(towards(elevation_rad - 1e-4)));
  }
  EXPECT_GT(walls, 500);
}

}  // namespace
}  // namespace lodemark
