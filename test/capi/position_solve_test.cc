#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "lodemark/lodemark.h"

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr double kPlace[3] = {48.2, 16.37, 180.0};  // degrees, degrees, metres

struct Enu {
  double east_m;
  double north_m;
  double up_m;
};

// Ranges from kPlace to points given in its own east, north, up, measured without error but for
// what the test adds.
class Scene {
 public:
  void Add(const Enu& point, int clock_group, double error_m, double sigma_m) {
    const double enu_m[3] = {point.east_m, point.north_m, point.up_m};
    lodemark_range range = {};
    range.struct_size = sizeof range;
    range.clock_group = clock_group;
    ASSERT_EQ(lodemark_ecef_from_enu(kPlace, enu_m, range.point_in_ecef_m), LODEMARK_OK);
    range.range_m = std::hypot(point.east_m, point.north_m, point.up_m) + error_m;
    range.sigma_m = sigma_m;
    ranges.push_back(range);
  }

  void AddSatellite(double azimuth_deg, double elevation_deg, int clock_group, double error_m,
                    double sigma_m = 5.0) {
    const double distance_m = 2.2e7;
    const double level_m = distance_m * std::cos(elevation_deg * kDegree);
    Add({level_m * std::sin(azimuth_deg * kDegree), level_m * std::cos(azimuth_deg * kDegree),
         distance_m * std::sin(elevation_deg * kDegree)},
        clock_group, error_m, sigma_m);
  }

  // Eight satellites well spread over the sky, clock 250 m.
  void AddSky() {
    for (int i = 0; i < 8; ++i) AddSatellite(45.0 * i + 5.0, i % 2 == 0 ? 20.0 : 60.0, 1, 250.0);
  }

  lodemark_status Solve() {
    solution = {};
    solution.struct_size = sizeof solution;
    residuals.assign(ranges.size(), {});
    if (!residuals.empty()) residuals[0].struct_size = sizeof residuals[0];
    options.struct_size = sizeof options;
    return lodemark_position_solve(ranges.data(), static_cast<int>(ranges.size()), &options,
                                   &solution, residuals.data());
  }

  void StartAt(const Enu& start) {
    const double enu_m[3] = {start.east_m, start.north_m, start.up_m};
    options.present = LODEMARK_SOLVE_HAS_START;
    lodemark_ecef_from_enu(kPlace, enu_m, options.start_in_ecef_m);
  }

  // Distance of the solution from the truth.
  double Error_m() const {
    double enu_m[3] = {};
    lodemark_enu_from_ecef(kPlace, solution.ecef_m, enu_m);
    return std::hypot(enu_m[0], enu_m[1], enu_m[2]);
  }

  std::vector<lodemark_range> ranges;
  std::vector<lodemark_range_residual> residuals;
  lodemark_solve_options options = {};
  lodemark_solution solution = {};
};

TEST(PositionSolve, FindsPlaceAndClockFromSatellitesAlone) {
  Scene scene;
  scene.AddSky();
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 1e-3);
  EXPECT_NEAR(scene.solution.latitude_deg, kPlace[0], 1e-8);
  EXPECT_NEAR(scene.solution.longitude_deg, kPlace[1], 1e-8);
  EXPECT_NEAR(scene.solution.height_m, kPlace[2], 1e-3);
  EXPECT_EQ(scene.solution.outcome, LODEMARK_OUTCOME_FIX);
  EXPECT_EQ(scene.solution.ranges_used, 8);
  EXPECT_EQ(scene.solution.clocks_present, 1u);
  EXPECT_NEAR(scene.solution.clock_m[0], 250.0, 1e-3);
}

TEST(PositionSolve, GivesEveryClockGroupItsOwnClock) {
  Scene scene;
  for (int i = 0; i < 5; ++i) scene.AddSatellite(72.0 * i, 10.0 + 15.0 * i, 3, 1000.0);
  for (int i = 0; i < 4; ++i) scene.AddSatellite(90.0 * i + 10.0, 20.0 + 20.0 * i, 16, -4e5);
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 1e-3);
  EXPECT_EQ(scene.solution.clocks_present, 1u << 2 | 1u << 15);
  EXPECT_NEAR(scene.solution.clock_m[2], 1000.0, 1e-2);
  EXPECT_NEAR(scene.solution.clock_m[15], -4e5, 1e-2);
}

// One satellite in the zenith and four on the horizon, all of sigma 2 m: the normal equations of
// up and clock are [1 -1; -1 5], of east and north 2 each. So the cofactors are east 1/2,
// north 1/2, up 5/4, clock 1/4.
TEST(PositionSolve, HasTheCovarianceAndDilutionsDoneByHand) {
  Scene scene;
  scene.AddSatellite(0.0, 90.0, 1, 0.0, 2.0);
  for (int i = 0; i < 4; ++i) scene.AddSatellite(90.0 * i, 0.0, 1, 0.0, 2.0);
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  const double* covariance = scene.solution.covariance_enu_m2;
  EXPECT_NEAR(covariance[0], 4.0 * 0.5, 1e-6);
  EXPECT_NEAR(covariance[4], 4.0 * 0.5, 1e-6);
  EXPECT_NEAR(covariance[8], 4.0 * 1.25, 1e-6);
  for (const int i : {1, 2, 3, 5, 6, 7}) EXPECT_NEAR(covariance[i], 0.0, 1e-6);
  EXPECT_NEAR(scene.solution.clock_sigma_m[0], 2.0 * 0.5, 1e-6);
  EXPECT_NEAR(scene.solution.hdop, 1.0, 1e-6);
  EXPECT_NEAR(scene.solution.vdop, std::sqrt(1.25), 1e-6);
  EXPECT_NEAR(scene.solution.pdop, 1.5, 1e-6);
  EXPECT_NEAR(scene.solution.tdop, 0.5, 1e-6);
  // A round normal of sigma s holds 68 % within s sqrt(-2 ln 0.32); a line within 0.9945 s.
  EXPECT_NEAR(scene.solution.accuracy_m, std::sqrt(2.0) * std::sqrt(-2.0 * std::log(0.32)), 2e-3);
  EXPECT_NEAR(scene.solution.vertical_accuracy_m, std::sqrt(5.0) * 0.9945, 2e-3);
}

TEST(PositionSolve, WorksFromLandmarksWithoutAnyClock) {
  Scene scene;
  scene.Add({100.0, 0.0, 5.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.5);
  scene.Add({-20.0, 80.0, 30.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.5);
  scene.Add({-50.0, -60.0, 12.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.5);
  scene.Add({5.0, 7.0, 60.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.5);
  scene.Add({40.0, -45.0, -2.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.5);
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 1e-4);
  EXPECT_EQ(scene.solution.clocks_present, 0u);
  EXPECT_EQ(scene.solution.tdop, 0.0);
}

// Three spheres meet in two points, mirrored in the plane of their centres.
TEST(PositionSolve, DoesNotChooseBetweenTwoPlacesUnlessAStartDoes) {
  Scene scene;
  scene.Add({100.0, 0.0, 0.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 1.0);
  scene.Add({0.0, 100.0, 0.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 2.0);
  scene.Add({0.0, 0.0, 100.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 3.0);
  EXPECT_EQ(scene.Solve(), LODEMARK_NO_POSITION);
  EXPECT_EQ(scene.solution.outcome, LODEMARK_OUTCOME_AMBIGUOUS);

  scene.StartAt({5.0, -4.0, 8.0});
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 1e-4);
  EXPECT_NEAR(scene.solution.covariance_enu_m2[0], 1.0, 1e-6);
  EXPECT_NEAR(scene.solution.covariance_enu_m2[4], 4.0, 1e-6);
  EXPECT_NEAR(scene.solution.covariance_enu_m2[8], 9.0, 1e-6);
  EXPECT_NEAR(scene.solution.pdop, std::sqrt(3.0), 1e-6);

  scene.StartAt({70.0, 60.0, 65.0});
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_NEAR(scene.Error_m(), std::sqrt(3.0) * 200.0 / 3.0, 1e-3) << "the mirrored place";
}

TEST(PositionSolve, TwoSatellitesAndAShopSignGiveAFix) {
  Scene scene;
  scene.AddSatellite(30.0, 50.0, 1, 77.0);
  scene.AddSatellite(160.0, 35.0, 1, 77.0);
  scene.Add({12.0, 20.0, 3.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.3);
  scene.Add({15.0, 18.0, 4.5}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.3);
  scene.Add({13.0, 22.0, 7.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.3);
  scene.StartAt({0.0, 5.0, 0.0});
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 0.01);
  EXPECT_NEAR(scene.solution.clock_m[0], 77.0, 0.05);
}

TEST(PositionSolve, LeavesOutARangeThatContradictsTheOthers) {
  Scene scene;
  scene.AddSky();
  scene.ranges[3].range_m += 300.0;
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 1e-2);
  EXPECT_EQ(scene.solution.ranges_used, 7);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(scene.residuals[i].used, i == 3 ? 0 : 1) << i;
  EXPECT_NEAR(scene.residuals[3].residual_m, 300.0, 1e-2);
  EXPECT_LT(scene.residuals[3].weight, 0.01);
}

TEST(PositionSolve, GivesNothingWhereNobodyCanTellWhichRangeIsWrong) {
  Scene scene;
  for (int i = 0; i < 5; ++i) scene.AddSatellite(72.0 * i, 15.0 + 15.0 * i, 1, 0.0, 3.0);
  scene.ranges[2].range_m += 5000.0;
  EXPECT_EQ(scene.Solve(), LODEMARK_NO_POSITION);
  EXPECT_EQ(scene.solution.outcome, LODEMARK_OUTCOME_INCONSISTENT);
  EXPECT_EQ(scene.solution.ecef_m[0], 0.0);
}

TEST(PositionSolve, SaysWhenThereAreTooFewRanges) {
  Scene scene;
  EXPECT_EQ(scene.Solve(), LODEMARK_NO_POSITION) << "none at all";
  for (int i = 0; i < 3; ++i) scene.AddSatellite(120.0 * i, 40.0, 1, 0.0);
  EXPECT_EQ(scene.Solve(), LODEMARK_NO_POSITION);
  EXPECT_EQ(scene.solution.outcome, LODEMARK_OUTCOME_TOO_FEW);
  scene.AddSatellite(60.0, 80.0, 2, 0.0);  // brings its own clock
  EXPECT_EQ(scene.Solve(), LODEMARK_NO_POSITION);
  EXPECT_EQ(scene.solution.outcome, LODEMARK_OUTCOME_TOO_FEW);
}

TEST(PositionSolve, SaysWhenTheGeometryFixesNothing) {
  Scene scene;
  for (int i = 0; i < 6; ++i) scene.AddSatellite(100.0, 40.0, 1, 0.0);
  EXPECT_EQ(scene.Solve(), LODEMARK_NO_POSITION);
  EXPECT_EQ(scene.solution.outcome, LODEMARK_OUTCOME_NOT_CONVERGED);
}

TEST(PositionSolve, IgnoresTheOnlyRangeOfAGroup) {
  Scene scene;
  scene.AddSky();
  scene.AddSatellite(200.0, 45.0, 2, 12345.0);
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 1e-3);
  EXPECT_EQ(scene.solution.ranges_used, 8);
  EXPECT_EQ(scene.residuals[8].used, 0);
  EXPECT_EQ(scene.solution.clocks_present, 1u);
}

TEST(PositionSolve, DoesNotDependOnTheOrderOfTheRanges) {
  Scene scene;
  scene.AddSky();
  for (std::size_t i = 0; i < 8; ++i) scene.ranges[i].range_m += i % 3 == 0 ? 4.0 : -2.0;
  Scene turned = scene;
  std::reverse(turned.ranges.begin(), turned.ranges.end());
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  ASSERT_EQ(turned.Solve(), LODEMARK_OK);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(scene.solution.ecef_m[i], turned.solution.ecef_m[i], 1e-3);
  }
}

// The squared error, weighted by the stated covariance, is chi-square with 3 degrees of freedom;
// the mean of 400 lies within 0.4 of 3 (3.3 of its sigmas).
TEST(PositionSolve, StatesACovarianceThatHolds) {
  lodemark::Random random(7);
  double sum = 0.0;
  double within_accuracy = 0.0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    Scene scene;
    for (int i = 0; i < 9; ++i) {
      const double sigma_m = 2.0 + i % 3;
      scene.AddSatellite(40.0 * i, 10.0 + 8.0 * i, i < 6 ? 1 : 2, random.Gaussian(100.0, sigma_m),
                         sigma_m);
    }
    ASSERT_EQ(scene.Solve(), LODEMARK_OK);
    double enu_m[3];
    lodemark_enu_from_ecef(kPlace, scene.solution.ecef_m, enu_m);
    const Eigen::Map<const Eigen::Vector3d> error(enu_m);
    const Eigen::Map<const Eigen::Matrix3d> covariance(scene.solution.covariance_enu_m2);
    sum += error.dot(covariance.ldlt().solve(error));
    within_accuracy += std::hypot(enu_m[0], enu_m[1]) <= scene.solution.accuracy_m ? 1.0 : 0.0;
  }
  EXPECT_NEAR(sum / kTrials, 3.0, 0.4);
  EXPECT_NEAR(within_accuracy / kTrials, 0.68, 0.08);
}

TEST(PositionSolve, AcceptsAStartOnTopOfALandmark) {
  Scene scene;
  scene.AddSky();
  scene.Add({30.0, 0.0, 0.0}, LODEMARK_CLOCK_GROUP_NONE, 0.0, 0.1);
  scene.StartAt({30.0, 0.0, 0.0});
  ASSERT_EQ(scene.Solve(), LODEMARK_OK);
  EXPECT_LT(scene.Error_m(), 0.01);
}

}  // namespace
