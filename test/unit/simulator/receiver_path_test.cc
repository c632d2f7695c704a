#include "tools/simulator/receiver_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

TEST(ReceiverPath, StandsWithoutWaypoints) {
  const ReceiverPath path(*PresetScenario("static"));
  EXPECT_EQ(path.At(57.0).position_in_enu.norm(), 0.0);
  EXPECT_EQ(path.At(57.0).velocity_in_enu.norm(), 0.0);
}

TEST(ReceiverPath, MovesAsItsVelocitySays) {
  const ReceiverPath path(*PresetScenario("walk"));
  constexpr double kStep_s = 1e-4;
  for (double time_s = 0.5; time_s < 250.0; time_s += 0.37) {
    const Eigen::Vector3d difference =
        (path.At(time_s + kStep_s).position_in_enu - path.At(time_s - kStep_s).position_in_enu) /
        (2.0 * kStep_s);
    EXPECT_LT((difference - path.At(time_s).velocity_in_enu).norm(), 2e-3) << time_s;
  }
}

TEST(ReceiverPath, TurnsAsItsTurnRateSays) {
  const ReceiverPath path(*PresetScenario("walk"));
  constexpr double kStep_s = 1e-4;
  for (double time_s = 6.0; time_s < 200.0; time_s += 0.41) {
    const double rate =
        (path.At(time_s + kStep_s).heading_rad - path.At(time_s - kStep_s).heading_rad) /
        (2.0 * kStep_s);
    const double told = path.At(time_s).turn_rate_radps;
    // At the ends of an arc the rate steps.
    const double before = path.At(time_s - kStep_s).turn_rate_radps;
    const double after = path.At(time_s + kStep_s).turn_rate_radps;
    if (std::abs(before - after) > 1e-3) continue;
    EXPECT_NEAR(rate, told, 1e-3) << time_s;
  }
}

TEST(ReceiverPath, KeepsItsSpeedAndEndsAtTheLastCorner) {
  const Scenario scenario = *PresetScenario("walk");
  const ReceiverPath path(scenario);
  double fastest_mps = 0.0;
  for (double time_s = 0.0; time_s < 400.0; time_s += 0.1) {
    fastest_mps = std::max(fastest_mps, path.At(time_s).velocity_in_enu.head<2>().norm());
  }
  EXPECT_NEAR(fastest_mps, scenario.speed_mps, 1e-9);
  const Eigen::Vector3d end = path.At(1e4).position_in_enu;
  EXPECT_NEAR(end.x(), scenario.waypoints_m.back()[0], 1e-6);
  EXPECT_NEAR(end.y(), scenario.waypoints_m.back()[1], 1e-6);
  EXPECT_EQ(path.At(1e4).velocity_in_enu.norm(), 0.0);
}

TEST(ReceiverPath, SurvivesCornersThatTurnBackOrRepeat) {
  Scenario scenario = *PresetScenario("walk");
  scenario.waypoints_m = {{0, 0}, {0, 0}, {10, 0}, {0, 0}, {0, 0}, {0, 5}};
  const ReceiverPath path(scenario);
  for (double time_s = 0.0; time_s < 60.0; time_s += 0.1) {
    EXPECT_TRUE(path.At(time_s).position_in_enu.allFinite());
    EXPECT_LT(path.At(time_s).position_in_enu.norm(), 20.0);
  }
}

}  // namespace
}  // namespace lodemark
