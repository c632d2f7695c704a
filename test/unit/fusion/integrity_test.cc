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

}  // namespace
}  // namespace lodemark
