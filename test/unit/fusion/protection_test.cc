#include "core/fusion/protection.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "core/adjustment/distributions.h"
#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

constexpr double kKnownBias_m = 1e4;
constexpr double kRisk = 1e-5;

struct Linearised {
  explicit Linearised(const RangeScene& given, const ClockBiases& biases = ClockBiases())
      : scene(given), problem(scene.ranges, biases, std::nullopt, &rows) {
    problem.MoveTo(scene.truth_in_ecef);
    problem.GuessClocks();
    information = PointMatrix::Zero(problem.unknowns(), problem.unknowns());
    PointVector right = PointVector::Zero(problem.unknowns());
    for (const PointProblem::Row& row : rows) {
      weights.push_back(1.0 / (row.error.sigma_m * row.error.sigma_m));
      problem.Accumulate(row, weights.back(), 0.0, &information, &right);
    }
    problem.AccumulatePriors(&information, &right);
  }

  ProtectionLevels Levels(double spread_factor = 1.0, double risk = kRisk) const {
    return SeparationLevels(problem, information, weights, spread_factor, risk);
  }

  RangeScene scene;
  std::vector<PointProblem::Row> rows;
  PointProblem problem;
  std::vector<double> weights;
  PointMatrix information;
};

// One satellite overhead and n >= 3 evenly around at elevation e. With c = cos e, s = sin e:
// east and north have variance 2 / (n c^2) each; up and clock follow from the 2x2 rest.
TEST(Dilution, HasTheClosedFormOfAnEvenSky) {
  for (const int around : {3, 4, 7}) {
    for (const double elevation_deg : {5.0, 20.0, 45.0}) {
      RangeScene scene;
      scene.AddSatellite(0.0, 90.0);
      for (int i = 0; i < around; ++i) {
        scene.AddSatellite(360.0 * i / around, elevation_deg);
      }
      const Linearised at(scene);
      const DilutionOfPrecision dilution = Dilution(at.problem, at.weights, kKnownBias_m);
      const double s = std::sin(elevation_deg * kRadiansPerDegree);
      const double c2 = 1.0 - s * s;
      const double horizontal = std::sqrt(4.0 / (around * c2));
      // Normal equations of up and clock: [1 + n s^2, -(1 + n s); ., n + 1].
      const double determinant =
          (1.0 + around * s * s) * (around + 1.0) - std::pow(1.0 + around * s, 2);
      const double vertical = std::sqrt((around + 1.0) / determinant);
      const double time = std::sqrt((1.0 + around * s * s) / determinant);
      EXPECT_NEAR(dilution.horizontal, horizontal, 1e-6);
      EXPECT_NEAR(dilution.vertical, vertical, 1e-6);
      EXPECT_NEAR(dilution.time, time, 1e-6);
      EXPECT_NEAR(dilution.position, std::hypot(horizontal, vertical), 1e-6);
    }
  }
}

TEST(Dilution, OfLandmarksAloneHasNoTime) {
  RangeScene scene;
  scene.AddPoint({100.0, 0.0, 0.0}, kNoClock, 0.0, {0.1, 0.0, 30.0});
  scene.AddPoint({0.0, 100.0, 0.0}, kNoClock, 0.0, {5.0, 0.0, 30.0});
  scene.AddPoint({0.0, 0.0, 100.0}, kNoClock, 0.0, {0.5, 0.0, 30.0});
  const Linearised at(scene);
  const DilutionOfPrecision dilution = Dilution(at.problem, at.weights, kKnownBias_m);
  EXPECT_NEAR(dilution.horizontal, std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(dilution.vertical, 1.0, 1e-9);
  EXPECT_NEAR(dilution.position, std::sqrt(3.0), 1e-9);
  EXPECT_EQ(dilution.time, 0.0);
}

TEST(Dilution, AnUnknownClockCostsAndALoneRangeOfOneIsWorthless) {
  RangeScene one_system;
  one_system.AddSky(9);
  RangeScene two_systems = one_system;
  for (std::size_t i = 0; i < 4; ++i) two_systems.ranges[i].clock_group = 1;
  const Linearised one(one_system);
  const Linearised two(two_systems);
  ClockBiases learned;
  learned.Set(1, {0.0, 2.0});
  const Linearised known(two_systems, learned);
  const double alone = Dilution(one.problem, one.weights, kKnownBias_m).position;
  EXPECT_GT(Dilution(two.problem, two.weights, kKnownBias_m).position, 1.01 * alone);
  EXPECT_NEAR(Dilution(known.problem, known.weights, kKnownBias_m).position, alone, 1e-9);

  RangeScene with_lone = one_system;
  with_lone.AddSatellite(77.0, 66.0, 5);
  const Linearised lone(with_lone);
  EXPECT_NEAR(Dilution(lone.problem, lone.weights, kKnownBias_m).position, alone, 1e-9);
}

TEST(Dilution, CountsOnlyRowsOfWeight) {
  RangeScene scene;
  scene.AddSky(8);
  Linearised at(scene);
  const double all = Dilution(at.problem, at.weights, kKnownBias_m).position;
  at.weights[2] *= 1e-3;
  EXPECT_EQ(Dilution(at.problem, at.weights, kKnownBias_m).position, all);
  at.weights[2] = 0.0;
  EXPECT_GT(Dilution(at.problem, at.weights, kKnownBias_m).position, all);
  for (std::size_t i = 0; i < 5; ++i) at.weights[i] = 0.0;
  EXPECT_EQ(Dilution(at.problem, at.weights, kKnownBias_m).position, 0.0);
}

// Every row taken out and the rest solved anew.
TEST(SeparationLevels, AgreeWithLeavingOutEachRange) {
  RangeScene scene;
  scene.AddSky(8);
  Random random(23);
  for (RangeObservation& range : scene.ranges) range.range_m += random.Gaussian(0.0, 3.0);
  Linearised at(scene);
  const auto solve = [&](std::size_t without, Eigen::Matrix4d* covariance) -> Eigen::Vector4d {
    PointMatrix normal = PointMatrix::Zero(4, 4);
    PointVector right = PointVector::Zero(4);
    for (std::size_t i = 0; i < at.rows.size(); ++i) {
      if (i == without) continue;
      at.problem.Accumulate(at.rows[i], at.weights[i],
                            at.weights[i] * at.problem.Residual(at.rows[i]), &normal, &right);
    }
    const Eigen::Matrix4d full = normal.selfadjointView<Eigen::Upper>();
    *covariance = full.inverse();
    return *covariance * right;
  };
  Eigen::Matrix4d covariance;
  // At the solution of all.
  at.problem.Step(solve(at.rows.size(), &covariance));
  const double quantile = -NormalQuantile(0.5 * kRisk / 9.0);
  double vertical_m = quantile * std::sqrt(covariance(2, 2));
  double horizontal_m = 0.0;
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    const Eigen::Vector4d shift = solve(i, &covariance);
    vertical_m = std::max(vertical_m, std::abs(shift[2]) + quantile * std::sqrt(covariance(2, 2)));
    const Eigen::Matrix2d horizontal = covariance.topLeftCorner<2, 2>();
    const double sigma_m =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(horizontal).eigenvalues()[1]);
    horizontal_m = std::max(horizontal_m, shift.head<2>().norm() + quantile * sigma_m);
  }
  const ProtectionLevels levels = at.Levels();
  EXPECT_NEAR(levels.vertical_m, vertical_m, 1e-3 * vertical_m);
  EXPECT_NEAR(levels.horizontal_m, horizontal_m, 1e-3 * horizontal_m);
}

TEST(SeparationLevels, GrowWithAWeakGeometry) {
  RangeScene strong;
  strong.AddSky(10);
  RangeScene weak = strong;
  weak.ranges.resize(6);
  RangeScene street;  // everything along one line of sight, but for one
  for (int i = 0; i < 5; ++i) street.AddSatellite(10.0 + 8.0 * (i % 2), 25.0 + 13.0 * i);
  for (int i = 0; i < 4; ++i) street.AddSatellite(190.0 + 8.0 * (i % 2), 30.0 + 12.0 * i);
  street.AddSatellite(100.0, 20.0);
  const double strong_m = Linearised(strong).Levels().horizontal_m;
  EXPECT_GT(Linearised(weak).Levels().horizontal_m, 1.2 * strong_m);
  EXPECT_GT(Linearised(street).Levels().horizontal_m, 2.0 * strong_m);
}

TEST(SeparationLevels, GrowWithResidualSpreadAndSmallerRisk) {
  RangeScene scene;
  scene.AddSky(9);
  const ProtectionLevels clean = Linearised(scene).Levels();
  EXPECT_GT(Linearised(scene).Levels(2.0).horizontal_m, 1.9 * clean.horizontal_m);
  EXPECT_GT(Linearised(scene).Levels(1.0, 1e-9).vertical_m, 1.2 * clean.vertical_m);
  scene.ranges[4].range_m += 8.0;
  EXPECT_GT(Linearised(scene).Levels().horizontal_m, clean.horizontal_m + 0.5);
}

TEST(SeparationLevels, AreNoneWhereTheFaultOfOneRangeCouldNotBeSeen) {
  RangeScene scene;
  scene.AddSky(4);
  EXPECT_EQ(Linearised(scene).Levels().horizontal_m, 0.0);
  EXPECT_EQ(Linearised(scene).Levels().vertical_m, 0.0);
  scene.AddSatellite(77.0, 33.0);
  EXPECT_GT(Linearised(scene).Levels().horizontal_m, 0.0);
  EXPECT_GT(Linearised(scene).Levels().vertical_m, 0.0);
}

TEST(SeparationLevels, AreNotDeniedByARangeThatFindsItsOwnClockOnly) {
  RangeScene scene;
  scene.AddSky(7);
  const ProtectionLevels without = Linearised(scene).Levels();
  scene.AddSatellite(200.0, 50.0, 1, 55.0);  // of a system whose clock nobody knows
  const ProtectionLevels with = Linearised(scene).Levels();
  EXPECT_NEAR(with.horizontal_m, without.horizontal_m, 0.02 * without.horizontal_m);
  EXPECT_NEAR(with.vertical_m, without.vertical_m, 0.02 * without.vertical_m);
}

// East and north by four landmarks on the horizon, the height by one alone overhead.
TEST(SeparationLevels, AreStatedForTheDirectionsThatAreChecked) {
  constexpr double kFar_m = 1e6;
  RangeScene scene;
  for (const double sign : {-1.0, 1.0}) {
    scene.AddPoint({sign * kFar_m, 0.0, 0.0}, kNoClock, 0.0, {1.0, 0.0, 30.0});
    scene.AddPoint({0.0, sign * kFar_m, 0.0}, kNoClock, 0.0, {1.0, 0.0, 30.0});
  }
  scene.AddPoint({0.0, 0.0, kFar_m}, kNoClock, 0.0, {1.0, 0.0, 30.0});
  const ProtectionLevels levels = Linearised(scene).Levels();
  EXPECT_GT(levels.horizontal_m, 0.0);
  EXPECT_EQ(levels.vertical_m, 0.0);
}

}  // namespace
}  // namespace lodemark
