#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/resection/minimal_solvers.h"
#include "test/unit/resection/random_scenes.h"

namespace lodemark {
namespace {

constexpr int kScenes = 5'000;
constexpr double kDegree_rad = 0.017453292519943295;

struct LevelScene : Scene<2> {
  Eigen::Vector3d up_in_camera;
  Eigen::Vector3d up_in_world;
};

// Up is any direction of the world: its axes need not be level.
template <typename MakePoint>
LevelScene RandomLevelScene(MakePoint make, double spread_m, Random& random) {
  LevelScene scene;
  std::array<Eigen::Vector3d, 2> points;
  for (Eigen::Vector3d& point : points) point = make(random);
  static_cast<Scene<2>&>(scene) = SceneOf(points, spread_m, random);
  scene.up_in_world = RandomVector(random).normalized();
  scene.up_in_camera = scene.camera_from_world.rotation() * scene.up_in_world;
  return scene;
}

PoseSet<2> Solve(const LevelScene& scene) {
  return PoseFromTwoPointsAndGravity(scene.bearings, scene.points_in_world, scene.up_in_camera,
                                     scene.up_in_world);
}

Eigen::Vector3d Tilted(const Eigen::Vector3d& direction, double sigma_rad, Random& random) {
  const Eigen::Vector3d turn = sigma_rad * RandomVector(random);
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()) * direction;
}

TEST(PoseFromTwoPointsAndGravity, FindsThePoseOfEveryScene) {
  Random random(1);
  int missed = 0;
  for (int i = 0; i < 10 * kScenes; ++i) {
    const LevelScene scene = i % 2 == 0 ? RandomLevelScene(PointInFront, 30.0, random)
                                        : RandomLevelScene(PointAround, 30.0, random);
    const double error = scene.BestErrorOf(Solve(scene));
    ASSERT_LT(error, 1e-4) << "scene " << i;
    if (error > 1e-8) ++missed;  // near a double solution
  }
  EXPECT_LE(missed, 5);
}

TEST(PoseFromTwoPointsAndGravity, GivesOnlyPosesThatMeetBearingsAndVertical) {
  Random random(2);
  for (int i = 0; i < kScenes; ++i) {
    const LevelScene scene = RandomLevelScene(PointAround, 30.0, random);
    for (const Rigid3& pose : Solve(scene)) {
      ASSERT_LT(scene.BearingErrorOf(pose), 1e-8);
      ASSERT_LT((pose.rotation() * scene.up_in_world - scene.up_in_camera).norm(), 1e-12);
    }
  }
}

TEST(PoseFromTwoPointsAndGravity, HoldsAtTheEarthsRadiusFromTheOrigin) {
  Random random(3);
  for (int i = 0; i < kScenes; ++i) {
    const LevelScene scene = RandomLevelScene(PointInFront, 4.0e6, random);
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-4) << "scene " << i;
  }
}

TEST(PoseFromTwoPointsAndGravity, HoldsForPointsCloseTogetherFarAway) {
  Random random(4);
  for (int i = 0; i < kScenes; ++i) {
    const auto far_away = [](Random& numbers) -> Eigen::Vector3d {
      return RandomVector(numbers) + Eigen::Vector3d(0.0, 0.0, 1.0e5);
    };
    const LevelScene scene = RandomLevelScene(far_away, 0.0, random);
    ASSERT_LT(scene.BestErrorOf(Solve(scene)), 1e-4) << "scene " << i;
  }
}

TEST(PoseFromTwoPointsAndGravity, DoesNotDependOnOrderOrUnit) {
  Random random(5);
  for (int i = 0; i < kScenes; ++i) {
    const LevelScene scene = RandomLevelScene(PointInFront, 30.0, random);
    const PoseSet<2> poses = Solve(scene);
    LevelScene swapped = scene;
    std::swap(swapped.bearings[0], swapped.bearings[1]);
    std::swap(swapped.points_in_world[0], swapped.points_in_world[1]);
    for (Eigen::Vector3d& point : swapped.points_in_world) point *= 0x1p+20;
    const PoseSet<2> again = Solve(swapped);
    ASSERT_EQ(again.count, poses.count);
    for (const Rigid3& pose : poses) {
      swapped.camera_from_world = {pose.rotation(), 0x1p+20 * pose.translation()};
      ASSERT_LT(swapped.BestErrorOf(again), 1e-6);
    }
  }
}

TEST(PoseFromTwoPointsAndGravity, BearsADegreeOfError) {
  Random random(6);
  std::vector<double> errors_rad;
  for (int i = 0; i < kScenes; ++i) {
    LevelScene scene = RandomLevelScene(PointInFront, 30.0, random);
    scene.up_in_camera = Tilted(scene.up_in_camera, kDegree_rad, random);
    double best_rad = 4.0;
    for (const Rigid3& pose : Solve(scene)) {
      ASSERT_LT(scene.BearingErrorOf(pose), 1e-8);
      best_rad =
          std::min(best_rad, pose.rotation().angularDistance(scene.camera_from_world.rotation()));
    }
    errors_rad.push_back(best_rad);
  }
  std::sort(errors_rad.begin(), errors_rad.end());
  EXPECT_LT(errors_rad[errors_rad.size() / 2], 5.0 * kDegree_rad);
  EXPECT_LT(errors_rad[errors_rad.size() * 3 / 4], 15.0 * kDegree_rad);
}

TEST(PoseFromTwoPointsAndGravity, GivesNoneForAScaleOfNothing) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::nan(""));
  // One above the other, in one place; bearings alike, both in the horizon; no vertical; no
  // numbers.
  EXPECT_EQ(PoseFromTwoPointsAndGravity({x, y}, {z, 3.0 * z}, -y, z).count, 0);
  EXPECT_EQ(PoseFromTwoPointsAndGravity({x, y}, {z, z}, -y, z).count, 0);
  EXPECT_EQ(PoseFromTwoPointsAndGravity({z, z}, {x, y}, -y, z).count, 0);
  EXPECT_EQ(PoseFromTwoPointsAndGravity({x, z}, {x, y}, -y, z).count, 0);
  EXPECT_EQ(PoseFromTwoPointsAndGravity({x, z}, {x, y}, zero, zero).count, 0);
  EXPECT_EQ(PoseFromTwoPointsAndGravity({nowhere, z}, {x, y}, -y, z).count, 0);
  EXPECT_EQ(PoseFromTwoPointsAndGravity({x, z}, {x, nowhere}, -y, z).count, 0);
  EXPECT_EQ(PoseFromTwoPointsAndGravity({x, z}, {x, y}, nowhere, z).count, 0);
}

// A bare sampling loop, to show what two points do where three are hopeless: 5 % of 1,000 sights
// are right, the vertical is half a degree off, and pixels have noise of a thousandth.
TEST(PoseFromTwoPointsAndGravity, FindsThePoseAmongNinetyFivePercentMistakes) {
  constexpr std::size_t kSights = 1'000;
  constexpr std::size_t kRight = 50;
  constexpr int kSamples = 8'000;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const Eigen::Quaterniond rotation = RandomRotation(random);
    const Rigid3 truth(rotation, -(rotation * Eigen::Vector3d(100.0, 200.0, 10.0)));
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector3d> bearings;
    for (std::size_t i = 0; i < kSights; ++i) {
      const Eigen::Vector3d in_camera =
          random.Uniform(10.0, 40.0) *
          Eigen::Vector3d(random.Uniform(-0.7, 0.7), random.Uniform(-0.5, 0.5), 1.0);
      points.push_back(truth.Inverse() * in_camera);
      const Eigen::Vector3d seen =
          i < kRight ? Eigen::Vector3d(in_camera / in_camera.z() + 1e-3 * RandomVector(random))
                     : Eigen::Vector3d(random.Uniform(-0.7, 0.7), random.Uniform(-0.5, 0.5), 1.0);
      bearings.push_back(seen.normalized());
    }
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d up_in_camera = Tilted(rotation * up, 0.5 * kDegree_rad, random);

    std::size_t most = 0;
    Rigid3 best;
    for (int sample = 0; sample < kSamples; ++sample) {
      const std::size_t i = random.Index(kSights);
      const std::size_t j = random.Index(kSights);
      if (i == j) continue;
      for (const Rigid3& pose : PoseFromTwoPointsAndGravity(
               {bearings[i], bearings[j]}, {points[i], points[j]}, up_in_camera, up)) {
        std::size_t agreeing = 0;
        for (std::size_t k = 0; k < kSights; ++k) {
          const double error = ((pose * points[k]).normalized() - bearings[k]).squaredNorm();
          if (error < 0.015 * 0.015) ++agreeing;
        }
        if (agreeing > most) {
          most = agreeing;
          best = pose;
        }
      }
    }
    EXPECT_GT(most, 2 * kRight / 3) << "seed " << seed;
    EXPECT_LT((best.Inverse().translation() - truth.Inverse().translation()).norm(), 2.0)
        << "seed " << seed;
    EXPECT_LT(best.rotation().angularDistance(rotation), 2.5 * kDegree_rad) << "seed " << seed;
  }
}

}  // namespace
}  // namespace lodemark
