// Protection levels hold where satellites are reflected and landmarks mistaken, several at a time.
// test/experiments/integrity_tables.cc does the same with many more epochs.
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "test/unit/fusion/faulty_epoch.h"

namespace lodemark {
namespace {

constexpr std::uint64_t kSeed = 5;

FaultyEpochs OneInTwenty(int satellites, int landmarks) {
  FaultyEpochs epochs;
  epochs.satellites = satellites;
  epochs.landmarks = landmarks;
  epochs.reflected = 0.05;
  epochs.mismatched = 0.05;
  return epochs;
}

TEST(Integrity, NoAnswerErrsByMoreThanItsProtectionLevel) {
  constexpr int kEpochs = 100;
  for (const auto& [satellites, landmarks] :
       {std::pair(10, 0), std::pair(10, 12), std::pair(5, 12), std::pair(3, 12)}) {
    int with_level = 0;
    for (int i = 0; i < kEpochs; ++i) {
      const auto answer = AnswerFaultyEpoch(OneInTwenty(satellites, landmarks), kSeed, i);
      if (!answer) continue;
      EXPECT_FALSE(answer->IsMisleading()) << satellites << ' ' << landmarks << ' ' << i;
      EXPECT_FALSE(answer->IsMisleadingUp()) << satellites << ' ' << landmarks << ' ' << i;
      with_level += answer->estimate.protection_level_m > 0.0 ? 1 : 0;
    }
    EXPECT_GT(with_level, 95) << satellites << ' ' << landmarks;
  }
}

// Two reflections that agree make a right satellite look wrong; so does one where there are hardly
// more satellites than unknowns. The place where it is right is not ruled out.
TEST(Integrity, LevelsReachToWhereWhatSeemsWrongIsRight) {
  FaultyEpochs ten = OneInTwenty(10, 0);
  FaultyEpochs five = OneInTwenty(5, 12);
  ten.mismatched = five.mismatched = 0.0;
  for (const auto& [epochs, number] :
       {std::pair(ten, 6516), std::pair(five, 6812), std::pair(five, 9528)}) {
    const auto answer = AnswerFaultyEpoch(epochs, kSeed, number);
    ASSERT_TRUE(answer.has_value()) << number;
    EXPECT_FALSE(answer->IsMisleading()) << number;
    EXPECT_FALSE(answer->IsMisleadingUp()) << number;
  }
}

// Two mistaken landmarks that agree hold a place at which a right one seems wrong.
TEST(Integrity, LevelsDoWithoutEveryTwoLandmarks) {
  FaultyEpochs epochs = OneInTwenty(0, 12);
  epochs.stated_displacement.probability = 0.0;
  const auto answer = AnswerFaultyEpoch(epochs, kSeed, 3704);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->mismatched, 3);
  EXPECT_GT(answer->horizontal_m(), 5.0);
  EXPECT_FALSE(answer->IsMisleading());
}

// All landmarks agree on a place that a period of the wall's windows lies beside the true one: only
// satellites can tell, and a level that fears it.
TEST(Integrity, LevelsReachToWhereAWallsRepeatPutsTheCamera) {
  constexpr int kEpochs = 60;
  FaultyEpochs epochs;
  epochs.repeated = 1.0;
  for (const int satellites : {10, 3, 0}) {
    epochs.satellites = satellites;
    int unfeared = 0;
    for (int i = 0; i < kEpochs; ++i) {
      epochs.stated_displacement = {0.05, 5.0};
      const auto answer = AnswerFaultyEpoch(epochs, kSeed, i);
      if (!answer) continue;
      EXPECT_FALSE(answer->IsMisleading()) << satellites << ' ' << i;
      epochs.stated_displacement.probability = 0.0;
      const auto careless = AnswerFaultyEpoch(epochs, kSeed, i);
      unfeared += careless && careless->IsMisleading() ? 1 : 0;
    }
    EXPECT_GT(unfeared, kEpochs / 4) << satellites;
  }
}

// Farther away satellites prove it, or the level reaches there.
TEST(Integrity, SatellitesContradictARepeatFarBeside) {
  constexpr int kEpochs = 60;
  FaultyEpochs epochs;
  epochs.repeated = 1.0;
  epochs.stated_displacement.probability = 0.05;
  epochs.least_period_m = epochs.largest_period_m = 20.0;
  int whole = 0;
  int used = 0;
  for (int i = 0; i < kEpochs; ++i) {
    const auto answer = AnswerFaultyEpoch(epochs, kSeed, i);
    ASSERT_TRUE(answer.has_value()) << i;
    EXPECT_FALSE(answer->IsMisleading()) << i;
    if (answer->repeated < epochs.landmarks) continue;
    ++whole;
    used += answer->used_landmarks ? 1 : 0;
  }
  EXPECT_GT(whole, kEpochs / 4);
  EXPECT_LT(used, whole);
}

// What is feared of a witness grows with how little else contradicts it.
TEST(Integrity, TheFearOfARepeatShrinksWithSatellites) {
  double before_m = 1e3;
  for (const int satellites : {0, 5, 10, 20}) {
    FaultyEpochs epochs;
    epochs.satellites = satellites;
    const auto answer = AnswerFaultyEpoch(epochs, kSeed, 1);
    ASSERT_TRUE(answer.has_value());
    EXPECT_LT(answer->estimate.protection_level_m, before_m) << satellites;
    before_m = answer->estimate.protection_level_m;
  }
}

}  // namespace
}  // namespace lodemark
