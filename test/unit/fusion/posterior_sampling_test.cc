#include "core/fusion/posterior_sampling.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "core/fusion/range_error.h"
#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

constexpr int kSamples = 256;

PointProblem ProblemAt(const RangeScene& scene, const Eigen::Vector3d& offset_in_enu,
                       double clock_m, const std::optional<HeightPrior>& height,
                       std::vector<PointProblem::Row>* rows) {
  PointProblem problem(scene.ranges, ClockBiases(), height, rows);
  problem.MoveTo(scene.Beside(offset_in_enu));
  problem.clock_state()[0] = clock_m;
  return problem;
}

// Covariance of plain least squares.
Eigen::Matrix4d LinearCovariance(const PointProblem& problem) {
  PointMatrix normal = PointMatrix::Zero(4, 4);
  PointVector right = PointVector::Zero(4);
  for (const PointProblem::Row& row : problem.rows()) {
    problem.Accumulate(row, 1.0 / (row.error.sigma_m * row.error.sigma_m), 0.0, &normal, &right);
  }
  problem.AccumulatePriors(&normal, &right);
  const Eigen::Matrix4d full = normal.selfadjointView<Eigen::Upper>();
  return full.ldlt().solve(Eigen::Matrix4d::Identity());
}

// Both in units of the linear answer's own spread.
void ExpectLinear(const PosteriorMoments& moments, const Eigen::Vector4d& mean,
                  const Eigen::Matrix4d& covariance) {
  const Eigen::Matrix4d root = covariance.llt().matrixL();
  const Eigen::Vector4d off = root.triangularView<Eigen::Lower>().solve(moments.mean - mean);
  EXPECT_LT(off.norm(), 0.15);
  const Eigen::Matrix4d left = root.triangularView<Eigen::Lower>().solve(moments.covariance);
  const Eigen::Matrix4d whitened =
      root.triangularView<Eigen::Lower>().solve(Eigen::Matrix4d(left.transpose()));
  EXPECT_LT((whitened - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 0.2) << whitened;
}

TEST(PosteriorSampling, IsTheLinearAnswerWhereErrorsAreNormal) {
  for (const double sigma_m : {0.3, 1.0, 5.0}) {
    RangeScene scene;
    scene.AddSky(9, 0, kClock_m, {sigma_m, 0.0, 60.0});
    std::vector<PointProblem::Row> rows;
    const PointProblem problem = ProblemAt(scene, {0.0, 0.0, 0.0}, kClock_m, std::nullopt, &rows);
    const Eigen::Matrix4d covariance = LinearCovariance(problem);
    PosteriorSampling sampling(kSamples);
    const PosteriorMoments moments = sampling.Run(problem, 6.0 * covariance);
    EXPECT_GT(moments.effective_samples, 0.2 * kSamples);
    ExpectLinear(moments, Eigen::Vector4d::Zero(), covariance);
  }
}

TEST(PosteriorSampling, FindsTheLinearAnswerFromBesideIt) {
  RangeScene scene;
  scene.AddSky(9, 0, kClock_m, {5.0, 0.0, 30.0});
  std::vector<PointProblem::Row> rows;
  const PointProblem problem =
      ProblemAt(scene, {6.0, -5.0, 12.0}, kClock_m + 8.0, std::nullopt, &rows);
  const Eigen::Matrix4d covariance = LinearCovariance(problem);
  PosteriorSampling sampling(kSamples);
  const PosteriorMoments moments = sampling.Run(problem, 6.0 * covariance);
  ExpectLinear(moments, Eigen::Vector4d(-6.0, 5.0, -12.0, -8.0), covariance);
}

TEST(PosteriorSampling, HeedsTheHeight) {
  RangeScene scene;
  scene.AddSky(9, 0, kClock_m, {5.0, 0.0, 30.0});
  std::vector<PointProblem::Row> rows;
  const PointProblem problem =
      ProblemAt(scene, {0.0, 0.0, 0.0}, kClock_m, HeightPrior{180.0, 1.0}, &rows);
  const Eigen::Matrix4d covariance = LinearCovariance(problem);
  EXPECT_LT(covariance(2, 2), 1.0);
  PosteriorSampling sampling(kSamples);
  ExpectLinear(sampling.Run(problem, 6.0 * covariance), Eigen::Vector4d::Zero(), covariance);
}

TEST(PosteriorSampling, IsRepeatable) {
  RangeScene scene;
  scene.AddSky(9);
  scene.ranges[2].range_m += 25.0;
  std::vector<PointProblem::Row> rows;
  const PointProblem problem = ProblemAt(scene, {0.0, 0.0, 0.0}, kClock_m, std::nullopt, &rows);
  PosteriorSampling one(kSamples);
  PosteriorSampling other(kSamples);
  const Eigen::Matrix4d proposal = 50.0 * Eigen::Matrix4d::Identity();
  const PosteriorMoments first = one.Run(problem, proposal);
  EXPECT_EQ(first.mean, other.Run(problem, proposal).mean);
  EXPECT_EQ(first.mean, one.Run(problem, proposal).mean);
  EXPECT_EQ(first.covariance, one.Run(problem, proposal).covariance);
}

// East, north and clock are fixed by points on the horizon, so that the height stands alone and can
// be integrated by brute force: two overhead ranges against one that is much longer, all of them
// likely reflections.
TEST(PosteriorSampling, IsTheIntegralOfADensityWithTwoPeaks) {
  constexpr double kFar_m = 1e7;
  for (const double apart_m : {5.0, 15.0, 25.0}) {
    RangeScene scene;
    const RangeErrorModel tight = {1.0, 0.0, 30.0};
    const RangeErrorModel doubtful = {3.0, 0.5, 20.0};
    scene.AddPoint({kFar_m, 0.0, 0.0}, kNoClock, 0.0, tight);
    scene.AddPoint({0.0, kFar_m, 0.0}, kNoClock, 0.0, tight);
    scene.AddPoint({kFar_m, 0.0, 0.0}, 0, kClock_m, tight);
    scene.AddPoint({0.0, 0.0, kFar_m}, kNoClock, apart_m, doubtful);
    scene.AddPoint({0.0, 0.0, kFar_m}, kNoClock, apart_m + 2.0, doubtful);
    scene.AddPoint({0.0, 0.0, kFar_m}, kNoClock, 0.0, doubtful);
    std::vector<PointProblem::Row> rows;
    const PointProblem problem = ProblemAt(scene, {0.0, 0.0, 0.0}, kClock_m, std::nullopt, &rows);

    double sum = 0.0;
    double first = 0.0;
    double second = 0.0;
    for (double up_m = -150.0; up_m < 100.0; up_m += 0.02) {
      double density = 1.0;
      for (std::size_t i = 3; i < rows.size(); ++i) {
        density *= RangeErrorDensity(rows[i].error, rows[i].misclosure_m + up_m);
      }
      sum += density;
      first += density * up_m;
      second += density * up_m * up_m;
    }
    const double mean_m = first / sum;
    const double sigma_m = std::sqrt(second / sum - mean_m * mean_m);

    // Samples from a normal density miss some of what lies far out on a tail that falls more
    // slowly.
    for (const int samples : {256, 8192}) {
      const double tolerance_m = (samples == 256 ? 0.2 : 0.16) * sigma_m;
      PosteriorSampling sampling(samples);
      const PosteriorMoments moments =
          sampling.Run(problem, Eigen::Vector4d(6.0, 6.0, 400.0, 12.0).asDiagonal());
      EXPECT_NEAR(moments.mean[2], mean_m, 0.1 * sigma_m) << apart_m << " " << samples;
      EXPECT_NEAR(std::sqrt(moments.covariance(2, 2)), sigma_m, tolerance_m)
          << apart_m << " " << samples;
      EXPECT_NEAR(moments.mean[0], 0.0, 0.2);
      EXPECT_NEAR(moments.covariance(0, 0), 1.0, 0.25);
    }
  }
}

}  // namespace
}  // namespace lodemark
