#include "core/sightline/sight_volume.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/sightline/fresnel_zone.h"
#include "test/unit/sightline/town.h"

namespace lodemark {
namespace {

constexpr double kL1_m = 0.190293672798;  // wavelength of GPS L1

SightVolume LineTo(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  SightVolume volume;
  volume.path = SightPath::To(from, to);
  volume.cut_m = volume.path.length_m;
  return volume;
}

// Near the surface both answers are right; which pairs are near, the exact clip of prisms that are
// a little larger and a little smaller tells.
TEST(SightVolume, LibccdAgreesWithTheExactClipOn100000Pairs) {
  Random random(51);
  int met = 0;
  int missed = 0;
  int near = 0;
  constexpr double kNear_m = 1e-5;
  for (int round = 0; round < 100'000; ++round) {
    const BuildingPrism prism = RandomPrism(&random, 0, {0, 0});
    BuildingPrism larger = prism;
    BuildingPrism smaller = prism;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const auto& corner : prism.footprint) {
      middle += corner / static_cast<double>(prism.footprint.size());
    }
    for (std::size_t i = 0; i < prism.footprint.size(); ++i) {
      larger.footprint[i] += kNear_m * (prism.footprint[i] - middle);
      smaller.footprint[i] -= kNear_m * (prism.footprint[i] - middle);
    }
    larger.base_m -= kNear_m;
    larger.top_m += kNear_m;
    smaller.base_m += kNear_m;
    smaller.top_m -= kNear_m;
    Eigen::Vector3d from;
    Eigen::Vector3d to;
    for (double& value : from) value = random.Uniform(-40.0, 40.0);
    for (double& value : to) value = random.Uniform(-40.0, 40.0);
    const SightVolume line = LineTo(from, to);
    const bool free_of_larger = SceneOf({larger}).IsFree(line.path);
    const bool free_of_smaller = SceneOf({smaller}).IsFree(line.path);
    if (free_of_larger != free_of_smaller) {
      ++near;
      continue;
    }
    const BuildingScene scene = SceneOf({prism});
    ASSERT_EQ(Meets(line, scene, 0), !free_of_larger) << "round " << round;
    ++(free_of_larger ? missed : met);
  }
  EXPECT_GT(met, 10'000);
  EXPECT_GT(missed, 20'000);
  EXPECT_LT(near, 50);
}

// The support function against many points of the body, made as the body is defined.
TEST(SightVolume, SupportsTheBodyThatItSays) {
  Random random(52);
  for (int round = 0; round < 200; ++round) {
    SightVolume volume;
    Eigen::Vector3d from;
    Eigen::Vector3d to;
    for (double& value : from) value = random.Uniform(-50.0, 50.0);
    for (double& value : to) value = random.Uniform(-50.0, 50.0);
    const bool to_point = round % 2 == 0;
    volume.path =
        to_point ? SightPath::To(from, to) : SightPath::Towards(from, (to - from).normalized());
    volume.cut_m = to_point ? random.Uniform(0.5, 1.0) * volume.path.length_m : 120.0;
    volume.wavelength_m = kL1_m;
    for (double& value : volume.receiver_root_m.reshaped()) value = random.Gaussian(0.0, 2.0);
    Eigen::Vector3d direction;
    for (double& value : direction) value = random.Gaussian();
    direction.normalize();
    const double reach_m = direction.dot(volume.Support(direction));
    double best_m = -1e9;
    const Eigen::Vector3d across = volume.path.direction.unitOrthogonal();
    const Eigen::Vector3d other = volume.path.direction.cross(across);
    for (int i = 0; i < 20'000; ++i) {
      const double at_m = random.Uniform() * volume.cut_m;
      Eigen::Vector3d ball;
      for (double& value : ball) value = random.Gaussian();
      ball.normalize();
      const double share = to_point ? 1.0 - at_m / volume.path.length_m : 1.0;
      const double angle_rad = random.Uniform(0.0, 2.0 * kPi);
      const double radius_m = FirstFresnelRadius(kL1_m, at_m, volume.path.length_m);
      const Eigen::Vector3d point =
          volume.path.At(at_m) + share * (volume.receiver_root_m * ball) +
          radius_m * (std::cos(angle_rad) * across + std::sin(angle_rad) * other);
      best_m = std::max(best_m, direction.dot(point));
      EXPECT_LE((point - volume.path.At(at_m)).norm(), volume.LargestRadius() + 1e-9);
    }
    EXPECT_LE(best_m, reach_m + 1e-9);
    EXPECT_GE(best_m, reach_m - 3.0);
  }
}

TEST(SightVolume, TheFresnelZoneHasTheSizeOfTheHandbook) {
  // ITU-R P.526-15 (3): 550 sqrt(d1 d2 / ((d1 + d2) f)) m, with km and MHz.
  EXPECT_NEAR(FirstFresnelRadius(299'792'458.0 / 1e9, 4'000.0, 10'000.0),
              550.0 * std::sqrt(4.0 * 6.0 / (10.0 * 1000.0)), 0.15);
  EXPECT_EQ(FirstFresnelRadius(kL1_m, 0.0, 100.0), 0.0);
  EXPECT_EQ(FirstFresnelRadius(kL1_m, 100.0, 100.0), 0.0);
  EXPECT_NEAR(FirstFresnelRadius(kL1_m, 50.0, std::numeric_limits<double>::infinity()),
              std::sqrt(50.0 * kL1_m), 1e-12);
}

TEST(SightVolume, TouchesAWallAtItsRadius) {
  SightVolume volume = LineTo({0, 0, 10}, {100, 0, 10});
  volume.wavelength_m = kL1_m;
  // At its middle the zone is widest.
  const double radius_m = FirstFresnelRadius(kL1_m, 50.0, 100.0);
  const auto wall_at = [](double north_m) {
    return SceneOf({Block(0, {49.5, north_m, 0}, {50.5, north_m + 5, 30})});
  };
  EXPECT_TRUE(IsFree(volume, wall_at(radius_m + 0.01)));
  EXPECT_FALSE(IsFree(volume, wall_at(radius_m - 0.01)));

  volume.wavelength_m = 0.0;
  volume.receiver_root_m = Eigen::Vector3d(1.0, 6.0, 1.0).asDiagonal();
  // Halfway to a point the ellipsoid has shrunk by half; at the wall's near corner a little less.
  EXPECT_TRUE(IsFree(volume, wall_at(0.505 * 6.0 + 0.02)));
  EXPECT_FALSE(IsFree(volume, wall_at(0.505 * 6.0 - 0.02)));
}

TEST(SightVolume, ReachesARoofThatMayBeHigher) {
  const BuildingScene scene = SceneOf({Block(0, {40, -9, 0}, {60, 9, 8}, 1.5)});
  const SightVolume volume = LineTo({0, 0, 10}, {100, 0, 10});
  EXPECT_TRUE(IsFree(volume, scene));
  EXPECT_TRUE(IsFree(volume, scene, 1.3));
  EXPECT_FALSE(IsFree(volume, scene, 1.4));
}

}  // namespace
}  // namespace lodemark
