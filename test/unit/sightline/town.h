// Made-up buildings for tests of sight lines.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/sightline/building_scene.h"

namespace lodemark {

// Walls along the axes, from one corner to the opposite one.
inline BuildingPrism Block(std::uint32_t building, const Eigen::Vector3d& least,
                           const Eigen::Vector3d& greatest, double top_sigma_m = 0.0) {
  return {building,
          {{least.x(), least.y()},
           {greatest.x(), least.y()},
           {greatest.x(), greatest.y()},
           {least.x(), greatest.y()}},
          least.z(),
          greatest.z(),
          top_sigma_m,
          least.z() > 0.0};
}

// Corners on an ellipse, turned: convex, of 3 to 8 corners.
inline BuildingPrism RandomPrism(Random* random, std::uint32_t building,
                                 const Eigen::Vector2d& middle) {
  BuildingPrism prism;
  prism.building = building;
  const double corners = 3.0 + static_cast<double>(random->Index(6));
  const double length_m = random->Uniform(3.0, 20.0);
  const double width_m = random->Uniform(3.0, 20.0);
  const double turn_rad = random->Uniform(0.0, 2.0 * kPi);
  for (double i = 0.0; i < corners; ++i) {
    const double angle_rad = 2.0 * kPi * (i + random->Uniform(0.0, 0.8)) / corners;
    const Eigen::Vector2d corner(length_m * std::cos(angle_rad), width_m * std::sin(angle_rad));
    prism.footprint.emplace_back(
        middle.x() + std::cos(turn_rad) * corner.x() - std::sin(turn_rad) * corner.y(),
        middle.y() + std::sin(turn_rad) * corner.x() + std::cos(turn_rad) * corner.y());
  }
  prism.base_m = random->Uniform(-2.0, 3.0);
  prism.top_m = prism.base_m + random->Uniform(2.0, 30.0);
  prism.raised = true;
  return prism;
}

// Blocks between streets, side x side of them, the middle of the town at the origin.
inline std::vector<BuildingPrism> Town(std::uint64_t seed, int side, double block_m = 24.0,
                                       double street_m = 16.0) {
  Random random(seed);
  std::vector<BuildingPrism> town;
  const double step_m = block_m + street_m;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double east_m = (column - 0.5 * side) * step_m + 0.5 * street_m;
      const double north_m = (row - 0.5 * side) * step_m + 0.5 * street_m;
      const double top_m = random.Uniform(8.0, 40.0);
      town.push_back(Block(static_cast<std::uint32_t>(town.size()), {east_m, north_m, 0.0},
                           {east_m + block_m, north_m + block_m, top_m}, 2.0));
    }
  }
  return town;
}

inline BuildingScene SceneOf(const std::vector<BuildingPrism>& parts) {
  Result<BuildingScene> scene = BuildingScene::Make(parts);
  EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
  return scene.ok() ? *std::move(scene) : BuildingScene();
}

}  // namespace lodemark
