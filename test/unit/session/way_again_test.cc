#include "core/session/way_again.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "core/base/random.h"
#include "core/fusion/motion_filter.h"
#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

constexpr std::int64_t kEverySecond_ns = 1'000'000'000;

// What an epoch is worth that errs much as those beside it do.
constexpr double kEpochSigma_m = 20.0;

// A phone at rest under eight satellites, whose phases say that it rests.
class Rest {
 public:
  explicit Rest(const RangeErrorModel& error) {
    for (int i = 0; i < 8; ++i)
      scene_.AddSatellite(45.0 * i, 25.0 + 15.0 * (i % 3), 0, kClock_m, error);
  }

  const Eigen::Vector3d& truth() const { return scene_.truth_in_ecef; }

  // errors_m: of the ranges; said_m, sigma_m: what the first time made of them.
  void Hear(const std::vector<double>& errors_m, const Eigen::Vector3d& said_m, double sigma_m) {
    HeardStep moment;
    moment.time_ns = 7 + kEverySecond_ns * static_cast<std::int64_t>(moments.size());
    moment.ranges = scene_.ranges;
    for (std::size_t i = 0; i < moment.ranges.size(); ++i) {
      const SatelliteId satellite = {System::kGps, static_cast<std::uint8_t>(i + 1)};
      moment.ranges[i].range_m += errors_m[i];
      moment.epoch_seconds = 1.0;
      moment.sources.push_back({satellite, '1', moment.ranges[i].error.sigma_m});
      moment.changes.push_back(
          {(moment.ranges[i].point_in_ecef - truth()).normalized(), 0.0, 0.01});
      moment.change_satellites.push_back(satellite);
    }
    moment.of_epoch = {truth() + said_m, Eigen::Matrix3d::Identity() / (sigma_m * sigma_m),
                       Eigen::Vector3d::Zero()};
    moments.push_back(moment);
  }

  // The first time along the way, a filter that heard what it was told.
  std::vector<MotionStep> Steps() const {
    std::vector<MotionStep> steps;
    MotionFilter filter;
    MotionVerdicts verdicts;
    for (const HeardStep& moment : moments) {
      if (!filter.started()) {
        filter.Start(moment.of_epoch.around_in_ecef, 100.0 * Eigen::Matrix3d::Identity());
      } else {
        filter.Advance(1.0, {}, moment.changes, moment.motion, &verdicts);
      }
      PositionStatement here;
      here.around_in_ecef = filter.position_in_ecef();
      filter.Hear(Together(here, moment.of_epoch));
      steps.push_back(filter.step());
    }
    return steps;
  }

  double LargestError(const std::vector<MotionState>& states) const {
    double largest_m = 0.0;
    for (const MotionState& state : states) {
      largest_m = std::max(largest_m, (state.mean.head<3>() - truth()).norm());
    }
    return largest_m;
  }

  std::vector<HeardStep> moments;

 private:
  RangeScene scene_;
};

// With noise alone there is nothing to judge anew: the answer is that of all ranges in one least
// squares adjustment, a clock for each epoch.
TEST(WayAgain, OfNoiseAloneItIsTheAdjustmentOfAll) {
  Rest rest({4.0, 0.0, 30.0});
  Random random(11);
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (int second = 0; second < 40; ++second) {
    std::vector<double> errors_m(8);
    for (double& error_m : errors_m) error_m = random.Gaussian(0.0, 2.0);
    rest.Hear(errors_m, Eigen::Vector3d::Zero(), kEpochSigma_m);
    for (std::size_t i = 0; i < errors_m.size(); ++i) {
      Eigen::Vector4d row;
      row << -rest.moments.back().changes[i].direction_in_ecef, 1.0;
      normal += row * row.transpose();
      right += row * errors_m[i];
    }
  }
  const Eigen::Vector3d expected_m = normal.ldlt().solve(right).head<3>();
  const std::vector<MotionStep> steps = rest.Steps();
  const std::vector<MotionState> states = GoAgain(steps, rest.moments);
  ASSERT_EQ(states.size(), steps.size());
  ASSERT_GT(expected_m.norm(), 0.3);  // there is something to find
  const Eigen::Vector3d middle_m = states[20].mean.head<3>() - rest.truth();
  EXPECT_LT((middle_m - expected_m).norm(), 0.15 * expected_m.norm());
}

// Three of eight satellites are reflected at first, and the first time along believed them.
TEST(WayAgain, WhatWasMisjudgedAtFirstIsJudgedByWhatCameLater) {
  Rest rest({4.0, 0.3, 30.0});
  Random random(12);
  for (int second = 0; second < 60; ++second) {
    std::vector<double> errors_m(8);
    for (double& error_m : errors_m) error_m = random.Gaussian(0.0, 2.0);
    const bool reflected = second < 20;
    for (std::size_t i = 0; i < 3 && reflected; ++i) errors_m[i] += 40.0;
    rest.Hear(errors_m, reflected ? Eigen::Vector3d(20.0, -12.0, 15.0) : Eigen::Vector3d::Zero(),
              kEpochSigma_m);
  }
  const std::vector<MotionStep> steps = rest.Steps();
  EXPECT_GT(rest.LargestError(SmoothMotion(steps)), 7.0);
  EXPECT_LT(rest.LargestError(GoAgain(steps, rest.moments)), 3.0);
}

TEST(WayAgain, PiecesThatNothingJoinsStayApart) {
  Rest rest({4.0, 0.0, 30.0});
  const std::vector<double> none(8, 0.0);
  for (int second = 0; second < 20; ++second) rest.Hear(none, Eigen::Vector3d::Zero(), 5.0);
  // The second piece is another place.
  const Eigen::Vector3d moved_m(300.0, -200.0, 100.0);
  for (std::size_t i = 10; i < 20; ++i) {
    for (RangeObservation& range : rest.moments[i].ranges) range.point_in_ecef += moved_m;
    rest.moments[i].of_epoch.around_in_ecef += moved_m;
  }
  std::vector<MotionStep> steps = rest.Steps();
  const auto second_half = rest.moments.begin() + 10;
  Rest second({4.0, 0.0, 30.0});
  second.moments.assign(second_half, rest.moments.end());
  const std::vector<MotionStep> second_steps = second.Steps();
  std::copy(second_steps.begin(), second_steps.end(), steps.begin() + 10);
  const std::vector<MotionState> states = GoAgain(steps, rest.moments);
  EXPECT_LT((states[9].mean.head<3>() - rest.truth()).norm(), 0.1);
  EXPECT_LT((states[10].mean.head<3>() - rest.truth() - moved_m).norm(), 0.1);
}

TEST(WayAgain, NothingHeardIsNothingSaid) {
  EXPECT_TRUE(GoAgain({}, {}).empty());
  Rest rest({4.0, 0.0, 30.0});
  for (int second = 0; second < 5; ++second) {
    rest.Hear(std::vector<double>(8, 0.0), Eigen::Vector3d::Zero(), 5.0);
    rest.moments.back().ranges.clear();
    rest.moments.back().sources.clear();
  }
  const std::vector<MotionStep> steps = rest.Steps();
  const std::vector<MotionState> states = GoAgain(steps, rest.moments);
  const std::vector<MotionState> smoothed = SmoothMotion(steps);
  ASSERT_EQ(states.size(), steps.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_LT((states[i].mean.head<3>() - smoothed[i].mean.head<3>()).norm(), 0.01);
  }
}

}  // namespace
}  // namespace lodemark
