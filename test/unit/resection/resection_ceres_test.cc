// The adjustment and its covariance against Ceres, which shares nothing with ours: derivatives by
// dual numbers, and landmarks as unknowns of their own instead of noise of the pixels.
#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/resection/collinearity.h"
#include "core/resection/pose_covariance.h"
#include "core/resection/refinement.h"
#include "test/unit/resection/resection_scene.h"

namespace lodemark {
namespace {

// Pixel of a landmark from the centre and a small turn of the camera from start, both in ENU.
struct PixelResidual {
  PixelResidual(const LandmarkSight& seen, const CameraPose& from, const LensParameters& of)
      : sight(&seen), start(&from), lens(&of) {}

  template <typename T>
  bool operator()(const T* centre, const T* turn, const T* landmark, T* residual) const {
    const T back[3] = {-turn[0], -turn[1], -turn[2]};
    const T ray[3] = {landmark[0] - centre[0], landmark[1] - centre[1], landmark[2] - centre[2]};
    T turned[3];
    ceres::AngleAxisRotatePoint(back, ray, turned);
    T in_camera[3];
    for (int row = 0; row < 3; ++row) {
      in_camera[row] = start->matrix(row, 0) * turned[0] + start->matrix(row, 1) * turned[1] +
                       start->matrix(row, 2) * turned[2];
    }
    residual[0] = (lens->fx_px * in_camera[0] / in_camera[2] + lens->cx_px - sight->pixel.x()) /
                  sight->pixel_sigma_px;
    residual[1] = (lens->fy_px * in_camera[1] / in_camera[2] + lens->cy_px - sight->pixel.y()) /
                  sight->pixel_sigma_px;
    return true;
  }

  const LandmarkSight* sight;
  const CameraPose* start;
  const LensParameters* lens;
};

struct LandmarkResidual {
  explicit LandmarkResidual(const LandmarkSight& seen)
      : mapped(seen.landmark_in_enu_m),
        root(Eigen::Matrix3d(seen.landmark_covariance_m2.inverse().llt().matrixU())) {}

  template <typename T>
  bool operator()(const T* landmark, T* residual) const {
    for (int row = 0; row < 3; ++row) {
      residual[row] = T(0.0);
      for (int k = row; k < 3; ++k) residual[row] += root(row, k) * (landmark[k] - mapped[k]);
    }
    return true;
  }

  Eigen::Vector3d mapped;
  Eigen::Matrix3d root;
};

struct CeresAnswer {
  Vector6d step = Vector6d::Zero();  // of centre and rotation from the start
  Matrix6d covariance = Matrix6d::Zero();
};

CeresAnswer SolvedByCeres(const ResectionScene& scene, const CameraPose& start) {
  CeresAnswer answer;
  Eigen::Vector3d centre = start.centre_in_enu_m;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> landmarks;
  for (const LandmarkSight& sight : scene.sights) landmarks.push_back(sight.landmark_in_enu_m);
  ceres::Problem problem;
  for (std::size_t i = 0; i < scene.sights.size(); ++i) {
    const LandmarkSight& sight = scene.sights[i];
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PixelResidual, 2, 3, 3, 3>(
                                 new PixelResidual(sight, start, scene.lens.parameters())),
                             nullptr, centre.data(), turn.data(), landmarks[i].data());
    if (sight.landmark_covariance_m2.isZero(0.0)) {
      problem.SetParameterBlockConstant(landmarks[i].data());
    } else {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<LandmarkResidual, 3, 3>(new LandmarkResidual(sight)),
          nullptr, landmarks[i].data());
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_TRUE(summary.IsSolutionUsable());
  answer.step << centre - start.centre_in_enu_m, turn;
  ceres::Covariance covariance((ceres::Covariance::Options()));
  const std::vector<const double*> blocks = {centre.data(), turn.data()};
  if (!covariance.Compute(blocks, &problem)) {
    ADD_FAILURE() << "no covariance";
    return answer;
  }
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> joint;
  EXPECT_TRUE(covariance.GetCovarianceMatrix(blocks, joint.data()));
  answer.covariance = joint;
  return answer;
}

double RelativeError(const Matrix6d& ours, const Matrix6d& theirs) {
  const Vector6d scale = theirs.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix6d difference = scale.asDiagonal() * (ours - theirs) * scale.asDiagonal();
  return difference.cwiseAbs().maxCoeff();
}

ResectionScene SceneFor(std::uint64_t seed, double landmark_sigma_m) {
  SceneOptions options;
  options.seed = seed;
  options.sights = 30;
  options.outlier_share = 0.0;
  ResectionScene scene = MakeResectionScene(options);
  Random random(seed);
  for (LandmarkSight& sight : scene.sights) {
    sight.pixel_sigma_px = random.Uniform(0.5, 2.0);
    if (landmark_sigma_m == 0.0) continue;
    const Eigen::Vector3d along(random.Gaussian(), random.Gaussian(), random.Gaussian());
    sight.landmark_covariance_m2 = landmark_sigma_m * landmark_sigma_m *
                                   (Eigen::Matrix3d::Identity() + along * along.transpose());
  }
  return scene;
}

TEST(RefinePose, EndsWhereCeresDoesWithItsCovariance) {
  RefinementOptions options;
  options.kernel_sigmas = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const ResectionScene scene = SceneFor(seed, 0.0);
    const RefinedPose refined =
        RefinePose(scene.camera_from_enu, scene.sights, {}, scene.lens, {}, options);
    const CameraPose pose(refined.camera_from_enu);
    const CeresAnswer ceres = SolvedByCeres(scene, pose);
    // In sigmas.
    const double apart = ceres.step.dot(ceres.covariance.ldlt().solve(ceres.step));
    EXPECT_LT(apart, 1e-6);
    const std::vector<std::uint8_t> all(scene.sights.size(), 1);
    const PoseCovariance ours = CovarianceOf(pose, scene.sights, all, scene.lens, {}, 1.0, {});
    ASSERT_TRUE(ours.is_determined);
    EXPECT_LT(RelativeError(ours.covariance, ceres.covariance), 1e-5);
  }
}

// To the first order in what the landmarks move: weights are those of the mapped places.
TEST(RefinePose, CountsLandmarksAsCeresDoesThatAdjustsThemToo) {
  RefinementOptions options;
  options.kernel_sigmas = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ResectionScene scene = SceneFor(seed, 0.02);
    const RefinedPose refined =
        RefinePose(scene.camera_from_enu, scene.sights, {}, scene.lens, {}, options);
    const CameraPose pose(refined.camera_from_enu);
    const CeresAnswer ceres = SolvedByCeres(scene, pose);
    const double apart = ceres.step.dot(ceres.covariance.ldlt().solve(ceres.step));
    EXPECT_LT(apart, 1e-2);
    const std::vector<std::uint8_t> all(scene.sights.size(), 1);
    const PoseCovariance ours = CovarianceOf(pose, scene.sights, all, scene.lens, {}, 1.0, {});
    ASSERT_TRUE(ours.is_determined);
    EXPECT_LT(RelativeError(ours.covariance, ceres.covariance), 0.02);
  }
}

}  // namespace
}  // namespace lodemark
