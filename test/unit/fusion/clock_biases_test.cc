#include "core/fusion/clock_biases.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lodemark {
namespace {

TEST(ClockBiases, KnowNothingAtFirstButGroupZero) {
  const ClockBiases biases;
  EXPECT_EQ(biases[0].mean_m, 0.0);
  EXPECT_EQ(biases[0].sigma_m, 0.0);
  for (int group = 1; group < kMaxClockGroups; ++group) EXPECT_GT(biases[group].sigma_m, 1e6);
}

TEST(ClockBiases, RememberWhatIsSetAndNeverTooSurely) {
  ClockBiases biases;
  biases.Set(3, {-2358.0, 4.0});
  EXPECT_EQ(biases[3].mean_m, -2358.0);
  EXPECT_EQ(biases[3].sigma_m, 4.0);
  biases.Set(3, {-2358.0, 0.0});
  EXPECT_GT(biases[3].sigma_m, 0.0);
}

TEST(ClockBiases, GroupZeroIsTheReferenceAndOthersDoNotExist) {
  ClockBiases biases;
  biases.Set(0, {5.0, 1.0});
  EXPECT_EQ(biases[0].mean_m, 0.0);
  EXPECT_EQ(biases[0].sigma_m, 0.0);
  biases.Set(-1, {5.0, 1.0});
  biases.Set(kMaxClockGroups, {5.0, 1.0});
  for (int group = 1; group < kMaxClockGroups; ++group) EXPECT_EQ(biases[group].mean_m, 0.0);
}

TEST(ClockBiases, WanderAlikeInOneStepAndInMany) {
  ClockBiases once;
  ClockBiases often;
  once.Set(2, {1.0, 0.5});
  often.Set(2, {1.0, 0.5});
  once.Advance(3600.0);
  for (int i = 0; i < 3600; ++i) often.Advance(1.0);
  EXPECT_NEAR(once[2].sigma_m, often[2].sigma_m, 1e-9);
  // Decimetres to a metre or so in an hour.
  EXPECT_GT(once[2].sigma_m, 0.6);
  EXPECT_LT(once[2].sigma_m, 3.0);
  EXPECT_EQ(once[2].mean_m, 1.0);
  EXPECT_EQ(once[0].sigma_m, 0.0);
}

TEST(ClockBiases, ForgetEverything) {
  ClockBiases biases;
  biases.Set(2, {1.0, 0.5});
  biases.Forget();
  EXPECT_EQ(biases[2].mean_m, 0.0);
  EXPECT_GT(biases[2].sigma_m, 1e6);
  EXPECT_EQ(biases[0].sigma_m, 0.0);
}

}  // namespace
}  // namespace lodemark
