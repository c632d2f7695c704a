#include "core/fusion/point_solution.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <vector>

#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

constexpr double kMillimetre_m = 1e-3;
constexpr RangeErrorModel kNoise = {3.0, 0.0, 30.0};

PointSolution Solve(const RangeScene& scene, std::vector<ObservationVerdict>* verdicts,
                    const std::optional<Eigen::Vector3d>& start_in_ecef = std::nullopt) {
  return SolvePoint(scene.ranges, start_in_ecef, verdicts);
}

TEST(SolvePoint, FindsPlaceAndClocksFromNothingAnywhere) {
  for (const double latitude_deg : {-90.0, -33.0, 0.0, 48.0, 90.0}) {
    RangeScene scene({latitude_deg * kRadiansPerDegree, 2.5, 4000.0});
    scene.AddSky(6, 7, 1e5, kNoise);
    scene.AddSky(4, 2, -3e6, kNoise);
    std::vector<ObservationVerdict> verdicts;
    const PointSolution solution = Solve(scene, &verdicts);
    ASSERT_EQ(solution.status, PointSolutionStatus::kGood) << latitude_deg;
    EXPECT_LT((solution.position_in_ecef - scene.truth_in_ecef).norm(), kMillimetre_m);
    EXPECT_EQ(solution.clock_groups, (1u << 7) | (1u << 2));
    EXPECT_NEAR(solution.clock_m[7], 1e5, kMillimetre_m);
    EXPECT_NEAR(solution.clock_m[2], -3e6, kMillimetre_m);
    EXPECT_EQ(solution.used, 10);
  }
}

// One gross error among as many as a phone sees, wherever it stands and however large.
TEST(SolvePoint, LeavesOutTheRangeThatContradicts) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    RangeScene scene;
    for (int i = 0; i < 11; ++i) {
      scene.AddSatellite(33.0 * i + random.Uniform(-15.0, 15.0), random.Uniform(15.0, 80.0), 1, 2e4,
                         kNoise);
      scene.ranges.back().range_m += random.Gaussian(0.0, kNoise.sigma_m);
    }
    const std::size_t wrong = random.Index(11);
    const double size_m = std::exp(random.Uniform(std::log(300.0), std::log(3e5)));
    scene.ranges[wrong].range_m += trial % 2 == 0 ? size_m : -size_m;
    std::vector<ObservationVerdict> verdicts;
    const PointSolution solution = Solve(scene, &verdicts);
    ASSERT_EQ(solution.status, PointSolutionStatus::kGood) << trial;
    const Eigen::Vector3d error = scene.ErrorInEnu(solution.position_in_ecef);
    EXPECT_LT(error.dot(solution.covariance_enu_m2.ldlt().solve(error)), 25.0)
        << trial << " " << size_m;
    EXPECT_FALSE(verdicts[wrong].used) << trial;
  }
}

TEST(SolvePoint, GivesNothingWhereHalfTheRangesContradictTheOthers) {
  RangeScene scene;
  scene.AddSky(8, 0, kClock_m, kNoise);
  for (std::size_t i = 0; i < 4; ++i) {
    scene.ranges[2 * i].range_m += 3000.0 * (static_cast<double>(i) + 1.0);
  }
  std::vector<ObservationVerdict> verdicts;
  EXPECT_NE(Solve(scene, &verdicts).status, PointSolutionStatus::kGood);
}

TEST(SolvePoint, AStartDecidesBetweenTwoPlaces) {
  RangeScene scene;
  // Three landmarks in one plane: the place and its mirror image fit alike.
  scene.AddPoint({20.0, 0.0, 15.0}, kNoClock, 0.0, {0.1, 0.0, 30.0});
  scene.AddPoint({-12.0, 18.0, 15.0}, kNoClock, 0.0, {0.1, 0.0, 30.0});
  scene.AddPoint({-10.0, -20.0, 15.0}, kNoClock, 0.0, {0.1, 0.0, 30.0});
  std::vector<ObservationVerdict> verdicts;
  EXPECT_EQ(Solve(scene, &verdicts).status, PointSolutionStatus::kAmbiguous);
  const PointSolution below = Solve(scene, &verdicts, scene.Beside({1.0, 1.0, -2.0}));
  ASSERT_EQ(below.status, PointSolutionStatus::kGood);
  EXPECT_LT((below.position_in_ecef - scene.truth_in_ecef).norm(), kMillimetre_m);
  const PointSolution above = Solve(scene, &verdicts, scene.Beside({1.0, 1.0, 32.0}));
  ASSERT_EQ(above.status, PointSolutionStatus::kGood);
  EXPECT_NEAR(scene.ErrorInEnu(above.position_in_ecef).z(), 30.0, 0.01);
}

TEST(SolvePoint, ScattersAsItsCovarianceSays) {
  Random random(77);
  constexpr int kTrials = 400;
  double nees = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RangeScene scene;
    scene.AddSky(5, 0, kClock_m, kNoise);
    scene.AddSky(4, 3, kClock_m - 500.0, kNoise);
    scene.AddLandmark(60.0, 80.0, 25.0, 1.0);
    for (RangeObservation& range : scene.ranges) {
      range.range_m += random.Gaussian(0.0, range.error.sigma_m);
    }
    std::vector<ObservationVerdict> verdicts;
    const PointSolution solution = Solve(scene, &verdicts, scene.Beside({9.0, -9.0, 3.0}));
    ASSERT_EQ(solution.status, PointSolutionStatus::kGood) << trial;
    const Eigen::Vector3d error = scene.ErrorInEnu(solution.position_in_ecef);
    nees += error.dot(solution.covariance_enu_m2.ldlt().solve(error)) / kTrials;
  }
  EXPECT_NEAR(nees, 3.0, 1.96 * std::sqrt(6.0 / kTrials));
}

}  // namespace
}  // namespace lodemark
