#include "core/fusion/inertial_alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/geo/gravity.h"
#include "core/geo/rotation.h"
#include "test/unit/fusion/inertial_scene.h"

namespace lodemark::test {
namespace {

class InertialAlignmentTest : public ::testing::Test {
 protected:
  // Samples with constant errors; velocities with noise.
  void Add(int from_s, int to_s, const InertialBiases& biases) {
    Eigen::Vector3d before = Measured(from_s);
    for (int s = from_s; s < to_s; ++s) {
      std::vector<InertialSample> samples = scene_.Felt(s, s + 1);
      for (InertialSample& sample : samples) {
        sample.turn_rate_radps += biases.turn_rate_radps;
        sample.specific_force_mps2 += biases.specific_force_mps2;
      }
      const Eigen::Vector3d after = Measured(s + 1);
      FeltStretch stretch;
      stretch.felt = IntegrateInertial(samples, InertialBiases(), InertialNoise());
      stretch.gained_in_ecef_mps = after - before - GravityInEcef(scene_.PlaceAt(s));
      stretch.sigma_mps = 0.05 * std::sqrt(2.0);
      alignment_.Add(stretch);
      before = after;
    }
  }
  Eigen::Vector3d Measured(double seconds) {
    Eigen::Vector3d velocity = scene_.VelocityAt(seconds);
    for (int axis = 0; axis < 3; ++axis) velocity[axis] += random_.Gaussian(0.0, 0.05);
    return velocity;
  }
  std::optional<InertialAlignmentResult> Solve() const {
    return alignment_.Solve(scene_.enu_from_ecef().row(2).transpose());
  }

  InertialScene scene_;
  Random random_{11};
  InertialAlignment alignment_;
};

// However it lies in the car, and whatever its biases: within three of its own sigmas.
TEST_F(InertialAlignmentTest, FindsHowTheSensorIsTurned) {
  InertialBiases biases;
  biases.turn_rate_radps = {0.03, -0.02, 0.04};
  biases.specific_force_mps2 = {0.1, -0.2, 0.1};
  Add(0, 20, biases);
  const auto aligned = Solve();
  ASSERT_TRUE(aligned);
  const Eigen::Vector3d error =
      TurnOf(scene_.EcefFromSensor(20.0) * aligned->ecef_from_sensor.conjugate());
  Eigen::Matrix<double, 9, 1> errors;
  errors << error, biases.turn_rate_radps - aligned->biases.turn_rate_radps,
      biases.specific_force_mps2 - aligned->biases.specific_force_mps2;
  EXPECT_LT(error.norm(), 10.0 * kRadiansPerDegree);
  EXPECT_LT(errors.dot(aligned->covariance.ldlt().solve(errors)), 9.0 * 3.0);
  EXPECT_LT(aligned->strain, 2.5);
}

// Straight on at one speed says nothing of the heading.
TEST_F(InertialAlignmentTest, DoesNotGuessTheHeading) {
  const Eigen::Vector3d gravity = GravityInEcef(scene_.PlaceAt(0.0));
  for (int s = 0; s < 40; ++s) {
    std::vector<InertialSample> samples(101);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].time_ns = 10'000'000LL * static_cast<std::int64_t>(i);
      samples[i].specific_force_mps2 = {0.0, 0.0, gravity.norm()};
      for (int axis = 0; axis < 3; ++axis) {
        samples[i].specific_force_mps2[axis] += random_.Gaussian(0.0, 0.1);
      }
    }
    FeltStretch stretch;
    stretch.felt = IntegrateInertial(samples, InertialBiases(), InertialNoise());
    stretch.gained_in_ecef_mps = -gravity;
    for (int axis = 0; axis < 3; ++axis) {
      stretch.gained_in_ecef_mps[axis] += random_.Gaussian(0.0, 0.07);
    }
    stretch.sigma_mps = 0.07;
    alignment_.Add(stretch);
    EXPECT_FALSE(Solve()) << s;
  }
}

// Two axes changed over: after some bends no turn makes of it what was moved.
TEST_F(InertialAlignmentTest, RefusesASensorThatMovesOtherwise) {
  Eigen::Vector3d before = Measured(0.0);
  for (int s = 0; s < 40; ++s) {
    std::vector<InertialSample> samples = scene_.Felt(s, s + 1);
    for (InertialSample& sample : samples) {
      std::swap(sample.turn_rate_radps.x(), sample.turn_rate_radps.y());
      std::swap(sample.specific_force_mps2.x(), sample.specific_force_mps2.y());
    }
    const Eigen::Vector3d after = Measured(s + 1);
    FeltStretch stretch;
    stretch.felt = IntegrateInertial(samples, InertialBiases(), InertialNoise());
    stretch.gained_in_ecef_mps = after - before - GravityInEcef(scene_.PlaceAt(s));
    stretch.sigma_mps = 0.07;
    alignment_.Add(stretch);
    before = after;
    EXPECT_TRUE(s < 20 || !Solve()) << s;
  }
}

TEST_F(InertialAlignmentTest, WaitsForAFewStretches) {
  Add(0, 7, InertialBiases());
  EXPECT_FALSE(Solve());
  alignment_.Forget();
  EXPECT_EQ(alignment_.size(), 0U);
}

}  // namespace
}  // namespace lodemark::test
