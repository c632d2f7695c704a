#include "tools/lodemark/compare_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace lodemark {
namespace {

EpochError ErrorAt(double east_m, double north_m) {
  EpochError error;
  error.east_m = east_m;
  error.north_m = north_m;
  return error;
}

TEST(SortedQuantile, IsLinearBetweenNeighbours) {
  const std::vector<double> sorted = {1.0, 2.0, 4.0, 8.0, 16.0};
  EXPECT_DOUBLE_EQ(SortedQuantile(sorted, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(SortedQuantile(sorted, 0.5), 4.0);
  EXPECT_DOUBLE_EQ(SortedQuantile(sorted, 0.625), 6.0);    // half way from 4 to 8
  EXPECT_NEAR(SortedQuantile(sorted, 0.95), 14.4, 1e-12);  // 8 + 0.8 * 8
  EXPECT_DOUBLE_EQ(SortedQuantile(sorted, 1.0), 16.0);
}

TEST(SortedQuantile, OfOneValueIsThatValue) {
  EXPECT_DOUBLE_EQ(SortedQuantile({7.5}, 0.0), 7.5);
  EXPECT_DOUBLE_EQ(SortedQuantile({7.5}, 0.95), 7.5);
}

TEST(SpreadOf, MatchesSumsDoneByHand) {
  const Spread spread = SpreadOf({-3.0, 1.0, 5.0, -7.0});
  EXPECT_EQ(spread.count, 4);
  EXPECT_DOUBLE_EQ(spread.mean, -1.0);             // (-3 + 1 + 5 - 7) / 4
  EXPECT_DOUBLE_EQ(spread.rmse, std::sqrt(21.0));  // (9 + 1 + 25 + 49) / 4
  EXPECT_DOUBLE_EQ(spread.p50, 4.0);               // of 1 3 5 7
  EXPECT_NEAR(spread.p68, 5.08, 1e-12);            // 5 + 0.04 * 2
  EXPECT_DOUBLE_EQ(spread.max, 7.0);
}

TEST(SpreadOf, NothingIsZero) {
  const Spread spread = SpreadOf({});
  EXPECT_EQ(spread.count, 0);
  EXPECT_EQ(spread.rmse, 0.0);
}

TEST(NormalisedHorizontalError, WeighsEachDirectionByItsOwnSigma) {
  // East sigma 2 m, north sigma 3 m, uncorrelated: (4/2, 6/3) lies sqrt(8) away.
  EXPECT_NEAR(*NormalisedHorizontalError(4.0, 6.0, {4.0, 0.0, 9.0}), std::sqrt(8.0), 1e-12);
  // Inverse of {2 1; 1 2} is {2 -1; -1 2} / 3; with (1, -1): (2 + 2 + 2) / 3 = 2.
  EXPECT_NEAR(*NormalisedHorizontalError(1.0, -1.0, {2.0, 1.0, 2.0}), std::sqrt(2.0), 1e-12);
}

TEST(NormalisedHorizontalError, IsEmptyWithoutAPositiveCovariance) {
  EXPECT_FALSE(NormalisedHorizontalError(1.0, 1.0, {0.0, 0.0, 1.0}).has_value());
  EXPECT_FALSE(NormalisedHorizontalError(1.0, 1.0, {1.0, 2.0, 1.0}).has_value());
  EXPECT_FALSE(NormalisedHorizontalError(1.0, 1.0, 0.0).has_value());
}

TEST(NormalisedHorizontalError, OfARadiusAgreesWithTheCircularCovariance) {
  // A circle of 1.509592 sigma holds 68 % of a circular normal distribution.
  const double sigma_m = 2.5;
  const double accuracy_m = 1.509592 * sigma_m;
  EXPECT_NEAR(*NormalisedHorizontalError(3.0, 4.0, accuracy_m), 5.0 / sigma_m, 1e-5);
}

TEST(NormalisedHorizontalError, ExceedsThreeInAboutOnePercentOfHonestErrors) {
  Random random(7);
  ErrorStatistics statistics;
  std::vector<EpochError> errors;
  for (int i = 0; i < 200'000; ++i) {
    const double first = random.Gaussian();
    const double second = random.Gaussian();
    // Covariance {4 2; 2 5}, whose Cholesky factor is {2 0; 1 2}.
    EpochError error = ErrorAt(2.0 * first, first + 2.0 * second);
    error.normalised = NormalisedHorizontalError(error.east_m, error.north_m, {4.0, 2.0, 5.0});
    errors.push_back(error);
  }
  // exp(-9/2) = 1.1109 %; five sigmas of the count are 0.12 %.
  EXPECT_NEAR(StatisticsOf(errors, 200'000).beyond_3_sigma.value(), 0.011109, 0.0012);
}

TEST(StatisticsOf, CountsCoverageAndClaims) {
  EpochError near = ErrorAt(3.0, 4.0);  // 5 m
  near.up_m = -12.0;                    // 13 m in space
  near.accuracy_m = 5.0;                // on the edge counts as within
  near.protection_level_m = 4.9;
  near.vertical_protection_level_m = 20.0;
  EpochError far = ErrorAt(6.0, 8.0);  // 10 m, no height known
  far.accuracy_m = 9.0;
  far.protection_level_m = 30.0;
  const ErrorStatistics statistics = StatisticsOf({near, far}, 8);
  EXPECT_DOUBLE_EQ(statistics.coverage(), 0.25);
  EXPECT_DOUBLE_EQ(statistics.horizontal_m.mean, 7.5);
  EXPECT_DOUBLE_EQ(statistics.three_d_m.rmse, 13.0);
  EXPECT_EQ(statistics.up_m.count, 1);
  EXPECT_DOUBLE_EQ(statistics.up_m.mean, -12.0);
  EXPECT_DOUBLE_EQ(statistics.within_accuracy.value(), 0.5);
  EXPECT_EQ(statistics.beyond_protection.count, 1);
  EXPECT_EQ(statistics.beyond_protection.of, 2);
  EXPECT_EQ(statistics.beyond_vertical_protection.count, 0);
  EXPECT_EQ(statistics.beyond_vertical_protection.of, 1);
  EXPECT_EQ(statistics.beyond_3_sigma.of, 0);
}

TEST(StatisticsOf, MeasuresVelocityWhereItIsKnown) {
  EpochError error = ErrorAt(0.0, 0.0);
  error.horizontal_velocity_mps = {0.3, -0.4};
  error.up_velocity_mps = -0.2;
  const ErrorStatistics statistics = StatisticsOf({error, ErrorAt(1.0, 0.0)}, 2);
  EXPECT_EQ(statistics.horizontal_velocity_mps.count, 1);
  EXPECT_DOUBLE_EQ(statistics.horizontal_velocity_mps.rmse, 0.5);
  EXPECT_DOUBLE_EQ(statistics.up_velocity_mps.mean, -0.2);
}

TEST(NormalisedSquaredError, CountsSigmasAlongTheAxesOfTheCovariance) {
  EXPECT_DOUBLE_EQ(*NormalisedSquaredError({1.0, 2.0, 2.0}, {1.0, 0.0, 1.0, 0.0, 0.0, 1.0}), 9.0);
  EXPECT_DOUBLE_EQ(*NormalisedSquaredError({2.0, 3.0, 8.0}, {4.0, 0.0, 9.0, 0.0, 0.0, 16.0}), 6.0);
  // An error along the long axis, east and north at once: variance 1 + 0.5 there.
  EXPECT_NEAR(*NormalisedSquaredError({1.0, 1.0, 0.0}, {1.0, 0.5, 1.0, 0.0, 0.0, 1.0}), 2.0 / 1.5,
              1e-12);
}

TEST(NormalisedSquaredError, IsEmptyForACovarianceThatIsNone) {
  EXPECT_FALSE(NormalisedSquaredError({1.0, 1.0, 1.0}, {1.0, 2.0, 1.0, 0.0, 0.0, 1.0}));
  EXPECT_FALSE(NormalisedSquaredError({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
  const double none = std::nan("");
  EXPECT_FALSE(NormalisedSquaredError({1.0, 1.0, 1.0}, {none, 0.0, 1.0, 0.0, 0.0, 1.0}));
  EXPECT_FALSE(NormalisedSquaredError({none, 1.0, 1.0}, {1.0, 0.0, 1.0, 0.0, 0.0, 1.0}));
}

}  // namespace
}  // namespace lodemark
