#include "core/session/accuracy.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace lodemark {
namespace {

Eigen::Matrix2d Ellipse(double major_m, double minor_m, double turn_rad) {
  Eigen::Matrix2d axes;
  axes << std::cos(turn_rad), -std::sin(turn_rad), std::sin(turn_rad), std::cos(turn_rad);
  const Eigen::Vector2d variances(major_m * major_m, minor_m * minor_m);
  return axes * variances.asDiagonal() * axes.transpose();
}

TEST(RadiusOfProbability, IsRayleighsForACircle) {
  for (const double probability : {0.3, 0.5, 0.68, 0.95, 0.999}) {
    const double expected = std::sqrt(-2.0 * std::log(1.0 - probability));
    EXPECT_NEAR(RadiusOfProbability(Ellipse(1.0, 1.0, 0.0), probability), expected,
                1e-3 * expected);
    EXPECT_NEAR(RadiusOfProbability(Ellipse(7.0, 7.0, 1.0), probability), 7.0 * expected,
                7e-3 * expected);
  }
}

TEST(RadiusOfProbability, IsTheNormalQuantileAlongALine) {
  // Two-sided quantiles of the normal distribution.
  const double expected[][2] = {{0.5, 0.67449}, {0.68, 0.99446}, {0.95, 1.95996}, {0.99, 2.57583}};
  for (const auto& [probability, quantile] : expected) {
    EXPECT_NEAR(RadiusOfProbability(Ellipse(1.0, 0.0, 0.4), probability), quantile,
                1e-3 * quantile);
  }
}

TEST(RadiusOfProbability, AgreesWithHartersTable) {
  // Harter (1960), Circular error probabilities, JASA 55: radius that holds one half, by the ratio
  // of the standard deviations.
  const double table[][2] = {{0.1, 0.68199}, {0.2, 0.70585}, {0.3, 0.74993}, {0.4, 0.80785},
                             {0.5, 0.87042}, {0.6, 0.93365}, {0.7, 0.99621}, {0.8, 1.05769},
                             {0.9, 1.11807}, {1.0, 1.17741}};
  for (const auto& [ratio, radius] : table) {
    EXPECT_NEAR(RadiusOfProbability(Ellipse(1.0, ratio, 0.0), 0.5), radius, 1e-3 * radius) << ratio;
  }
}

TEST(RadiusOfProbability, HoldsItsShareOfDraws) {
  const Eigen::Matrix2d covariance = Ellipse(6.0, 2.0, 0.7);
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const double radius_m = RadiusOfProbability(covariance, 0.68);
  int inside = 0;
  constexpr int kDraws = 200'000;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector2d draw(normal(random), normal(random));
    inside += (root * draw).norm() < radius_m ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / kDraws, 0.68, 0.004);
}

TEST(RadiusOfProbability, DoesNotDependOnTheDirection) {
  const double expected = RadiusOfProbability(Ellipse(5.0, 1.0, 0.0), 0.68);
  for (double turn_rad = 0.1; turn_rad < 3.0; turn_rad += 0.3) {
    EXPECT_NEAR(RadiusOfProbability(Ellipse(5.0, 1.0, turn_rad), 0.68), expected, 1e-6);
  }
}

TEST(RadiusOfProbability, IsNothingWithoutSpread) {
  EXPECT_EQ(RadiusOfProbability(Eigen::Matrix2d::Zero(), 0.68), 0.0);
}

}  // namespace
}  // namespace lodemark
