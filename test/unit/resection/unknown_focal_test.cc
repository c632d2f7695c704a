// Poses of cameras whose focal length is not known, over scenes with fixed seeds.
#include "core/resection/unknown_focal.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "test/unit/resection/resection_scene.h"

namespace lodemark {
namespace {

// The scene's lens as a user has it who knows the image only.
Lens GuessedLens(const Lens& lens) {
  LensParameters parameters = lens.parameters();
  parameters.fx_px *= 0.6;
  parameters.fy_px *= 0.6;
  return *Lens::Create(parameters);
}

TEST(ResectWithFocal, FindsPoseAndFocalLengthWithAccuraciesThatHold) {
  SceneOptions options;
  options.sights = 100;
  options.outlier_share = 0.4;
  double centre = 0.0;
  double focal = 0.0;
  constexpr int kScenes = 100;
  for (int k = 0; k < kScenes; ++k) {
    options.seed = 1 + static_cast<std::uint64_t>(k);
    const ResectionScene scene = MakeResectionScene(options);
    const Result<ResectedCamera> camera =
        ResectWithFocal(scene.sights, GuessedLens(scene.lens), {}, {});
    ASSERT_TRUE(camera.ok());
    ASSERT_EQ(camera->pose.verdict, PoseVerdict::kPose) << k;
    const double error_px = camera->focal_px - scene.lens.parameters().fx_px;
    EXPECT_LT(std::abs(error_px), 25.0);
    focal += error_px * error_px / (camera->focal_sigma_px * camera->focal_sigma_px) / kScenes;
    const Eigen::Matrix3d stated_m2 = camera->pose.covariance.topLeftCorner<3, 3>();
    const Eigen::Vector3d offset_m = camera->pose.centre_in_enu_m() - scene.centre_in_enu_m;
    const Eigen::Vector3d weighted = stated_m2.ldlt().solve(offset_m);
    centre += offset_m.dot(weighted) / kScenes;
  }
  RecordProperty("centre", std::to_string(centre));
  RecordProperty("focal", std::to_string(focal));
  std::printf("squares in sigmas: centre %.2f, focal length %.2f\n", centre, focal);
  // Three sigmas of the mean of chi-squares with three and one degrees of freedom.
  EXPECT_NEAR(centre, 3.0, 3.0 * std::sqrt(6.0 / kScenes));
  EXPECT_NEAR(focal, 1.0, 3.0 * std::sqrt(2.0 / kScenes));
}

// A wall 20 m away, turned by so much from straight on, without mistaken sights.
ResectionScene WallScene(double turn_rad, std::uint64_t seed) {
  Random random(seed);
  ResectionScene scene;
  const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitY());
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d on_wall(random.Uniform(-8, 8), random.Uniform(-5, 5), 0.0);
    LandmarkSight sight;
    sight.landmark_in_enu_m = turn * on_wall + Eigen::Vector3d(0.0, 0.0, 20.0);
    sight.pixel = *scene.lens.Project(sight.landmark_in_enu_m) +
                  0.5 * Eigen::Vector2d(random.Gaussian(), random.Gaussian());
    scene.sights.push_back(sight);
  }
  return scene;
}

TEST(ResectWithFocal, DoesNotClaimAFocalLengthOfAWallSeenStraightOn) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ResectionScene scene = WallScene(0.0, seed);
    const Result<ResectedCamera> camera =
        ResectWithFocal(scene.sights, GuessedLens(scene.lens), {}, {});
    ASSERT_TRUE(camera.ok());
    EXPECT_NE(camera->pose.verdict, PoseVerdict::kPose) << seed;
    EXPECT_NE(camera->pose.verdict, PoseVerdict::kNotHere) << seed;
    EXPECT_TRUE(camera->focal_px == 0.0 || camera->focal_sigma_px > 0.03 * camera->focal_px);
  }
}

TEST(ResectWithFocal, FindsTheFocalLengthOfAWallSeenAslant) {
  double focal = 0.0;
  constexpr int kScenes = 40;
  for (int k = 0; k < kScenes; ++k) {
    const ResectionScene scene = WallScene(0.8, 1 + static_cast<std::uint64_t>(k));
    const Result<ResectedCamera> camera =
        ResectWithFocal(scene.sights, GuessedLens(scene.lens), {}, {});
    ASSERT_TRUE(camera.ok());
    ASSERT_EQ(camera->pose.verdict, PoseVerdict::kPose) << k;
    const double sigmas =
        (camera->focal_px - scene.lens.parameters().fx_px) / camera->focal_sigma_px;
    focal += sigmas * sigmas / kScenes;
  }
  EXPECT_NEAR(focal, 1.0, 3.0 * std::sqrt(2.0 / kScenes));
}

TEST(ResectWithFocal, OwesNothingToOrderOrOrigin) {
  SceneOptions options;
  options.sights = 80;
  ResectionScene scene = MakeResectionScene(options);
  const Lens lens = GuessedLens(scene.lens);
  const Result<ResectedCamera> here = ResectWithFocal(scene.sights, lens, {}, {});
  const Eigen::Vector3d far_m(-4.2e6, 3.1e6, 3.6e6);
  std::reverse(scene.sights.begin(), scene.sights.end());
  for (LandmarkSight& sight : scene.sights) sight.landmark_in_enu_m += far_m;
  const Result<ResectedCamera> there = ResectWithFocal(scene.sights, lens, {}, {});
  ASSERT_TRUE(here.ok() && there.ok());
  ASSERT_EQ(here->pose.verdict, PoseVerdict::kPose);
  ASSERT_EQ(there->pose.verdict, PoseVerdict::kPose);
  EXPECT_NEAR(there->focal_px, here->focal_px, 1e-3 * here->focal_sigma_px);
  EXPECT_LT((there->pose.centre_in_enu_m() - far_m - here->pose.centre_in_enu_m()).norm(), 1e-4);
}

TEST(ResectWithFocal, SaysWhenASceneIsNotThere) {
  SceneOptions options;
  options.outlier_share = 1.0;
  const ResectionScene scene = MakeResectionScene(options);
  ResectionOptions resection;
  resection.most_samples = 1000;
  const Result<ResectedCamera> camera = ResectWithFocal(scene.sights, scene.lens, {}, resection);
  ASSERT_TRUE(camera.ok());
  EXPECT_EQ(camera->pose.verdict, PoseVerdict::kNotHere);
}

// The scene's pinhole, bending as a phone's wide lens does, and as an action camera's.
TEST(ResectWithFocal, FindsTheFocalLengthOfALensThatBends) {
  SceneOptions options;
  options.sights = 100;
  options.outlier_share = 0.4;
  for (const LensModel model : {LensModel::kBrown, LensModel::kFisheye}) {
    double focal = 0.0;
    constexpr int kScenes = 3;
    for (int k = 0; k < kScenes; ++k) {
      options.seed = 1 + static_cast<std::uint64_t>(k);
      ResectionScene scene = MakeResectionScene(options);
      LensParameters parameters = scene.lens.parameters();
      parameters.model = model;
      parameters.coefficients[0] = model == LensModel::kBrown ? -0.25 : -0.02;
      parameters.coefficients[1] = model == LensModel::kBrown ? 0.08 : 0.003;
      const Lens bending = *Lens::Create(parameters);
      for (LandmarkSight& sight : scene.sights) {
        sight.pixel = *bending.Project(*scene.lens.Unproject(sight.pixel));
      }
      const Result<ResectedCamera> camera =
          ResectWithFocal(scene.sights, GuessedLens(bending), {}, {});
      ASSERT_TRUE(camera.ok());
      ASSERT_EQ(camera->pose.verdict, PoseVerdict::kPose) << k;
      ASSERT_TRUE(camera->lens.has_value());
      EXPECT_EQ(camera->lens->parameters().fx_px, camera->focal_px);
      EXPECT_LT((camera->pose.centre_in_enu_m() - scene.centre_in_enu_m).norm(), 1.0);
      const double sigmas = (camera->focal_px - parameters.fx_px) / camera->focal_sigma_px;
      focal += sigmas * sigmas / kScenes;
    }
    std::printf("square in sigmas of the focal length %.2f\n", focal);
    EXPECT_LT(focal, 1.0 + 3.0 * std::sqrt(2.0 / kScenes)) << static_cast<int>(model);
  }
}

TEST(ResectWithFocal, NeedsFiveSights) {
  SceneOptions options;
  options.sights = 4;
  options.outlier_share = 0.0;
  const ResectionScene scene = MakeResectionScene(options);
  EXPECT_EQ(ResectWithFocal(scene.sights, scene.lens, {}, {})->pose.verdict, PoseVerdict::kTooFew);
}

}  // namespace
}  // namespace lodemark
