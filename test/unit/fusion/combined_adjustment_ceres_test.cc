// Satellites and landmarks adjusted together by Ceres, which knows nothing of ours.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <utility>
#include <vector>

#include "core/fusion/bearing_group.h"
#include "core/fusion/combined_adjustment.h"
#include "test/unit/fusion/camera_scene.h"
#include "test/unit/fusion/ceres_misfits.h"

namespace lodemark {
namespace {

TEST(CombinedAdjustmentAgainstCeres, IsLeastSquaresOfEverything) {
  for (const int satellites : {0, 2, 3, 9}) {
    RangeScene scene;
    scene.AddSky(satellites, 0, kClock_m, {2.0, 0.0, 30.0});
    Random random(static_cast<std::uint64_t>(5 + satellites));
    for (RangeObservation& range : scene.ranges) range.range_m += random.Gaussian(0.0, 1.0);
    CameraScene camera(&scene);
    camera.AddWalls(8, &random, 0.005);

    BearingGroup group;
    BearingOptions options;
    options.wrong_probability = 1e-9;
    group.Set(camera.bearings, {}, camera.camera_from_ecef, options);
    CombinedOptions combined_options;
    combined_options.point.posterior_mean = false;
    combined_options.converged_sigmas = 1e-6;
    CombinedAdjustment adjustment;
    CombinedEstimate estimate;
    std::vector<ObservationVerdict> verdicts;
    ASSERT_EQ(adjustment.Solve(scene.ranges, scene.Beside({1.0, -1.0, 0.5}), ClockBiases(),
                               combined_options, &group, &estimate, &verdicts),
              PointStatus::kGood);

    ceres::Problem problem;
    const Eigen::Vector3d origin = scene.Beside({2.0, 2.0, 2.0});
    double offset[3] = {};
    double clock[1] = {kClock_m};
    double turn[3] = {};
    for (const RangeObservation& range : scene.ranges) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<RangeMisfit, 1, 3, 1>(new RangeMisfit{range, origin}),
          nullptr, offset, clock);
    }
    for (const BearingObservation& bearing : camera.bearings) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<BearingMisfit, 2, 3, 3>(
              new BearingMisfit{bearing, origin, camera.camera_from_ecef.toRotationMatrix()}),
          nullptr, offset, turn);
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.function_tolerance = 1e-16;
    solver.gradient_tolerance = 1e-14;
    solver.parameter_tolerance = 1e-14;
    solver.max_num_iterations = 200;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);

    const Eigen::Vector3d theirs = origin + Eigen::Map<const Eigen::Vector3d>(offset);
    EXPECT_LT((estimate.point.position_in_ecef - theirs).norm(), 1e-3) << satellites;
    Eigen::Matrix3d turned;
    ceres::AngleAxisToRotationMatrix(turn, turned.data());
    EXPECT_LT(group.camera_from_ecef().angularDistance(Eigen::Quaterniond(turned) *
                                                       camera.camera_from_ecef),
              2e-5)
        << satellites;
    ceres::Covariance::Options covariance_options;
    covariance_options.algorithm_type = ceres::DENSE_SVD;
    ceres::Covariance covariance(covariance_options);
    const std::vector<std::pair<const double*, const double*>> wanted = {{offset, offset}};
    ASSERT_TRUE(covariance.Compute(wanted, &problem));
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block;
    covariance.GetCovarianceBlock(offset, offset, block.data());
    const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(GeodeticFromEcef(theirs));
    const Eigen::Matrix3d expected = enu_from_ecef * block * enu_from_ecef.transpose();
    EXPECT_LT((estimate.point.covariance_enu_m2 - expected).norm(), 1e-2 * expected.norm())
        << satellites;
  }
}

}  // namespace
}  // namespace lodemark
