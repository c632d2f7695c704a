#include "core/resection/refinement.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "core/base/random.h"
#include "core/resection/collinearity.h"
#include "test/unit/resection/resection_scene.h"

namespace lodemark {
namespace {

ResectionScene CleanScene(double noise_px, int sights) {
  SceneOptions options;
  options.sights = sights;
  options.outlier_share = 0.0;
  options.noise_px = noise_px;
  return MakeResectionScene(options);
}

Rigid3 Disturbed(const Rigid3& pose) {
  Vector6d step;
  step << 0.6, -0.4, 0.3, 0.01, -0.02, 0.015;
  return CameraPose(pose).Moved(step).camera_from_enu();
}

double LargestDifference(const Rigid3& a, const Rigid3& b) {
  return std::max((CameraPose(a).centre_in_enu_m - CameraPose(b).centre_in_enu_m).norm(),
                  a.rotation().angularDistance(b.rotation()));
}

TEST(Collinearity, HasDerivativesThatDifferencesGive) {
  const ResectionScene scene = CleanScene(3.0, 20);
  LensParameters parameters = scene.lens.parameters();
  parameters.model = LensModel::kBrown;
  parameters.coefficients = {-0.1, 0.05, 0.001, -0.002};
  const Lens lens = *Lens::Create(parameters);
  const CameraPose pose(scene.camera_from_enu);
  constexpr double kStep = 1e-5;
  for (const LandmarkSight& sight : scene.sights) {
    LinearSight linear;
    ASSERT_TRUE(Linearise(sight, pose, lens, &linear));
    LinearSight below;
    LinearSight above;
    for (int k = 0; k < 6; ++k) {
      ASSERT_TRUE(Linearise(sight, pose.Moved(-kStep * Vector6d::Unit(k)), lens, &below));
      ASSERT_TRUE(Linearise(sight, pose.Moved(kStep * Vector6d::Unit(k)), lens, &above));
      const Eigen::Vector2d slope = (below.residual_px - above.residual_px) / (2.0 * kStep);
      EXPECT_LT((slope - linear.by_pose.col(k)).norm(), 1e-4 * (1.0 + slope.norm())) << k;
    }
    for (int k = 0; k < 3; ++k) {
      LandmarkSight moved = sight;
      moved.landmark_in_enu_m += kStep * Eigen::Vector3d::Unit(k);
      ASSERT_TRUE(Linearise(moved, pose, lens, &above));
      moved.landmark_in_enu_m = sight.landmark_in_enu_m - kStep * Eigen::Vector3d::Unit(k);
      ASSERT_TRUE(Linearise(moved, pose, lens, &below));
      const Eigen::Vector2d slope = (below.residual_px - above.residual_px) / (2.0 * kStep);
      EXPECT_LT((slope - linear.by_landmark.col(k)).norm(), 1e-4 * (1.0 + slope.norm())) << k;
    }
  }
}

TEST(Collinearity, HasDerivativesOfThePriorsThatDifferencesGive) {
  ResectionScene scene = CleanScene(1.0, 4);
  Random random(3);
  scene.AddGravity(0.05, &random);
  scene.AddPosition(2.0, &random);
  scene.priors.position->covariance_m2(0, 1) = scene.priors.position->covariance_m2(1, 0) = 1.5;
  const CameraPose pose(Disturbed(scene.camera_from_enu));
  Matrix6d information = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  PriorCost(scene.priors, pose, &information, &right);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const double above =
        PriorCost(scene.priors, pose.Moved(kStep * Vector6d::Unit(k)), nullptr, nullptr);
    const double below =
        PriorCost(scene.priors, pose.Moved(-kStep * Vector6d::Unit(k)), nullptr, nullptr);
    EXPECT_NEAR((below - above) / (2.0 * kStep), right[k], 1e-5 * (1.0 + right.norm())) << k;
  }
}

TEST(RefinePose, FindsThePoseOfSightsWithoutNoise) {
  const ResectionScene scene = CleanScene(0.0, 12);
  const RefinedPose refined = RefinePose(Disturbed(scene.camera_from_enu), scene.sights, {},
                                         scene.lens, {}, {1.0, 0.0, 25});
  EXPECT_TRUE(refined.converged);
  EXPECT_LT(LargestDifference(refined.camera_from_enu, scene.camera_from_enu), 1e-7);
  EXPECT_LT(refined.cost, 1e-9);
}

TEST(RefinePose, NeverMakesThePoseWorse) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SceneOptions options;
    options.sights = 12;
    options.outlier_share = 0.5;
    options.seed = seed;
    const ResectionScene scene = MakeResectionScene(options);
    RefinementOptions none;
    none.most_iterations = 0;
    const Rigid3 start = Disturbed(scene.camera_from_enu);
    const RefinedPose before = RefinePose(start, scene.sights, {}, scene.lens, {}, none);
    const RefinedPose after = RefinePose(start, scene.sights, {}, scene.lens, {}, {});
    EXPECT_LE(after.cost, before.cost);
  }
}

TEST(RefinePose, LeavesMistakenSightsAloneByItsKernel) {
  SceneOptions options;
  options.sights = 60;
  options.outlier_share = 0.5;
  const ResectionScene scene = MakeResectionScene(options);
  std::vector<std::uint8_t> is_good;
  for (const std::uint8_t mistaken : scene.is_mistaken) is_good.push_back(mistaken == 0 ? 1 : 0);
  RefinementOptions wide;
  wide.kernel_sigmas = 5.0;
  const RefinedPose by_kernel =
      RefinePose(scene.camera_from_enu, scene.sights, {}, scene.lens, {}, wide);
  const RefinedPose by_choice =
      RefinePose(scene.camera_from_enu, scene.sights, is_good, scene.lens, {}, wide);
  EXPECT_LT(LargestDifference(by_kernel.camera_from_enu, by_choice.camera_from_enu), 1e-6);
}

TEST(RefinePose, WeighsThePriorsAgainstTheSights) {
  ResectionScene scene = CleanScene(1.0, 30);
  Random random(5);
  scene.AddPosition(1.0, &random);
  const auto refined_with = [&](double sigma_m) {
    scene.priors.position->covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    return CameraPose(RefinePose(scene.camera_from_enu, scene.sights, {}, scene.lens, scene.priors,
                                 {1.0, 0.0, 40})
                          .camera_from_enu)
        .centre_in_enu_m;
  };
  EXPECT_LT((refined_with(1e-6) - scene.priors.position->position_in_enu_m).norm(), 1e-4);
  EXPECT_LT((refined_with(100.0) - scene.centre_in_enu_m).norm(), 0.05);
}

}  // namespace
}  // namespace lodemark
