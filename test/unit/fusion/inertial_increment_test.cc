#include "core/fusion/inertial_increment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/geo/rotation.h"
#include "test/unit/fusion/inertial_scene.h"

namespace lodemark::test {
namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;

// What one increment differs by from another, in the axes of the beginning.
Vector9 Difference(const InertialIncrement& one, const InertialIncrement& other) {
  Vector9 difference;
  difference << TurnOf(one.turn * other.turn.conjugate()), one.velocity_mps - other.velocity_mps,
      one.moved_m - other.moved_m;
  return difference;
}

// A constant force in a sensor that turns at a constant rate w about z: the integrals of cos and
// sin are known.
TEST(InertialIncrement, IsTheIntegralWhereItIsKnown) {
  constexpr double kTurnRate = 0.8;
  constexpr double kForce = 3.0;
  std::vector<InertialSample> samples;
  for (int i = 0; i <= 100; ++i) {
    InertialSample sample;
    sample.time_ns = 10'000'000LL * i;
    sample.turn_rate_radps = {0.0, 0.0, kTurnRate + 0.1};
    sample.specific_force_mps2 = {kForce, 0.5, 0.0};
    samples.push_back(sample);
  }
  InertialBiases biases;
  biases.turn_rate_radps = {0.0, 0.0, 0.1};
  biases.specific_force_mps2 = {0.0, 0.5, 0.0};
  const InertialIncrement felt = IntegrateInertial(samples, biases, InertialNoise());
  const double w = kTurnRate;
  EXPECT_NEAR(felt.seconds, 1.0, 1e-12);
  EXPECT_LT((TurnOf(felt.turn) - Eigen::Vector3d(0.0, 0.0, w)).norm(), 1e-12);
  EXPECT_NEAR(felt.velocity_mps.x(), kForce * std::sin(w) / w, 1e-4);
  EXPECT_NEAR(felt.velocity_mps.y(), kForce * (1.0 - std::cos(w)) / w, 1e-4);
  EXPECT_NEAR(felt.moved_m.x(), kForce * (1.0 - std::cos(w)) / (w * w), 1e-4);
  EXPECT_NEAR(felt.moved_m.y(), kForce * (w - std::sin(w)) / (w * w), 1e-4);
}

TEST(InertialIncrement, KnowsHowItHangsOnTheBiases) {
  const std::vector<InertialSample> samples = InertialScene().Felt(3.0, 5.0);
  const InertialBiases none;
  const InertialIncrement felt = IntegrateInertial(samples, none, InertialNoise());
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 6; ++i) {
    InertialBiases more;
    InertialBiases less;
    (i < 3 ? more.turn_rate_radps : more.specific_force_mps2)[i % 3] = kStep;
    (i < 3 ? less.turn_rate_radps : less.specific_force_mps2)[i % 3] = -kStep;
    const Vector9 slope = Difference(IntegrateInertial(samples, more, InertialNoise()),
                                     IntegrateInertial(samples, less, InertialNoise())) /
                          (2.0 * kStep);
    EXPECT_LT((felt.by_biases.col(i) - slope).norm(), 2e-3 * slope.norm()) << i;
  }
}

// Drawn noise scatters as stated: each variance within its own uncertainty over 400 draws, and
// turn with velocity with place together.
TEST(InertialIncrement, ScattersAsItSays) {
  const std::vector<InertialSample> samples = InertialScene().Felt(3.0, 5.0);
  const InertialNoise noise;
  const InertialIncrement felt = IntegrateInertial(samples, InertialBiases(), noise);
  Random random(5);
  // A sample's noise acts for its 10 ms.
  const double turn_rate = noise.turn_rate_radps_sqrt_s / std::sqrt(0.01);
  const double force = noise.specific_force_mps2_sqrt_s / std::sqrt(0.01);
  const Eigen::Matrix<double, 9, 9> whitener = felt.covariance.llt().matrixL();
  Eigen::Matrix<double, 9, 9> scatter = Eigen::Matrix<double, 9, 9>::Zero();
  constexpr int kDraws = 400;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<InertialSample> noisy = samples;
    for (InertialSample& sample : noisy) {
      for (int axis = 0; axis < 3; ++axis) {
        sample.turn_rate_radps[axis] += random.Gaussian(0.0, turn_rate);
        sample.specific_force_mps2[axis] += random.Gaussian(0.0, force);
      }
    }
    const Vector9 white = whitener.triangularView<Eigen::Lower>().solve(
        Difference(IntegrateInertial(noisy, InertialBiases(), noise), felt));
    scatter += white * white.transpose() / kDraws;
  }
  // Of an entry: 1 / sqrt(400), times sqrt(2) on the diagonal. The largest of 45 is some 3.3 of it.
  EXPECT_LT((scatter - Eigen::Matrix<double, 9, 9>::Identity()).cwiseAbs().maxCoeff(), 0.25);
}

TEST(InertialIncrement, IsNothingOfFewerThanTwoSamples) {
  const InertialIncrement none = IntegrateInertial({}, InertialBiases(), InertialNoise());
  EXPECT_EQ(none.seconds, 0.0);
  EXPECT_EQ(none.velocity_mps.norm(), 0.0);
}

}  // namespace
}  // namespace lodemark::test
