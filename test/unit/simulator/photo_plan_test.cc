#include "tools/simulator/photo_plan.h"

#include <gtest/gtest.h>

#include "core/base/units.h"

namespace lodemark {
namespace {

TEST(CameraFromEnu, LooksWhereTheHeadingPoints) {
  const Rigid3 pose = CameraFromEnu({3.0, 4.0, 2.0}, {0.5 * kPi, 0.0, 0.0});
  // Ten metres to the east and a metre below: ahead, one down; to the south is right.
  EXPECT_LT((pose * Eigen::Vector3d(13, 4, 1) - Eigen::Vector3d(0, 1, 10)).norm(), 1e-12);
  EXPECT_LT((pose * Eigen::Vector3d(3, 3, 2) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(CameraFromEnu, TiltsUpAndRollsClockwise) {
  const Rigid3 tilted = CameraFromEnu(Eigen::Vector3d::Zero(), {0.0, 0.1, 0.0});
  EXPECT_GT((tilted * Eigen::Vector3d(0, 10, 0)).y(), 0.9);  // the horizon sinks
  const Rigid3 rolled = CameraFromEnu(Eigen::Vector3d::Zero(), {0.0, 0.0, 0.1});
  const Eigen::Vector3d up = rolled * Eigen::Vector3d(0, 10, 1);
  EXPECT_LT(up.x(), -0.05);  // what is above leans to the left
}

TEST(PlanPhotos, TakesFramesWhereThePhoneIs) {
  Scenario scenario = *PresetScenario("static");
  scenario.waypoints_m = {{0, 0}, {30, 0}, {30, 30}};
  scenario.stop_s = 10.0;
  scenario.rise_m = 0.0;
  scenario.phone_height_m = 1.5;
  PhotoGroup group;
  FrameSeries late{200.0, 1.0, false, {CameraHold{}}};
  FrameSeries early{1.0, 35.0, false, {CameraHold{}, CameraHold{}}};
  group.frames = {late, early};
  const std::vector<PlannedPhoto> photos = PlanPhotos(scenario, group);
  ASSERT_EQ(photos.size(), 3u);
  EXPECT_LT((photos[0].centre_m() - Eigen::Vector3d(0, 0, 1.5)).norm(), 1e-9);
  EXPECT_LT((photos[1].centre_m() - Eigen::Vector3d(30, 0, 1.5)).norm(), 1e-9);  // stopped
  EXPECT_LT((photos[2].centre_m() - Eigen::Vector3d(30, 30, 1.5)).norm(), 1e-9);
  EXPECT_EQ(*photos[1].time_gps_ns - *photos[0].time_gps_ns, 35'000'000'000);
  EXPECT_EQ(photos[0].name, "0001.jpg");
  EXPECT_NE(photos[0].seed, photos[1].seed);
}

}  // namespace
}  // namespace lodemark
