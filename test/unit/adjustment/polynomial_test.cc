#include "core/adjustment/polynomial.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"

namespace lodemark {
namespace {

std::vector<double> RootsOf(const std::vector<double>& coefficients) {
  std::array<double, kMostRealRoots> roots;
  const int count = FindRealRoots(coefficients, roots);
  return {roots.begin(), roots.begin() + count};
}

std::vector<double> Times(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

TEST(FindRealRoots, GivesBackTheRootsAPolynomialWasMadeOf) {
  Random random(1);
  for (int i = 0; i < 5'000; ++i) {
    // Up to six roots, at least a third apart, some beyond 1, and a pair that is not real.
    std::vector<double> expected;
    double root = random.Uniform(-3.0, -1.0);
    std::vector<double> coefficients = {1.0};
    for (int k = 0; k < 1 + i % 6; ++k) {
      expected.push_back(root);
      coefficients = Times(coefficients, {-root, 1.0});
      root += random.Uniform(0.33, 1.5);
    }
    const double real_part = random.Uniform(-2.0, 2.0);
    coefficients = Times(coefficients, {real_part * real_part + 1.0, -2.0 * real_part, 1.0});
    const std::vector<double> roots = RootsOf(coefficients);
    ASSERT_EQ(roots.size(), expected.size()) << "polynomial " << i;
    for (std::size_t k = 0; k < roots.size(); ++k) {
      EXPECT_NEAR(roots[k], expected[k], 1e-9) << "polynomial " << i;
    }
  }
}

TEST(FindRealRoots, GivesADoubleRoot) {
  const std::vector<double> roots = RootsOf({0.25, -1.0, 1.0});  // (x - 1/2)^2
  ASSERT_FALSE(roots.empty());
  for (const double root : roots) EXPECT_NEAR(root, 0.5, 1e-7);
}

TEST(FindRealRoots, GivesRootsAtZeroAndAtTheEndsOfTheUnitInterval) {
  const std::vector<double> roots = RootsOf({0.0, -1.0, 0.0, 1.0});  // x (x - 1) (x + 1)
  ASSERT_EQ(roots.size(), 3u);
  EXPECT_NEAR(roots[0], -1.0, 1e-15);
  EXPECT_NEAR(roots[1], 0.0, 1e-15);
  EXPECT_NEAR(roots[2], 1.0, 1e-15);
}

TEST(FindRealRoots, HoldsForLargeAndSmallRoots) {
  const std::vector<double> roots = RootsOf(Times({-1e8, 1.0}, {-1e-8, 1.0}));
  ASSERT_EQ(roots.size(), 2u);
  EXPECT_NEAR(roots[0] / 1e-8, 1.0, 1e-6);
  EXPECT_NEAR(roots[1] / 1e8, 1.0, 1e-12);
}

TEST(FindRealRoots, GivesNoneWhereThereAreNone) {
  EXPECT_TRUE(RootsOf({}).empty());
  EXPECT_TRUE(RootsOf({5.0}).empty());
  EXPECT_TRUE(RootsOf({5.0, 0.0, 0.0}).empty());
  EXPECT_TRUE(RootsOf({0.0, 0.0}).empty());
  EXPECT_TRUE(RootsOf({1.0, 0.0, 1.0}).empty());
  EXPECT_TRUE(RootsOf({1.0, std::nan(""), 1.0}).empty());
  EXPECT_TRUE(RootsOf({std::numeric_limits<double>::infinity(), 1.0}).empty());
  EXPECT_TRUE(RootsOf(std::vector<double>(14, 1.0)).empty());
}

TEST(Polynomial, MultipliesAddsAndSubtracts) {
  const Polynomial<1> a = {{1.0, 2.0}};
  const Polynomial<2> b = {{3.0, 0.0, -1.0}};
  EXPECT_EQ((a * b).coefficients, (std::array<double, 4>{3.0, 6.0, -1.0, -2.0}));
  EXPECT_EQ((a + b).coefficients, (std::array<double, 3>{4.0, 2.0, -1.0}));
  EXPECT_EQ((a - b).coefficients, (std::array<double, 3>{-2.0, 2.0, 1.0}));
}

}  // namespace
}  // namespace lodemark
