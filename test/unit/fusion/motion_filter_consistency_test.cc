// The motion filter against a plain Kalman filter, and its covariance against scatter.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/fusion/motion_filter.h"
#include "test/unit/fusion/motion_scene.h"

namespace lodemark::test {
namespace {

const MotionModel kModel{{1.0, 1.0, 0.05}};

// Moves by its own laws: a draw of the filter's model.
class Walker {
 public:
  explicit Walker(std::uint64_t seed) : random_(seed) {
    MotionMatrix first = MotionMatrix::Zero();
    const Eigen::Matrix3d any = Eigen::Vector3d(225.0, 225.0, 4.0).asDiagonal();
    first.topLeftCorner<3, 3>() = EcefFromEnu() * started_m2() * EcefFromEnu().transpose();
    first.bottomRightCorner<3, 3>() = EcefFromEnu() * any * EcefFromEnu().transpose();
    state = Drawn(first, &random_);
    state.head<3>() += MotionStart();
  }
  static Eigen::Matrix3d started_m2() { return Eigen::Vector3d(16.0, 16.0, 49.0).asDiagonal(); }

  void Walk(double seconds) {
    const Eigen::Vector3d before = state.head<3>();
    state = MotionTransition(seconds) * state + Drawn(MotionNoise(kModel, seconds), &random_);
    moved_m = state.head<3>() - before;
    drift_mps += random_.Gaussian(0.0, 0.3);
  }
  Random* random() { return &random_; }

  MotionVector state;
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();
  double drift_mps = 80.0;

 private:
  Random random_;
};

// The textbook's: the state before is cloned beside the one after, clocks are anything, and one
// observation after the other is heard by its gain. In long double, since it subtracts.
class PlainFilter {
 public:
  using Matrix = Eigen::Matrix<long double, 14, 14>;
  using Vector = Eigen::Matrix<long double, 14, 1>;

  explicit PlainFilter(const MotionFilter& filter) {
    state_.setZero();
    covariance_.setZero();
    state_.segment<6>(6) = StateOf(filter).cast<long double>();
    covariance_.block<6, 6>(6, 6) = CovarianceOf(filter).cast<long double>();
  }

  void Advance(double seconds) {
    Eigen::Matrix<long double, 14, 14> transition = Matrix::Zero();
    transition.block<6, 6>(0, 6).setIdentity();
    transition.block<6, 6>(6, 6) = MotionTransition(seconds).cast<long double>();
    state_ = (transition * state_).eval();
    covariance_ = (transition * covariance_ * transition.transpose()).eval();
    covariance_.block<6, 6>(6, 6) += MotionNoise(kModel, seconds).cast<long double>();
    covariance_(12, 12) = 1e10L;
    covariance_(13, 13) = 1e10L;
  }
  void Hear(const RangeRateObservation& rate) {
    Vector slope = Vector::Zero();
    slope.segment<3>(9) = -rate.direction_in_ecef.cast<long double>();
    slope[12] = 1.0L;
    Hear(slope, rate.rate_mps, rate.sigma_mps);
  }
  void Hear(const RangeChangeObservation& change) {
    Vector slope = Vector::Zero();
    slope.segment<3>(0) = change.direction_in_ecef.cast<long double>();
    slope.segment<3>(6) = -change.direction_in_ecef.cast<long double>();
    slope[13] = 1.0L;
    Hear(slope, change.change_m, change.sigma_m);
  }
  // A position with independent errors along the axes of a frame.
  void Hear(const Eigen::Vector3d& position, double sigma_m) {
    for (int axis = 0; axis < 3; ++axis) {
      Hear(Vector::Unit(6 + axis), position[axis], sigma_m);
    }
  }
  MotionVector state() const { return state_.segment<6>(6).cast<double>(); }
  MotionMatrix covariance() const { return covariance_.block<6, 6>(6, 6).cast<double>(); }

 private:
  void Hear(const Vector& slope, double measured, double sigma) {
    const Vector cross = covariance_ * slope;
    const long double variance = slope.dot(cross) + static_cast<long double>(sigma) * sigma;
    state_ += cross / variance * (measured - slope.dot(state_));
    covariance_ -= cross * cross.transpose() / variance;
  }

  Vector state_;
  Matrix covariance_;
};

// Where nothing contradicts anything, robustness is no excuse: noise of a hundredth of what is
// stated leaves every kernel at its top, as small sigmas beside what the motion allows do.
TEST(MotionFilterConsistency, WithoutOutliersItIsThePlainKalmanFilter) {
  const std::vector<Eigen::Vector3d> sky = SkyDirections(12);
  Walker walker(21);
  MotionFilter filter;
  filter.Start(MotionStart(), Walker::started_m2());
  PlainFilter plain(filter);
  MotionVerdicts verdicts;
  for (int step = 1; step <= 25; ++step) {
    const double seconds = step % 3 == 0 ? 0.5 : 1.0;
    walker.Walk(seconds);
    const std::vector<RangeRateObservation> rates =
        RatesOf(sky, walker.state.tail<3>(), walker.drift_mps, 0.02, 0.01, walker.random());
    const std::vector<RangeChangeObservation> changes =
        ChangesOf(sky, walker.moved_m, 90.0, 0.004, 0.01, walker.random());
    const bool by_rates = step % 4 != 0;
    const bool by_changes = step % 5 != 0;
    filter.Advance(seconds, by_rates ? rates : std::vector<RangeRateObservation>(),
                   by_changes ? changes : std::vector<RangeChangeObservation>(), kModel, &verdicts);
    plain.Advance(seconds);
    for (const RangeRateObservation& rate : rates) {
      if (by_rates) plain.Hear(rate);
    }
    for (const RangeChangeObservation& change : changes) {
      if (by_changes) plain.Hear(change);
    }
    if (step % 6 == 0) {
      const Eigen::Vector3d said = walker.state.head<3>() + Eigen::Vector3d(1.0, -2.0, 0.5);
      filter.Hear(StatedAt(filter, said, Eigen::Matrix3d::Identity() / 9.0));
      plain.Hear(said, 3.0);
    }
    const MotionMatrix covariance = plain.covariance();
    const MotionVector off = StateOf(filter) - plain.state();
    for (int i = 0; i < 6; ++i) {
      EXPECT_LT(std::abs(off[i]), 0.01 * std::sqrt(covariance(i, i))) << step << " " << i;
    }
    EXPECT_TRUE(CovarianceOf(filter).isApprox(covariance, 2e-3)) << step;
    const Eigen::Matrix3d of_velocity = covariance.bottomRightCorner<3, 3>();
    EXPECT_NEAR(filter.VelocityCovarianceEnu().trace() / of_velocity.trace(), 1.0, 5e-3);
  }
}

struct Scatter {
  double early = 0.0;  // means of the squared error in units of the covariance, per dimension
  double late = 0.0;
};

// Epochs of all satellites' rates and changes; every third step a position to 4 m. Noise as
// stated.
Scatter ScatterOf(int satellites, bool rates, bool changes, int trials) {
  const std::vector<Eigen::Vector3d> sky = SkyDirections(satellites);
  Scatter scatter;
  MotionVerdicts verdicts;
  for (int trial = 0; trial < trials; ++trial) {
    Walker walker(1000 + static_cast<std::uint64_t>(trial));
    MotionFilter filter;
    filter.Start(MotionStart(), Walker::started_m2());
    for (int step = 1; step <= 20; ++step) {
      walker.Walk(1.0);
      filter.Advance(
          1.0,
          rates ? RatesOf(sky, walker.state.tail<3>(), walker.drift_mps, 0.1, 1.0, walker.random())
                : std::vector<RangeRateObservation>(),
          changes ? ChangesOf(sky, walker.moved_m, 90.0, 0.01, 1.0, walker.random())
                  : std::vector<RangeChangeObservation>(),
          kModel, &verdicts);
      if (step % 3 == 0) {
        const Eigen::Vector3d drawn(walker.random()->Gaussian(), walker.random()->Gaussian(),
                                    walker.random()->Gaussian());
        filter.Hear(StatedAt(filter, walker.state.head<3>() + 4.0 * drawn,
                             Eigen::Matrix3d::Identity() / 16.0));
      }
      if (step != 2 && step != 20) continue;
      const MotionVector off = StateOf(filter) - walker.state;
      const Eigen::LDLT<MotionMatrix> covariance(CovarianceOf(filter));
      const double normalised = off.dot(covariance.solve(off)) / (6.0 * trials);
      (step == 2 ? scatter.early : scatter.late) += normalised;
    }
  }
  return scatter;
}

// The mean over 120 trials of chi squared with 6 degrees, per degree, is within 3.3 sigmas of 1.
constexpr int kTrials = 120;
const double kBand = 3.3 * std::sqrt(2.0 / (6.0 * kTrials));

TEST(MotionFilterConsistency, ScatterOfStatementsAloneIsTheCovariance) {
  const Scatter scatter = ScatterOf(0, false, false, kTrials);
  EXPECT_NEAR(scatter.early, 1.0, kBand);
  EXPECT_NEAR(scatter.late, 1.0, kBand);
}

// A kernel of three sigmas counts an ordinary error as 0.8 of one, so what it makes of ordinary
// noise is stated a little larger than it scatters, never smaller.
TEST(MotionFilterConsistency, ScatterOfRatesAndPhasesIsWithinTheCovariance) {
  for (const bool rates : {true, false}) {
    for (const bool changes : {true, false}) {
      if (!rates && !changes) continue;
      const Scatter scatter = ScatterOf(12, rates, changes, kTrials);
      for (const double normalised : {scatter.early, scatter.late}) {
        EXPECT_LT(normalised, 1.0 + kBand) << rates << changes;
        EXPECT_GT(normalised, 0.75 - kBand) << rates << changes;
      }
    }
  }
}

}  // namespace
}  // namespace lodemark::test
