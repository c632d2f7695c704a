#include "core/fusion/acceleration_memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace lodemark {
namespace {

Eigen::Vector3d Usual() { return MotionModel().acceleration_density_m2ps3; }

Eigen::Vector3d DensityAfter(const AccelerationMemory& memory, double silent_s = 0.0) {
  return memory.After(silent_s).acceleration_density_m2ps3;
}

AccelerationMemory Rested() {
  AccelerationMemory memory;
  for (int i = 0; i < 120; ++i) memory.Learn(1.0, Eigen::Vector3d::Zero());
  return memory;
}

TEST(AccelerationMemory, LearnsTheDensityThatVelocitiesWereDrawnWith) {
  for (const double seconds : {0.2, 1.0}) {
    Random random(3);
    AccelerationMemory memory;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    constexpr int kSteps = 20'000;
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector3d drawn(random.Gaussian(), random.Gaussian(), random.Gaussian());
      const Eigen::Vector3d sigma = (Eigen::Vector3d(1.5, 1.5, 0.2) * seconds).cwiseSqrt();
      memory.Learn(seconds, sigma.cwiseProduct(drawn));
      mean += DensityAfter(memory) / kSteps;
    }
    EXPECT_NEAR(mean.x(), 1.5, 0.1) << seconds;
    EXPECT_NEAR(mean.z(), 0.2, 0.02) << seconds;
  }
}

TEST(AccelerationMemory, WhichWayTheStreetRunsSaysNothing) {
  AccelerationMemory north;
  AccelerationMemory east;
  for (int i = 0; i < 20; ++i) {
    north.Learn(1.0, {0.0, 2.0, 0.1});
    east.Learn(1.0, {2.0, 0.0, 0.1});
  }
  EXPECT_EQ(DensityAfter(north), DensityAfter(east));
  EXPECT_EQ(DensityAfter(north).x(), DensityAfter(north).y());
}

TEST(AccelerationMemory, ARestEndsSometimeUnheardOf) {
  const AccelerationMemory memory = Rested();
  EXPECT_LT(DensityAfter(memory).x(), 0.2 * Usual().x());
  EXPECT_GT(DensityAfter(memory).minCoeff(), 0.0);
  double before = DensityAfter(memory).x();
  for (const double silent_s : {1.0, 5.0, 20.0, 100.0}) {
    const double now = DensityAfter(memory, silent_s).x();
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_NEAR(before, Usual().x(), 0.01);
}

TEST(AccelerationMemory, SilenceMakesNobodyCalmer) {
  AccelerationMemory memory;
  for (int i = 0; i < 60; ++i) memory.Learn(1.0, {2.0, 2.0, 0.4});
  EXPECT_GT(DensityAfter(memory).x(), 2.0 * Usual().x());
  EXPECT_EQ(DensityAfter(memory, 1000.0), DensityAfter(memory));
}

TEST(AccelerationMemory, NothingTakesItOutOfBounds) {
  AccelerationMemory memory;
  memory.Learn(1.0, {1e9, -1e9, 1e9});
  EXPECT_LT(DensityAfter(memory).maxCoeff(), 10.0);
  // And it comes to rest again.
  for (int i = 0; i < 120; ++i) memory.Learn(1.0, Eigen::Vector3d::Zero());
  EXPECT_EQ(DensityAfter(memory), DensityAfter(Rested()));
  memory.Forget();
  EXPECT_EQ(DensityAfter(memory), Usual());
}

}  // namespace
}  // namespace lodemark
