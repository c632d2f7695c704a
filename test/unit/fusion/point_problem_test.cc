#include "core/fusion/point_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

// Two satellite groups, one of them known against group 0 which is absent, and landmarks.
struct Mixed {
  Mixed() {
    scene.AddSky(4, 2, kClock_m + 30.0);
    scene.AddSky(3, 5, kClock_m - 700.0);
    scene.AddLandmark(40.0, 60.0, 12.0);
    scene.AddLandmark(290.0, 45.0, -3.0);
    biases.Set(2, {25.0, 5.0});
    problem.emplace(scene.ranges, biases, HeightPrior{170.0, 8.0}, &rows);
    problem->MoveTo(scene.Beside({30.0, -20.0, 15.0}));
    problem->GuessClocks();
  }

  RangeScene scene;
  ClockBiases biases;
  std::vector<PointProblem::Row> rows;
  std::optional<PointProblem> problem;
};

// Derivative by an unknown of something that depends on the state, which stays as it was.
template <typename Function>
double Derivative(const PointProblem& problem, int unknown, double step_m,
                  std::vector<PointProblem::Row>* rows, Function function) {
  const std::vector<PointProblem::Row> kept = *rows;
  double values[2];
  for (const int side : {0, 1}) {
    PointProblem moved = problem;
    PointVector step = PointVector::Zero(problem.unknowns());
    step[unknown] = side == 0 ? -step_m : step_m;
    moved.Step(step);
    values[side] = function(moved);
    *rows = kept;
  }
  return (values[1] - values[0]) / (2.0 * step_m);
}

TEST(PointProblem, EverySlopeIsTheDerivativeOfTheRange) {
  Mixed mixed;
  const int unknowns = mixed.problem->unknowns();
  for (std::size_t i = 0; i < mixed.rows.size(); ++i) {
    PointMatrix normal = PointMatrix::Zero(unknowns, unknowns);
    PointVector right = PointVector::Zero(unknowns);
    mixed.problem->Accumulate(mixed.rows[i], 2.5, 1.0, &normal, &right);
    for (int k = 0; k < unknowns; ++k) {
      const double slope =
          Derivative(*mixed.problem, k, 0.1, &mixed.rows,
                     [&](const PointProblem& p) { return -p.Residual(p.rows()[i]); });
      EXPECT_NEAR(right[k], slope, 1e-5) << "row " << i << " unknown " << k;
    }
    // The upper half, which is all that the factorisation reads.
    const PointMatrix product = 2.5 * right * right.transpose();
    for (int k = 0; k < unknowns; ++k) {
      for (int j = 0; j <= k; ++j) EXPECT_NEAR(normal(j, k), product(j, k), 1e-12);
    }
  }
}

TEST(PointProblem, PriorNormalsAreTheDerivativesOfTheirCost) {
  Mixed mixed;
  const int unknowns = mixed.problem->unknowns();
  PointMatrix normal = PointMatrix::Zero(unknowns, unknowns);
  PointVector right = PointVector::Zero(unknowns);
  mixed.problem->AccumulatePriors(&normal, &right);
  for (int k = 0; k < unknowns; ++k) {
    const auto cost = [](const PointProblem& p) { return p.PriorCost(); };
    const double gradient = Derivative(*mixed.problem, k, 0.5, &mixed.rows, cost);
    EXPECT_NEAR(right[k], -gradient, 1e-4) << k;
    const auto pull = [&](const PointProblem& p) {
      PointMatrix unused = PointMatrix::Zero(unknowns, unknowns);
      PointVector moved = PointVector::Zero(unknowns);
      p.AccumulatePriors(&unused, &moved);
      return moved[k];
    };
    EXPECT_NEAR(normal(k, k), -Derivative(*mixed.problem, k, 0.5, &mixed.rows, pull), 1e-5) << k;
  }
}

TEST(PointProblem, StepsInItsOwnEastNorthUp) {
  Mixed mixed;
  const Eigen::Vector3d before = mixed.problem->point_in_ecef();
  const Eigen::Matrix3d enu_from_ecef = mixed.problem->enu_from_ecef();
  const PointVector clocks = mixed.problem->clock_state();
  PointVector step(mixed.problem->unknowns());
  step << 3.0, -4.0, 5.0, 6.0, -7.0;
  mixed.problem->Step(step);
  const Eigen::Vector3d moved = enu_from_ecef * (mixed.problem->point_in_ecef() - before);
  EXPECT_LT((moved - Eigen::Vector3d(3.0, -4.0, 5.0)).norm(), 1e-8);
  EXPECT_NEAR(mixed.problem->clock_state()[0], clocks[0] + 6.0, 1e-9);
  EXPECT_NEAR(mixed.problem->clock_state()[1], clocks[1] - 7.0, 1e-9);
}

TEST(PointProblem, KeepsClocksAndRedoesRowsWhenMoved) {
  Mixed mixed;
  const PointVector clocks = mixed.problem->clock_state();
  mixed.problem->MoveTo(mixed.scene.truth_in_ecef);
  EXPECT_EQ(mixed.problem->clock_state(), clocks);
  for (std::size_t i = 0; i < mixed.rows.size(); ++i) {
    const RangeObservation& range = mixed.scene.ranges[i];
    const Eigen::Vector3d line = range.point_in_ecef - mixed.scene.truth_in_ecef;
    EXPECT_NEAR(mixed.rows[i].misclosure_m, range.range_m - line.norm(), 1e-9);
    EXPECT_LT(
        (mixed.problem->enu_from_ecef().transpose() * mixed.rows[i].direction - line.normalized())
            .norm(),
        1e-14);
  }
}

TEST(PointProblem, HeightMisclosureIsWhatTheHeightLacks) {
  Mixed mixed;
  mixed.problem->MoveTo(mixed.scene.truth_in_ecef);
  EXPECT_NEAR(mixed.problem->height_residual_m(0.0), 170.0 - 180.0, 1e-6);
  EXPECT_NEAR(mixed.problem->height_residual_m(-4.0), 170.0 - 176.0, 1e-6);
}

TEST(PointProblem, PivotIsTheGroupBestKnownThenTheLargest) {
  RangeScene scene;
  scene.AddSky(2, 1);
  scene.AddSky(5, 3);
  scene.AddSky(3, 7);
  std::vector<PointProblem::Row> rows;
  ClockBiases biases;
  const PointProblem unknown(scene.ranges, biases, std::nullopt, &rows);
  EXPECT_EQ(unknown.group(0), 3) << "nothing known: the largest";
  EXPECT_EQ(unknown.members(0), 5);
  EXPECT_EQ(unknown.clocks(), 3);
  EXPECT_EQ(unknown.unknowns(), 6);

  biases.Set(7, {10.0, 2.0});
  biases.Set(1, {-4.0, 1.0});
  const PointProblem known(scene.ranges, biases, std::nullopt, &rows);
  EXPECT_EQ(known.group(0), 1) << "the best known";
  // The others against it: differences of the means, both uncertainties.
  for (int clock = 1; clock < known.clocks(); ++clock) {
    if (known.group(clock) != 7) continue;
    EXPECT_DOUBLE_EQ(known.prior_m(clock), 14.0);
    EXPECT_DOUBLE_EQ(known.prior_sigma_m(clock), std::hypot(2.0, 1.0));
  }
}

TEST(PointProblem, AClockIsSharedByTwoRangesOrByAKnownBias) {
  RangeScene scene;
  scene.AddSky(1, 0);
  scene.AddSky(3, 4);
  scene.AddSky(1, 6);
  std::vector<PointProblem::Row> rows;
  ClockBiases biases;
  const PointProblem unknown(scene.ranges, biases, std::nullopt, &rows);
  ASSERT_EQ(unknown.group(0), 0) << "the best known, though alone";
  for (int clock = 0; clock < 3; ++clock) {
    EXPECT_EQ(unknown.IsShared(clock), unknown.group(clock) == 4);
  }
  biases.Set(6, {20.0, 3.0});
  const PointProblem known(scene.ranges, biases, std::nullopt, &rows);
  for (int clock = 0; clock < 3; ++clock) EXPECT_TRUE(known.IsShared(clock));
}

TEST(PointProblem, NumbersRowsByTheirGroup) {
  Mixed mixed;
  for (std::size_t i = 0; i < mixed.rows.size(); ++i) {
    const int group = mixed.scene.ranges[i].clock_group;
    if (group == kNoClock) {
      EXPECT_EQ(mixed.rows[i].clock, -1);
      EXPECT_EQ(mixed.problem->ClockOf(mixed.rows[i]), 0.0);
    } else {
      EXPECT_EQ(mixed.problem->group(mixed.rows[i].clock), group);
    }
  }
}

TEST(PointProblem, GuessesClocksThroughOutliersAndHeedsWhatIsKnown) {
  RangeScene scene;
  scene.AddSky(5, 0, 1000.0);
  scene.AddSky(5, 4, 3500.0);
  scene.ranges[1].range_m += 5e5;
  scene.ranges[7].range_m -= 5e5;
  std::vector<PointProblem::Row> rows;
  ClockBiases biases;
  PointProblem unknown(scene.ranges, biases, std::nullopt, &rows);
  unknown.MoveTo(scene.truth_in_ecef);
  unknown.GuessClocks();
  EXPECT_NEAR(unknown.clock_state()[0], 1000.0, 1e-6);
  EXPECT_NEAR(unknown.clock_state()[1], 2500.0, 1e-6);

  biases.Set(4, {2480.0, 10.0});
  PointProblem known(scene.ranges, biases, std::nullopt, &rows);
  known.MoveTo(scene.truth_in_ecef);
  known.GuessClocks();
  EXPECT_EQ(known.clock_state()[1], 2480.0);
}

}  // namespace
}  // namespace lodemark
