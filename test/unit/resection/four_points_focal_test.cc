#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/resection/minimal_solvers.h"
#include "test/unit/resection/random_scenes.h"

namespace lodemark {
namespace {

constexpr int kScenes = 5'000;

struct FocalScene : Scene<4> {
  double focal_px = 0.0;
  std::array<Eigen::Vector2d, 4> pixels;

  // Of the best pose, and of its focal length, both relative.
  double BestErrorAmong(const FocalPoseSet& set) const {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < set.count; ++i) {
      const FocalPose& pose = set.poses[static_cast<std::size_t>(i)];
      best = std::min(best, std::max(ErrorOf(pose.camera_from_world),
                                     std::abs(pose.focal_px / focal_px - 1.0)));
    }
    return best;
  }
};

FocalScene SceneOfFocal(const std::array<Eigen::Vector3d, 4>& points_in_camera, double spread_m,
                        Random& random) {
  FocalScene scene;
  static_cast<Scene<4>&>(scene) = SceneOf(points_in_camera, spread_m, random);
  scene.focal_px = std::exp(random.Uniform(std::log(300.0), std::log(5000.0)));
  for (std::size_t i = 0; i < 4; ++i) {
    scene.pixels[i] = scene.focal_px * scene.bearings[i].hnormalized();
  }
  return scene;
}

FocalScene RandomFocalScene(double spread_m, Random& random) {
  std::array<Eigen::Vector3d, 4> points;
  for (Eigen::Vector3d& point : points) point = PointInFront(random);
  return SceneOfFocal(points, spread_m, random);
}

FocalPoseSet Solve(const FocalScene& scene) {
  return PoseAndFocalFromFourPoints(scene.pixels, scene.points_in_world);
}

TEST(PoseAndFocalFromFourPoints, FindsPoseAndFocalLength) {
  Random random(1);
  int missed = 0;
  for (int i = 0; i < kScenes; ++i) {
    const FocalScene scene = RandomFocalScene(30.0, random);
    if (!(scene.BestErrorAmong(Solve(scene)) < 1e-6)) ++missed;
  }
  EXPECT_EQ(missed, 0);
}

// A facade seen by a level camera turned aside, and one tilted too.
TEST(PoseAndFocalFromFourPoints, FindsThemFromAPlane) {
  Random random(2);
  int missed = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Eigen::Quaterniond tilt(
        Eigen::AngleAxisd(random.Uniform(0.3, 1.0), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(i % 2 == 0 ? 0.0 : random.Uniform(-0.5, 0.5), Eigen::Vector3d::UnitX()));
    const double corners[4][2] = {{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}};
    std::array<Eigen::Vector3d, 4> points;
    for (std::size_t k = 0; k < 4; ++k) {
      const double x = 5.0 * corners[k][0] * random.Uniform(0.4, 1.0);
      const double y = 5.0 * corners[k][1] * random.Uniform(0.4, 1.0);
      points[k] = Eigen::Vector3d(0.0, 0.0, 12.0) + tilt * Eigen::Vector3d(x, y, 0.0);
    }
    const FocalScene scene = SceneOfFocal(points, 30.0, random);
    if (!(scene.BestErrorAmong(Solve(scene)) < 1e-6)) ++missed;
  }
  EXPECT_EQ(missed, 0);
}

TEST(PoseAndFocalFromFourPoints, GivesOnlyPosesNearThePixels) {
  Random random(3);
  for (int i = 0; i < kScenes; ++i) {
    const FocalScene scene = RandomFocalScene(30.0, random);
    const FocalPoseSet set = Solve(scene);
    double spread_px = 0.0;
    for (const Eigen::Vector2d& pixel : scene.pixels) spread_px += 0.5 * pixel.norm();
    for (int k = 0; k < set.count; ++k) {
      const FocalPose& pose = set.poses[static_cast<std::size_t>(k)];
      ASSERT_GT(pose.focal_px, 0.0);
      for (std::size_t j = 0; j < 4; ++j) {
        const Eigen::Vector3d point = pose.camera_from_world * scene.points_in_world[j];
        ASSERT_GT(point.z(), 0.0);
        ASSERT_LT((pose.focal_px * point.hnormalized() - scene.pixels[j]).norm(), 0.1 * spread_px);
      }
    }
  }
}

TEST(PoseAndFocalFromFourPoints, HoldsFarFromTheOriginInAnyUnitAndOrder) {
  Random random(4);
  int missed = 0;
  for (int i = 0; i < kScenes; ++i) {
    FocalScene scene = RandomFocalScene(4.0e6, random);
    std::reverse(scene.pixels.begin(), scene.pixels.end());
    std::reverse(scene.points_in_world.begin(), scene.points_in_world.end());
    for (Eigen::Vector3d& point : scene.points_in_world) point *= 0x1p-10;
    scene.camera_from_world = {scene.camera_from_world.rotation(),
                               0x1p-10 * scene.camera_from_world.translation()};
    if (!(scene.BestErrorAmong(Solve(scene)) < 1e-4)) ++missed;
  }
  EXPECT_LE(missed, kScenes / 200);
}

TEST(PoseAndFocalFromFourPoints, BearsNoiseOfAPixel) {
  Random random(5);
  std::vector<double> errors;
  for (int i = 0; i < kScenes; ++i) {
    FocalScene scene = RandomFocalScene(30.0, random);
    for (Eigen::Vector2d& pixel : scene.pixels) {
      pixel += 1e-3 * scene.focal_px * RandomVector(random).head<2>();
    }
    errors.push_back(scene.BestErrorAmong(Solve(scene)));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[kScenes / 2], 0.02);
  EXPECT_LT(errors[kScenes * 9 / 10], 0.3);
}

TEST(PoseAndFocalFromFourPoints, GivesNoneForAScaleOfNothing) {
  Random random(6);
  const FocalScene scene = RandomFocalScene(1.0, random);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  EXPECT_EQ(PoseAndFocalFromFourPoints(scene.pixels, {x, 2.0 * x, 3.0 * x, 5.0 * x}).count, 0);
  EXPECT_EQ(PoseAndFocalFromFourPoints(scene.pixels, {x, x, x, x}).count, 0);
  EXPECT_EQ(PoseAndFocalFromFourPoints({}, scene.points_in_world).count, 0);
  auto pixels = scene.pixels;
  pixels[1].x() = std::nan("");
  EXPECT_EQ(PoseAndFocalFromFourPoints(pixels, scene.points_in_world).count, 0);
  auto points = scene.points_in_world;
  points[3].z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(PoseAndFocalFromFourPoints(scene.pixels, points).count, 0);
  // A square seen straight on: nearer and shorter looks the same.
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  EXPECT_EQ(PoseAndFocalFromFourPoints(
                {Eigen::Vector2d(100.0, 100.0), {-100.0, 100.0}, {-100.0, -100.0}, {100.0, -100.0}},
                {x + y, y - x, -x - y, x - y})
                .count,
            0);
}

}  // namespace
}  // namespace lodemark
