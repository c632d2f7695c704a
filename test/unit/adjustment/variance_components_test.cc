#include "core/adjustment/variance_components.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

namespace lodemark {
namespace {

// Ranges of twelve satellites to an antenna with a clock, adjusted again and again: squares and
// redundancy numbers as an estimator would see them.
VarianceComponents Adjusted(const VarianceLaw& truth, const VarianceLaw& assumed, int epochs) {
  VarianceComponents components;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> sine(0.1, 1.0);
  std::uniform_real_distribution<double> azimuth_rad(0.0, 2.0 * std::acos(-1.0));
  std::normal_distribution<double> normal;
  constexpr int kRanges = 12;
  for (int epoch = 0; epoch < epochs; ++epoch) {
    Eigen::Matrix<double, kRanges, 4> design;
    Eigen::Matrix<double, kRanges, 1> error;
    Eigen::Matrix<double, kRanges, 1> weight;
    Eigen::Matrix<double, kRanges, 1> obliquity;
    for (int i = 0; i < kRanges; ++i) {
      const double s = sine(random);
      const double a = azimuth_rad(random);
      const double c = std::sqrt(1.0 - s * s);
      design.row(i) << -c * std::sin(a), -c * std::cos(a), -s, 1.0;
      obliquity[i] = 1.0 / (s * s);
      error[i] = std::sqrt(truth.constant + truth.proportional * obliquity[i]) * normal(random);
      weight[i] = 1.0 / (assumed.constant + assumed.proportional * obliquity[i]);
    }
    const Eigen::Matrix4d cofactor = (design.transpose() * weight.asDiagonal() * design).inverse();
    const Eigen::Vector4d solution = cofactor * design.transpose() * weight.asDiagonal() * error;
    const Eigen::Matrix<double, kRanges, 1> residual = error - design * solution;
    for (int i = 0; i < kRanges; ++i) {
      const Eigen::Vector4d row = design.row(i).transpose();
      components.Add(obliquity[i], residual[i] * residual[i],
                     1.0 - weight[i] * row.dot(cofactor * row));
    }
  }
  return components;
}

TEST(VarianceComponents, FindTheLawThatMadeTheErrors) {
  for (const VarianceLaw& truth : {VarianceLaw{1.0, 4.0}, VarianceLaw{9.0, 0.5}}) {
    // With the right weights the redundancy numbers are exact.
    const VarianceComponents components = Adjusted(truth, truth, 4000);
    const auto law = components.Estimate({1.0, 1.0});
    ASSERT_TRUE(law.has_value());
    EXPECT_NEAR(law->constant, truth.constant, 0.1 * (truth.constant + truth.proportional));
    EXPECT_NEAR(law->proportional, truth.proportional, 0.05 * (1.0 + truth.proportional));
  }
}

TEST(VarianceComponents, ConvergeOnTheLawThroughReweightedAdjustments) {
  const VarianceLaw truth = {4.0, 1.0};
  VarianceLaw law = {1.0, 1.0};
  for (int i = 0; i < 6; ++i) law = Adjusted(truth, law, 2000).Estimate(law).value();
  EXPECT_NEAR(law.constant, truth.constant, 0.4);
  EXPECT_NEAR(law.proportional, truth.proportional, 0.15);
}

TEST(VarianceComponents, DoNotDependOnTheStart) {
  const VarianceComponents components = Adjusted({2.0, 1.0}, {2.0, 1.0}, 300);
  const VarianceLaw one = components.Estimate({1.0, 1.0}).value();
  const VarianceLaw other = components.Estimate({100.0, 1e-3}).value();
  EXPECT_NEAR(one.constant, other.constant, 1e-6);
  EXPECT_NEAR(one.proportional, other.proportional, 1e-6);
}

TEST(VarianceComponents, AreExactOnExactSquares) {
  VarianceComponents components;
  for (int i = 0; i < 50; ++i) {
    const double coefficient = 1.0 + 0.7 * i;
    components.Add(coefficient, 0.4 * (3.0 + 2.0 * coefficient), 0.4);
  }
  EXPECT_NEAR(components.redundancy(), 20.0, 1e-9);
  const VarianceLaw law = components.Estimate({1.0, 1.0}).value();
  EXPECT_NEAR(law.constant, 3.0, 1e-6);
  EXPECT_NEAR(law.proportional, 2.0, 1e-6);
  // Fading old and new alike changes nothing.
  components.Fade(0.25);
  EXPECT_NEAR(components.Estimate({1.0, 1.0})->proportional, 2.0, 1e-6);
}

TEST(VarianceComponents, AreNeverNegative) {
  VarianceComponents falling;
  for (int i = 0; i < 50; ++i) falling.Add(1.0 + i, 100.0 / (1.0 + i), 1.0);
  const VarianceLaw constant_only = falling.Estimate({1.0, 1.0}).value();
  EXPECT_GT(constant_only.constant, 0.0);
  EXPECT_EQ(constant_only.proportional, 0.0);
  VarianceComponents steep;
  for (int i = 0; i < 50; ++i) steep.Add(1.0 + i, (1.0 + i) * (1.0 + i), 1.0);
  const VarianceLaw proportional_only = steep.Estimate({1.0, 1.0}).value();
  EXPECT_EQ(proportional_only.constant, 0.0);
  EXPECT_GT(proportional_only.proportional, 0.0);
}

TEST(VarianceComponents, SayNothingWithoutEvidence) {
  VarianceComponents components;
  EXPECT_FALSE(components.Estimate({1.0, 1.0}).has_value());
  for (int i = 0; i < 100; ++i) components.Add(2.0, 1.0, 0.5);
  EXPECT_FALSE(components.Estimate({1.0, 1.0}).has_value()) << "all coefficients alike";
  VarianceComponents poisoned;
  poisoned.Add(2.0, std::numeric_limits<double>::quiet_NaN(), 0.5);
  poisoned.Add(std::numeric_limits<double>::infinity(), 1.0, 0.5);
  poisoned.Add(-1.0, 1.0, 0.5);
  poisoned.Add(2.0, 1.0, 0.0);
  EXPECT_EQ(poisoned.redundancy(), 0.0);
}

}  // namespace
}  // namespace lodemark
