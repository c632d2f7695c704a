#include "core/sightline/ground.h"

#include <gtest/gtest.h>

#include <vector>

namespace lodemark {
namespace {

BuildingPrism House(double west_m, double base_m, bool raised) {
  BuildingPrism house;
  house.footprint = {{west_m, 0.0}, {west_m + 10.0, 0.0}, {west_m + 10.0, 10.0}, {west_m, 10.0}};
  house.base_m = base_m;
  house.top_m = base_m + 20.0;
  house.raised = raised;
  return house;
}

TEST(NotBelowGround, TakesThatOfTheNearestHouse) {
  const std::vector<BuildingPrism> houses = {House(10.0, 5.0, false), House(300.0, -40.0, false)};
  const BuildingScene scene = *BuildingScene::Make(houses);
  EXPECT_EQ(NotBelowGround(scene, {0.0, 0.0, -8.0}), Eigen::Vector3d(0.0, 0.0, 5.0));
  EXPECT_EQ(NotBelowGround(scene, {0.0, 0.0, 6.5}), Eigen::Vector3d(0.0, 0.0, 6.5));
  EXPECT_EQ(NotBelowGround(scene, {280.0, 0.0, -8.0}), Eigen::Vector3d(280.0, 0.0, -8.0));
}

TEST(NotBelowGround, AsksNoBridge) {
  const std::vector<BuildingPrism> houses = {House(1.0, 12.0, true), House(30.0, 2.0, false)};
  const BuildingScene scene = *BuildingScene::Make(houses);
  EXPECT_EQ(NotBelowGround(scene, {0.0, 0.0, 0.0}).z(), 2.0);
}

TEST(NotBelowGround, LeavesOpenCountryAlone) {
  EXPECT_EQ(NotBelowGround(BuildingScene(), {1.0, 2.0, -300.0}), Eigen::Vector3d(1.0, 2.0, -300.0));
}

}  // namespace
}  // namespace lodemark
