#include "core/base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace lodemark {
namespace {

constexpr int kDraws = 200'000;

// Words 1 to 4 and 1000 of a generator seeded with the given number. Computed with a separate
// program that reproduces the published outputs of splitmix64 (seed 1234567: 6457827717110365317,
// 3203168211198807973, ...) and of xoshiro256** (state 1, 2, 3, 4: 11520, 0, 1509978240,
// 1215971899390074240, ...).
struct Reference {
  std::uint64_t seed;
  std::array<std::uint64_t, 4> first;
  std::uint64_t thousandth;
};
constexpr std::array<Reference, 3> kReferences = {{
    {0,
     {0x99ec5f36cb75f2b4, 0xbf6e1f784956452a, 0x1a5f849d4933e6e0, 0x6aa594f1262d2d2c},
     0x7aac8c483a2edd2f},
    {1234567,
     {0x30a3a1c363600467, 0x19405f0f579929ca, 0x115beaac046ddbd9, 0xeb17caf48f27d7f6},
     0x3be7f2876df677c2},
    {0xffffffffffffffff,
     {0x8f5520d52a7ead08, 0xc476a018caa1802d, 0x81de31c0d260469e, 0xbf658d7e065f3c2f},
     0xc3c93ea5cde434cc},
}};

TEST(Random, GivesTheWordsOfThePublishedAlgorithm) {
  for (const Reference& reference : kReferences) {
    Random random(reference.seed);
    for (const std::uint64_t word : reference.first) EXPECT_EQ(random.NextBits(), word);
    for (int i = 5; i < 1000; ++i) random.NextBits();
    EXPECT_EQ(random.NextBits(), reference.thousandth) << "seed " << reference.seed;
  }
}

TEST(Random, RepeatsForTheSameSeedWhateverIsDrawn) {
  Random first(7);
  Random second(7);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(first.Gaussian(), second.Gaussian());
    ASSERT_EQ(first.Index(17), second.Index(17));
    ASSERT_EQ(first.Exponential(3.0), second.Exponential(3.0));
  }
}

TEST(Random, UniformStaysBelowOneAndIsFlat) {
  Random random(1);
  std::array<int, 20> counts = {};
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.Uniform();
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    ++counts[static_cast<std::size_t>(value * 20.0)];
  }
  double chi_squared = 0.0;
  for (const int count : counts)
    chi_squared += std::pow(count - kDraws / 20.0, 2) / (kDraws / 20.0);
  EXPECT_LT(chi_squared, 43.8);  // 19 degrees of freedom, 99.9 %
}

TEST(Random, UniformOfAnIntervalCoversIt) {
  Random random(2);
  double smallest = 1e9;
  double largest = -1e9;
  for (int i = 0; i < 10'000; ++i) {
    const double value = random.Uniform(-3.0, 5.0);
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  EXPECT_GE(smallest, -3.0);
  EXPECT_LT(largest, 5.0);
  EXPECT_NEAR(smallest, -3.0, 0.02);
  EXPECT_NEAR(largest, 5.0, 0.02);
}

TEST(Random, IndexReachesEveryValueEquallyOften) {
  Random random(3);
  std::array<int, 7> counts = {};
  for (int i = 0; i < kDraws; ++i) ++counts.at(random.Index(7));
  double chi_squared = 0.0;
  for (const int count : counts) chi_squared += std::pow(count - kDraws / 7.0, 2) / (kDraws / 7.0);
  EXPECT_LT(chi_squared, 22.5);  // 6 degrees of freedom, 99.9 %
}

TEST(Random, IndexOfALargeCountIsNotBiasedTowardsItsBeginning) {
  // 2^64 is four thirds of this count: a plain remainder would hit the lowest third of it twice as
  // often as the others.
  constexpr std::uint64_t kCount = 0xc000000000000000;
  Random random(4);
  int lower_third = 0;
  for (int i = 0; i < 30'000; ++i) lower_third += random.Index(kCount) < kCount / 3 ? 1 : 0;
  EXPECT_NEAR(lower_third, 10'000, 330);  // 4 sigma
}

TEST(Random, IndexOfOneIsZero) {
  Random random(5);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.Index(1), 0U);
}

TEST(Random, GaussianHasTheMomentsOfTheStandardNormal) {
  Random random(6);
  double sum = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  int within_one = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.Gaussian();
    sum += value;
    squares += value * value;
    fourths += value * value * value * value;
    within_one += std::abs(value) < 1.0 ? 1 : 0;
  }
  // Four standard errors each.
  EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(fourths / kDraws, 3.0, 4.0 * std::sqrt(96.0 / kDraws));
  EXPECT_NEAR(static_cast<double>(within_one) / kDraws, std::erf(std::sqrt(0.5)), 0.0042);
}

TEST(Random, SuccessiveGaussiansAreUncorrelated) {
  Random random(8);
  double products = 0.0;
  double previous = random.Gaussian();
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.Gaussian();
    products += previous * value;
    previous = value;
  }
  EXPECT_NEAR(products / kDraws, 0.0, 4.0 / std::sqrt(kDraws));
}

TEST(Random, ExponentialHasItsMeanAndMedian) {
  Random random(9);
  double sum = 0.0;
  int below_median = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.Exponential(2.5);
    ASSERT_GE(value, 0.0);
    sum += value;
    below_median += value < 2.5 * std::log(2.0) ? 1 : 0;
  }
  EXPECT_NEAR(sum / kDraws, 2.5, 4.0 * 2.5 / std::sqrt(kDraws));
  EXPECT_NEAR(static_cast<double>(below_median) / kDraws, 0.5, 0.0045);
}

}  // namespace
}  // namespace lodemark
