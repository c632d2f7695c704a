#include "core/resection/resection.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/resection/collinearity.h"
#include "test/unit/resection/resection_scene.h"

namespace lodemark {
namespace {

ResectedPose ResectScene(const ResectionScene& scene) {
  const Result<ResectedPose> pose =
      Resect(scene.sights, scene.lens, scene.priors, ResectionOptions());
  EXPECT_TRUE(pose.ok());
  return *pose;
}

double CentreError(const ResectedPose& pose, const ResectionScene& scene) {
  return (pose.centre_in_enu_m() - scene.centre_in_enu_m).norm();
}

TEST(Resect, FindsTheCameraAmongMistakenSights) {
  for (const double share : {0.0, 0.4, 0.8}) {
    SceneOptions options;
    options.outlier_share = share;
    const ResectionScene scene = MakeResectionScene(options);
    const ResectedPose pose = ResectScene(scene);
    EXPECT_EQ(pose.verdict, PoseVerdict::kPose);
    EXPECT_LT(CentreError(pose, scene), 0.03) << share;
    EXPECT_NEAR(pose.noise_px, 1.0, 0.2);
    EXPECT_LT(pose.log10_chance, -20.0);
    int good = 0;
    for (std::size_t i = 0; i < scene.sights.size(); ++i) {
      good += pose.is_inlier[i] != 0 && scene.is_mistaken[i] == 0 ? 1 : 0;
    }
    EXPECT_GE(good, pose.inliers - 1);
    EXPECT_GE(good, static_cast<int>(0.97 * (1.0 - share) * 200));
  }
}

TEST(Resect, NeedsGravityAndAPositionWhereHardlyASightIsRight) {
  SceneOptions options;
  options.sights = 2000;
  options.outlier_share = 0.98;
  for (options.seed = 1; options.seed <= 10; ++options.seed) {
    ResectionScene scene = MakeResectionScene(options);
    Random random(options.seed);
    scene.AddGravity(0.0087, &random);
    scene.AddPosition(3.0, &random);
    const ResectedPose pose = ResectScene(scene);
    EXPECT_EQ(pose.verdict, PoseVerdict::kPose);
    EXPECT_LT(CentreError(pose, scene), 0.1);
  }
}

TEST(Resect, OwesNothingToTheOrderOfTheSights) {
  const ResectionScene scene = MakeResectionScene({});
  const ResectedPose pose = ResectScene(scene);
  ResectionScene reversed = scene;
  std::reverse(reversed.sights.begin(), reversed.sights.end());
  const ResectedPose other = ResectScene(reversed);
  EXPECT_EQ(pose.camera_from_enu.translation(), other.camera_from_enu.translation());
  EXPECT_EQ(pose.covariance, other.covariance);
  EXPECT_EQ(pose.log10_chance, other.log10_chance);
  EXPECT_TRUE(std::equal(pose.is_inlier.begin(), pose.is_inlier.end(), other.is_inlier.rbegin()));
}

TEST(Resect, OwesNothingToTheOriginEvenAsFarAsTheEarthsCentre) {
  const ResectionScene scene = MakeResectionScene({});
  const ResectedPose pose = ResectScene(scene);
  const Eigen::Vector3d shift(4'000'000.25, -3'000'000.5, 4'800'000.125);
  ResectionScene far = scene;
  for (LandmarkSight& sight : far.sights) sight.landmark_in_enu_m += shift;
  const ResectedPose other = ResectScene(far);
  EXPECT_LT((other.centre_in_enu_m() - shift - pose.centre_in_enu_m()).norm(), 1e-6);
  EXPECT_LT((other.covariance - pose.covariance).norm(), 1e-6 * pose.covariance.norm());
  EXPECT_EQ(pose.is_inlier, other.is_inlier);
}

TEST(Resect, OwesNothingToTheUnitOfLength) {
  const ResectionScene scene = MakeResectionScene({});
  const ResectedPose pose = ResectScene(scene);
  ResectionScene in_millimetres = scene;
  for (LandmarkSight& sight : in_millimetres.sights) sight.landmark_in_enu_m *= 1000.0;
  const ResectedPose other = ResectScene(in_millimetres);
  EXPECT_LT((0.001 * other.centre_in_enu_m() - pose.centre_in_enu_m()).norm(), 1e-6);
  EXPECT_NEAR(1e-6 * other.covariance(0, 0), pose.covariance(0, 0), 1e-4 * pose.covariance(0, 0));
  EXPECT_NEAR(other.covariance(3, 3), pose.covariance(3, 3), 1e-4 * pose.covariance(3, 3));
}

TEST(Resect, SaysThatSightsAreTooFew) {
  SceneOptions options;
  options.sights = 3;
  options.outlier_share = 0.0;
  EXPECT_EQ(ResectScene(MakeResectionScene(options)).verdict, PoseVerdict::kTooFew);
  ResectionScene empty = MakeResectionScene(options);
  empty.sights.clear();
  EXPECT_EQ(ResectScene(empty).verdict, PoseVerdict::kTooFew);
}

TEST(Resect, DeterminesAPoseFromFourSightsOrThreeAndGravity) {
  SceneOptions options;
  options.sights = 4;
  options.outlier_share = 0.0;
  options.noise_px = 0.2;
  int right = 0;
  for (options.seed = 1; options.seed <= 30; ++options.seed) {
    const ResectionScene scene = MakeResectionScene(options);
    const ResectedPose pose = ResectScene(scene);
    if (pose.verdict == PoseVerdict::kPose) right += CentreError(pose, scene) < 2.0 ? 1 : 0;
  }
  EXPECT_GE(right, 20);
  options.sights = 3;
  right = 0;
  for (options.seed = 1; options.seed <= 30; ++options.seed) {
    ResectionScene scene = MakeResectionScene(options);
    Random random(options.seed);
    scene.AddGravity(0.005, &random);
    const ResectedPose pose = ResectScene(scene);
    if (pose.verdict == PoseVerdict::kPose) right += CentreError(pose, scene) < 2.0 ? 1 : 0;
  }
  EXPECT_GE(right, 10);
}

TEST(Resect, SaysThatLandmarksOnOneLineDetermineNothing) {
  ResectionScene scene = MakeResectionScene({});
  const CameraPose pose(scene.camera_from_enu);
  Random random(4);
  for (const double thickness_m : {0.0, 1e-4}) {
    for (LandmarkSight& sight : scene.sights) {
      const Eigen::Vector3d in_camera(random.Uniform(-5, 5),
                                      1.0 + random.Uniform(-1, 1) * thickness_m,
                                      20.0 + random.Uniform(-1, 1) * thickness_m);
      sight.landmark_in_enu_m = scene.camera_from_enu.Inverse() * in_camera;
      sight.pixel =
          *scene.lens.Project(in_camera) + Eigen::Vector2d(random.Gaussian(), random.Gaussian());
    }
    EXPECT_EQ(ResectScene(scene).verdict, PoseVerdict::kDegenerate) << thickness_m;
  }
}

TEST(Resect, SaysThatOnePlaceDeterminesNothing) {
  ResectionScene scene = MakeResectionScene({});
  for (LandmarkSight& sight : scene.sights) sight.landmark_in_enu_m = Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(ResectScene(scene).verdict, PoseVerdict::kDegenerate);
}

TEST(Resect, CallsSightsInOneCornerOfTheImageWeak) {
  SceneOptions options;
  options.outlier_share = 0.0;
  ResectionScene scene = MakeResectionScene(options);
  Random random(4);
  for (LandmarkSight& sight : scene.sights) {
    const Eigen::Vector2d pixel(random.Uniform(0, 60), random.Uniform(0, 60));
    const Eigen::Vector3d bearing = *scene.lens.Unproject(pixel);
    sight.landmark_in_enu_m =
        scene.camera_from_enu.Inverse() * (bearing * random.Uniform(15.0, 25.0));
    sight.pixel = pixel + Eigen::Vector2d(random.Gaussian(), random.Gaussian());
  }
  const ResectedPose pose = ResectScene(scene);
  EXPECT_TRUE(pose.verdict == PoseVerdict::kWeak || pose.verdict == PoseVerdict::kAmbiguous)
      << NameOf(pose.verdict);
}

// A square board of the given half width, leaning, seen from the given distance.
ResectionScene BoardScene(double half_width_m, double distance_m, std::uint64_t seed) {
  ResectionScene scene = MakeResectionScene({});
  scene.sights.clear();
  Random random(seed);
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 0.4, 0).normalized()));
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d on_board(random.Uniform(-half_width_m, half_width_m),
                                   random.Uniform(-half_width_m, half_width_m), 0.0);
    const Eigen::Vector3d in_camera = lean * on_board + Eigen::Vector3d(0, 0, distance_m);
    LandmarkSight sight;
    sight.landmark_in_enu_m = scene.camera_from_enu.Inverse() * in_camera;
    sight.pixel =
        *scene.lens.Project(in_camera) + Eigen::Vector2d(random.Gaussian(), random.Gaussian());
    scene.sights.push_back(sight);
  }
  return scene;
}

TEST(Resect, GivesBothAnswersOfASmallFlatTarget) {
  const ResectionScene scene = BoardScene(0.4, 20.0, 1);
  const ResectedPose pose = ResectScene(scene);
  ASSERT_EQ(pose.verdict, PoseVerdict::kAmbiguous) << NameOf(pose.verdict);
  ASSERT_TRUE(pose.alternative.has_value());
  const double angle_rad =
      scene.camera_from_enu.rotation().angularDistance(pose.camera_from_enu.rotation());
  const double other_rad =
      scene.camera_from_enu.rotation().angularDistance(pose.alternative->rotation());
  EXPECT_LT(std::min(angle_rad, other_rad), 0.15);
  EXPECT_GT(std::max(angle_rad, other_rad), 0.5);
}

TEST(Resect, GivesTheOneAnswerOfALargeFlatTarget) {
  const ResectionScene scene = BoardScene(6.0, 20.0, 1);
  const ResectedPose pose = ResectScene(scene);
  EXPECT_EQ(pose.verdict, PoseVerdict::kPose) << NameOf(pose.verdict);
  EXPECT_LT(CentreError(pose, scene), 0.1);
}

TEST(Resect, GivesBothPlacesThatARepeatedWallFits) {
  SceneOptions options;
  options.outlier_share = 0.0;
  ResectionScene scene = MakeResectionScene(options);
  for (std::size_t i = 0; i < scene.sights.size(); i += 2) {
    scene.sights[i].landmark_in_enu_m += Eigen::Vector3d(8.0, 3.0, 0.0);
  }
  const ResectedPose pose = ResectScene(scene);
  ASSERT_EQ(pose.verdict, PoseVerdict::kAmbiguous);
  const Eigen::Vector3d here = pose.centre_in_enu_m() - scene.centre_in_enu_m;
  const Eigen::Vector3d there =
      CameraPose(*pose.alternative).centre_in_enu_m - scene.centre_in_enu_m;
  EXPECT_LT(std::min(here.norm(), there.norm()), 0.05);
  EXPECT_NEAR(std::max(here.norm(), there.norm()), std::hypot(8.0, 3.0), 0.05);
}

TEST(Resect, KnowsThatItIsNotThatPlace) {
  int accepted = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SceneOptions options;
    options.sights = 10 + static_cast<int>(seed);
    options.outlier_share = 1.0;
    options.seed = seed;
    ResectionScene scene = MakeResectionScene(options);
    Random random(seed);
    if (seed % 3 == 1) scene.AddGravity(0.01, &random);
    if (seed % 3 == 2) {
      scene.AddGravity(0.01, &random);
      scene.AddPosition(3.0, &random);
    }
    ResectionOptions quick;
    quick.most_samples = 10'000;
    const Result<ResectedPose> pose = Resect(scene.sights, scene.lens, scene.priors, quick);
    ASSERT_TRUE(pose.ok());
    if (pose->verdict == PoseVerdict::kPose || pose->verdict == PoseVerdict::kWeak ||
        pose->verdict == PoseVerdict::kAmbiguous) {
      ++accepted;
    }
  }
  EXPECT_EQ(accepted, 0);
}

TEST(Resect, RefusesWhatIsNoInput) {
  const ResectionScene scene = MakeResectionScene({});
  const auto refuses = [&](const auto& change) {
    ResectionScene changed = scene;
    ResectionOptions options;
    change(&changed, &options);
    return !Resect(changed.sights, changed.lens, changed.priors, options).ok();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refuses([&](auto* s, auto*) { s->sights[3].pixel.x() = nan; }));
  EXPECT_TRUE(refuses([&](auto* s, auto*) { s->sights[3].landmark_in_enu_m.y() = nan; }));
  EXPECT_TRUE(refuses([&](auto* s, auto*) { s->sights[3].pixel_sigma_px = 0.0; }));
  EXPECT_TRUE(refuses([&](auto* s, auto*) { s->sights[3].quality = nan; }));
  EXPECT_TRUE(refuses(
      [&](auto* s, auto*) { s->sights[3].landmark_covariance_m2 = -Eigen::Matrix3d::Identity(); }));
  EXPECT_TRUE(refuses([&](auto* s, auto*) { s->priors.gravity = GravityPrior(); }));
  EXPECT_TRUE(refuses([&](auto* s, auto*) { s->priors.position = PositionPrior(); }));
  EXPECT_TRUE(refuses([&](auto*, auto* o) { o->inlier_threshold_px = nan; }));
  EXPECT_TRUE(refuses([&](auto*, auto* o) { o->most_samples = 0; }));
  EXPECT_FALSE(refuses([&](auto*, auto*) {}));
}

}  // namespace
}  // namespace lodemark
