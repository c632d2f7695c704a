#include "core/fusion/weighted_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace lodemark {
namespace {

constexpr int kCount = 40;

WeightedSamples Scattered(Random* random) {
  WeightedSamples samples(kCount);
  for (std::size_t k = 0; k < samples.count(); ++k) {
    samples.SetPoint(
        k, {random->Gaussian(), random->Gaussian(), 1.0 + random->Gaussian(), random->Gaussian()});
    samples.weights()[k] = random->Uniform();
  }
  return samples;
}

TEST(WeightedSamples, HasRoomForAllInWholeVectors) {
  EXPECT_EQ(WeightedSamples(17).count() % WeightedSamples::kLanes, 0u);
  EXPECT_GE(WeightedSamples(17).count(), 17u);
  EXPECT_EQ(WeightedSamples(16).count(), 16u);
}

// The same expression, one sample at a time.
TEST(WeightedSamples, MultipliesByTheTabulatedDensityToTheLastBit) {
  Random random(1);
  WeightedSamples samples = Scattered(&random);
  const std::vector<double> before = samples.weights();
  DensityTable table;
  table.Fill({3.0, 0.3, 15.0});
  const Eigen::Vector4f slope(7.0f, -4.0f, 2.5f, 11.0f);
  constexpr float kConstant = 5.5f;
  samples.Multiply(table, kConstant, slope);
  for (std::size_t k = 0; k < samples.count(); ++k) {
    float error_m = kConstant;
    for (std::size_t i = 0; i < 4; ++i) {
      error_m += slope[static_cast<Eigen::Index>(i)] * static_cast<float>(samples.coordinate(i, k));
    }
    EXPECT_EQ(samples.weights()[k], before[k] * static_cast<double>(table(error_m))) << k;
  }
}

TEST(WeightedSamples, SumsWhatItHolds) {
  Random random(2);
  WeightedSamples samples = Scattered(&random);
  WeightedSums expected;
  for (std::size_t k = 0; k < samples.count(); ++k) {
    const double w = samples.weights()[k];
    const Eigen::Vector4d z(samples.coordinate(0, k), samples.coordinate(1, k),
                            samples.coordinate(2, k), samples.coordinate(3, k));
    expected.weights += w;
    expected.squared_weights += w * w;
    expected.first += w * z;
    expected.second += w * z * z.transpose();
  }
  const WeightedSums sums = samples.Sum();
  EXPECT_NEAR(sums.weights, expected.weights, 1e-12);
  EXPECT_NEAR(sums.squared_weights, expected.squared_weights, 1e-12);
  EXPECT_LT((sums.first - expected.first).norm(), 1e-12);
  EXPECT_LT((sums.second - expected.second).norm(), 1e-12);
}

TEST(WeightedSamples, NormalisesToALargestWeightOfOne) {
  Random random(3);
  WeightedSamples samples = Scattered(&random);
  for (double& weight : samples.weights()) weight *= 1e-250;
  samples.weights()[7] = 2e-250;
  samples.Normalise();
  EXPECT_DOUBLE_EQ(samples.weights()[7], 1.0);
  for (const double weight : samples.weights()) EXPECT_LE(weight, 1.0);
}

}  // namespace
}  // namespace lodemark
