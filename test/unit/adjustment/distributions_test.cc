#include "core/adjustment/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lodemark {
namespace {

// Wichura, Algorithm AS 241 (Applied Statistics 37, 1988), whose results have 16 digits.
TEST(NormalQuantile, AgreesWithAnotherAlgorithm) {
  struct Row {
    double probability;
    double quantile;
  };
  constexpr Row kRows[] = {{1e-12, -7.034483825301131}, {1e-9, -5.997807015007687},
                           {1e-6, -4.753424308822899},  {1e-3, -3.090232306167813},
                           {0.16, -0.994457883209753},  {0.5, 0.0},
                           {0.9, 1.2815515655446004},   {0.975, 1.9599639845400536}};
  for (const Row& row : kRows) {
    EXPECT_NEAR(NormalQuantile(row.probability), row.quantile, 1e-9) << row.probability;
  }
}

// The share of a normal population within 1 ... 6 sigma, as printed in any table.
TEST(NormalCdf, HasTheTabulatedSharesWithinWholeSigmas) {
  constexpr double kWithin[] = {0.682689492137086, 0.954499736103642, 0.997300203936740,
                                0.999936657516334, 0.999999426696856, 0.999999998026825};
  for (int sigmas = 1; sigmas <= 6; ++sigmas) {
    EXPECT_NEAR(NormalCdf(sigmas) - NormalCdf(-sigmas), kWithin[sigmas - 1], 1e-14) << sigmas;
  }
}

TEST(NormalCdf, IsTheIntegralOfTheDensity) {
  constexpr double kStep = 1e-3;
  for (double x = -6.0; x <= 6.0; x += 0.25) {
    const double slope = (NormalCdf(x + kStep) - NormalCdf(x - kStep)) / (2.0 * kStep);
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::acos(-1.0));
    EXPECT_NEAR(slope, density, 1e-7) << x;
  }
}

TEST(NormalQuantile, UndoesTheCdfFarIntoTheTail) {
  for (double x = -37.0; x <= 5.0; x += 0.5) {
    EXPECT_NEAR(NormalQuantile(NormalCdf(x)), x, 1e-9) << x;
  }
}

TEST(NormalQuantile, IsOddAroundTheMiddleAndRises) {
  double before = -std::numeric_limits<double>::infinity();
  for (int i = 1; i < 1000; ++i) {
    const double probability = 1e-3 * i;
    const double quantile = NormalQuantile(probability);
    EXPECT_GT(quantile, before);
    EXPECT_NEAR(quantile, -NormalQuantile(1.0 - probability), 1e-9);
    before = quantile;
  }
}

TEST(NormalQuantile, IsInfiniteAtTheEnds) {
  EXPECT_EQ(NormalQuantile(0.0), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(NormalQuantile(1.0), std::numeric_limits<double>::infinity());
}

// NIST/SEMATECH e-Handbook of Statistical Methods 1.3.6.7.4, printed to three decimals.
TEST(ChiSquareQuantile, AgreesWithThePublishedTable) {
  struct Row {
    double degrees;
    double at_001, at_05, at_95, at_99, at_999;
  };
  constexpr Row kRows[] = {{2, 0.002, 0.103, 5.991, 9.210, 13.816},
                           {3, 0.024, 0.352, 7.815, 11.345, 16.266},
                           {4, 0.091, 0.711, 9.488, 13.277, 18.467},
                           {5, 0.210, 1.145, 11.070, 15.086, 20.515},
                           {10, 1.479, 3.940, 18.307, 23.209, 29.588},
                           {30, 11.588, 18.493, 43.773, 50.892, 59.703},
                           {50, 24.674, 34.764, 67.505, 76.154, 86.661},
                           {100, 61.918, 77.929, 124.342, 135.807, 149.449}};
  constexpr double kPrinted = 5.01e-4;
  for (const Row& row : kRows) {
    EXPECT_NEAR(ChiSquareQuantile(0.001, row.degrees), row.at_001, kPrinted) << row.degrees;
    EXPECT_NEAR(ChiSquareQuantile(0.05, row.degrees), row.at_05, kPrinted) << row.degrees;
    EXPECT_NEAR(ChiSquareQuantile(0.95, row.degrees), row.at_95, kPrinted) << row.degrees;
    EXPECT_NEAR(ChiSquareQuantile(0.99, row.degrees), row.at_99, kPrinted) << row.degrees;
    EXPECT_NEAR(ChiSquareQuantile(0.999, row.degrees), row.at_999, kPrinted) << row.degrees;
  }
}

TEST(ChiSquareCdf, HasTheClosedFormsOfOneTwoAndFourDegrees) {
  for (double x = 0.01; x < 60.0; x *= 1.3) {
    EXPECT_NEAR(ChiSquareCdf(x, 1.0), std::erf(std::sqrt(0.5 * x)), 1e-13) << x;
    EXPECT_NEAR(ChiSquareCdf(x, 2.0), -std::expm1(-0.5 * x), 1e-13) << x;
    EXPECT_NEAR(ChiSquareCdf(x, 4.0), 1.0 - std::exp(-0.5 * x) * (1.0 + 0.5 * x), 1e-13) << x;
  }
}

// F(x; n) - F(x; n + 2) = (x/2)^(n/2) exp(-x/2) / Gamma(n/2 + 1), Abramowitz and Stegun 26.4.8.
TEST(ChiSquareCdf, FollowsTheRecurrenceOfTheDegrees) {
  for (double degrees = 0.5; degrees < 60.0; degrees += 1.7) {
    for (double x = 0.1; x < 120.0; x *= 1.5) {
      const double half = 0.5 * degrees;
      const double step = std::exp(half * std::log(0.5 * x) - 0.5 * x) / std::tgamma(half + 1.0);
      EXPECT_NEAR(ChiSquareCdf(x, degrees) - ChiSquareCdf(x, degrees + 2.0), step, 1e-12)
          << degrees << " " << x;
    }
  }
}

TEST(ChiSquareQuantile, UndoesTheCdf) {
  for (const double degrees : {0.5, 1.0, 2.0, 3.0, 7.0, 24.0, 250.0, 1e4}) {
    for (const double probability : {1e-9, 1e-4, 0.3, 0.68, 0.95, 0.99999}) {
      const double x = ChiSquareQuantile(probability, degrees);
      EXPECT_NEAR(ChiSquareCdf(x, degrees), probability, 1e-10 * probability + 1e-14)
          << degrees << " " << probability;
    }
  }
}

// Wilson and Hilferty (1931): the cube root is nearly normal, ever more so with the degrees.
TEST(ChiSquareQuantile, TendsToTheNormalOneForManyDegrees) {
  for (const double degrees : {1e3, 1e4, 1e5, 1e6}) {
    for (const double probability : {0.001, 0.05, 0.5, 0.95, 0.999}) {
      const double spread = 2.0 / (9.0 * degrees);
      const double root = 1.0 - spread + NormalQuantile(probability) * std::sqrt(spread);
      const double expected = degrees * root * root * root;
      EXPECT_NEAR(ChiSquareQuantile(probability, degrees), expected, 0.5 * std::sqrt(2.0 / degrees))
          << degrees << " " << probability;
    }
  }
}

TEST(ChiSquareQuantile, RisesWithProbabilityAndDegrees) {
  for (double degrees = 1.0; degrees < 40.0; degrees += 1.0) {
    double before = 0.0;
    for (double probability = 0.02; probability < 1.0; probability += 0.02) {
      const double x = ChiSquareQuantile(probability, degrees);
      EXPECT_GT(x, before);
      EXPECT_GT(ChiSquareQuantile(probability, degrees + 1.0), x);
      before = x;
    }
  }
}

TEST(ChiSquareCdf, IsZeroBelowZeroAndOneFarOut) {
  EXPECT_EQ(ChiSquareCdf(-1.0, 3.0), 0.0);
  EXPECT_EQ(ChiSquareCdf(0.0, 3.0), 0.0);
  EXPECT_NEAR(ChiSquareCdf(1e4, 3.0), 1.0, 1e-15);
}

}  // namespace
}  // namespace lodemark
