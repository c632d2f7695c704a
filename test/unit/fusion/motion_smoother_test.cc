#include "core/fusion/motion_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/fusion/motion_filter.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

constexpr int kMoments = 12;
constexpr double kInterval_s = 2.0;
const EnuFrame kFrame({0.8, 0.3, 150.0});

struct Way {
  std::vector<MotionStep> steps;
  Eigen::Vector3d origin_in_ecef;
  std::vector<Eigen::Vector3d> heard_in_ecef;  // of each moment, the first that of the start
};

double SigmaOf(int moment) { return 2.0 + moment % 3; }

// A filter that hears nothing but places.
Way Filtered(std::uint64_t seed) {
  Random random(seed);
  Way way;
  way.origin_in_ecef = kFrame.ToEcef({0.0, 0.0, 0.0});
  MotionFilter filter;
  MotionVerdicts verdicts;
  for (int i = 0; i < kMoments; ++i) {
    Eigen::Vector3d off;
    for (int axis = 0; axis < 3; ++axis) off[axis] = random.Gaussian(0.0, SigmaOf(i));
    const Eigen::Vector3d place = way.origin_in_ecef + off;
    way.heard_in_ecef.push_back(place);
    const Eigen::Matrix3d covariance = SigmaOf(i) * SigmaOf(i) * Eigen::Matrix3d::Identity();
    if (i == 0) {
      filter.Start(place, covariance);
    } else {
      filter.Advance(kInterval_s, {}, {}, MotionModel(), &verdicts);
      PositionStatement said = filter.Place();
      said.information_pm2 = covariance.inverse();
      said.pull_pm =
          said.information_pm2 * (EnuFromEcefRotation(GeodeticFromEcef(filter.position_in_ecef())) *
                                  (place - filter.position_in_ecef()));
      filter.Hear(said);
    }
    way.steps.push_back(filter.step());
  }
  return way;
}

// All states of all moments in one system of normal equations: what the smoother must come to.
std::vector<MotionState> Adjusted(const Way& way) {
  constexpr int kUnknowns = 6 * kMoments;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kUnknowns);
  // The velocity that a filter starts with is known as badly as this says.
  normal.block<3, 3>(3, 3) +=
      way.steps.front().filtered.covariance.bottomRightCorner<3, 3>().inverse();
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(GeodeticFromEcef(way.origin_in_ecef));
  const Eigen::Matrix3d density = enu_from_ecef.transpose() *
                                  MotionModel().acceleration_density_m2ps3.asDiagonal() *
                                  enu_from_ecef;
  const double t = kInterval_s;
  MotionMatrix noise;
  noise << density * (t * t * t / 3.0), density * (t * t / 2.0), density * (t * t / 2.0),
      density * t;
  Eigen::Matrix<double, 6, 12> motion;
  motion.setZero();
  motion.leftCols<6>().setIdentity();
  motion.block<3, 3>(0, 3) = t * Eigen::Matrix3d::Identity();
  motion.rightCols<6>() = -MotionMatrix::Identity();
  for (int i = 0; i < kMoments; ++i) {
    const double information = 1.0 / (SigmaOf(i) * SigmaOf(i));
    normal.block<3, 3>(6 * i, 6 * i).diagonal().array() += information;
    right.segment<3>(6 * i) +=
        information * (way.heard_in_ecef[static_cast<std::size_t>(i)] - way.origin_in_ecef);
    if (i > 0) {
      normal.block<12, 12>(6 * (i - 1), 6 * (i - 1)) +=
          motion.transpose() * noise.inverse() * motion;
    }
  }
  const Eigen::MatrixXd covariance = normal.inverse();
  const Eigen::VectorXd solution = covariance * right;
  std::vector<MotionState> states(kMoments);
  for (int i = 0; i < kMoments; ++i) {
    MotionState& state = states[static_cast<std::size_t>(i)];
    state.mean = solution.segment<6>(6 * i);
    state.mean.head<3>() += way.origin_in_ecef;
    state.covariance = covariance.block<6, 6>(6 * i, 6 * i);
  }
  return states;
}

TEST(SmoothMotion, ComesToTheAdjustmentOfAllMomentsAtOnce) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Way way = Filtered(seed);
    const std::vector<MotionState> smoothed = SmoothMotion(way.steps);
    const std::vector<MotionState> adjusted = Adjusted(way);
    ASSERT_EQ(smoothed.size(), adjusted.size());
    for (std::size_t i = 0; i < smoothed.size(); ++i) {
      // The filter turns its axes with the place, by some 1e-6 here.
      EXPECT_LT((smoothed[i].mean - adjusted[i].mean).norm(), 1e-4) << i;
      EXPECT_LT((smoothed[i].covariance - adjusted[i].covariance).norm(),
                1e-4 * adjusted[i].covariance.norm())
          << i;
    }
  }
}

TEST(SmoothMotion, KnowsNoMomentWorseThanTheFilterDid) {
  const Way way = Filtered(7);
  const std::vector<MotionState> smoothed = SmoothMotion(way.steps);
  for (std::size_t i = 0; i + 1 < smoothed.size(); ++i) {
    EXPECT_LT(smoothed[i].covariance.trace(), way.steps[i].filtered.covariance.trace()) << i;
  }
  EXPECT_EQ(smoothed.back().mean, way.steps.back().filtered.mean);
}

TEST(SmoothMotion, ABeginningHidesWhatCameAfterIt) {
  Way first = Filtered(3);
  const Way second = Filtered(4);
  const std::vector<MotionState> alone = SmoothMotion(first.steps);
  first.steps.insert(first.steps.end(), second.steps.begin(), second.steps.end());
  const std::vector<MotionState> both = SmoothMotion(first.steps);
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(both[i].mean, alone[i].mean) << i;
  EXPECT_TRUE(SmoothMotion({}).empty());
}

}  // namespace
}  // namespace lodemark
