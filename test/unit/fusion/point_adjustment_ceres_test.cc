// The same adjustment by Ceres, which knows nothing of ours.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/fusion/point_adjustment.h"
#include "core/fusion/range_error.h"
#include "test/unit/fusion/adjusted.h"
#include "test/unit/fusion/ceres_misfits.h"

namespace lodemark {
namespace {

// Unknowns in metres from a place near by, so that they are of one size: position, clocks.
constexpr int kPosition = 3;

struct LandmarkMisfit {
  template <typename T>
  bool operator()(const T* offset, T* residual) const {
    const T no_clock(0.0);
    return RangeMisfit{range, origin}(offset, &no_clock, residual);
  }
  RangeObservation range;
  Eigen::Vector3d origin;
};

// -log of the density of a whitened misfit, with the derivatives that Ceres asks of a loss by the
// square of the misfit. Symmetric errors only.
class ModelLoss : public ceres::LossFunction {
 public:
  explicit ModelLoss(const RangeErrorModel& model) : model_(model) {}
  void Evaluate(double square, double out[3]) const override {
    const auto cost = [&](double s) {
      return -2.0 * std::log(RangeErrorDensity(model_, model_.sigma_m * std::sqrt(s)));
    };
    const double step = 1e-4 * (1.0 + square);
    const double from = std::max(square, step);
    out[0] = cost(square);
    out[1] = (cost(from + step) - cost(from - step)) / (2.0 * step);
    out[2] = 0.0;
  }

 private:
  RangeErrorModel model_;
};

struct CeresAnswer {
  Eigen::Vector3d position_in_ecef;
  std::vector<double> clock_m;
  Eigen::Matrix3d covariance_ecef_m2;
};

CeresAnswer SolveByCeres(const RangeScene& scene, const Eigen::Vector3d& origin, bool robust) {
  CeresAnswer answer;
  answer.clock_m.assign(kMaxClockGroups, kClock_m + 80.0);
  answer.clock_m[0] = kClock_m;
  double offset[kPosition] = {};
  ceres::Problem problem;
  for (const RangeObservation& range : scene.ranges) {
    ceres::LossFunction* loss = robust ? new ModelLoss(range.error) : nullptr;
    if (range.clock_group == kNoClock) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LandmarkMisfit, 1, kPosition>(
                                   new LandmarkMisfit{range, origin}),
                               loss, offset);
    } else {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<RangeMisfit, 1, kPosition, 1>(
                                   new RangeMisfit{range, origin}),
                               loss, offset,
                               &answer.clock_m[static_cast<std::size_t>(range.clock_group)]);
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.max_num_iterations = 200;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  answer.position_in_ecef = origin + Eigen::Map<const Eigen::Vector3d>(offset);
  ceres::Covariance::Options covariance_options;
  covariance_options.algorithm_type = ceres::DENSE_SVD;
  covariance_options.apply_loss_function = false;
  ceres::Covariance covariance(covariance_options);
  const std::vector<std::pair<const double*, const double*>> wanted = {{offset, offset}};
  EXPECT_TRUE(covariance.Compute(wanted, &problem));
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block;
  covariance.GetCovarianceBlock(offset, offset, block.data());
  answer.covariance_ecef_m2 = block;
  return answer;
}

RangeScene NoisyScene(double noise) {
  RangeScene scene;
  scene.AddSky(6, 0, kClock_m, {2.0, 0.0, 30.0});
  scene.AddSky(5, 4, kClock_m + 80.0, {5.0, 0.0, 30.0});
  scene.AddLandmark(75.0, 90.0, 20.0);
  Random random(31);
  for (RangeObservation& range : scene.ranges) {
    range.range_m += random.Gaussian(0.0, noise * range.error.sigma_m);
  }
  return scene;
}

PointOptions ModeOnly() {
  PointOptions options;
  options.posterior_mean = false;
  return options;
}

TEST(PointAdjustmentAgainstCeres, IsLeastSquaresWhereErrorsAreSmall) {
  const RangeScene scene = NoisyScene(0.5);
  const Adjusted ours = Adjust(scene, ClockBiases(), ModeOnly());
  ASSERT_EQ(ours.status, PointStatus::kGood);
  const CeresAnswer theirs = SolveByCeres(scene, scene.Beside({50.0, 50.0, 50.0}), false);
  EXPECT_LT((ours.estimate.position_in_ecef - theirs.position_in_ecef).norm(), 1e-3);
  EXPECT_NEAR(ours.estimate.clock_m, theirs.clock_m[0], 1e-3);
  EXPECT_NEAR(ours.estimate.clock_m + ours.estimate.biases[4].mean_m, theirs.clock_m[4], 1e-3);
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(theirs.position_in_ecef));
  const Eigen::Matrix3d expected =
      enu_from_ecef * theirs.covariance_ecef_m2 * enu_from_ecef.transpose();
  EXPECT_LT((ours.estimate.covariance_enu_m2 - expected).norm(), 2e-3 * expected.norm());
}

TEST(PointAdjustmentAgainstCeres, IsTheModeOfTheModelWhereSomeAreGross) {
  RangeScene scene = NoisyScene(1.0);
  scene.ranges[2].range_m += 35.0;
  scene.ranges[8].range_m -= 90.0;
  const Adjusted ours = Adjust(scene, ClockBiases(), ModeOnly());
  ASSERT_EQ(ours.status, PointStatus::kGood);
  // From the truth: gradual approaches are ours alone.
  const CeresAnswer theirs = SolveByCeres(scene, scene.truth_in_ecef, true);
  EXPECT_LT((ours.estimate.position_in_ecef - theirs.position_in_ecef).norm(), 5e-3);
  EXPECT_NEAR(ours.estimate.clock_m, theirs.clock_m[0], 5e-3);
}

}  // namespace
}  // namespace lodemark
