#include "core/vision/feature_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"

namespace lodemark {
namespace {

using testing::ElementsAre;

// Half of the features, the most distinct ones, in the upper left tenth.
std::vector<Keypoint> Bush(Random& random, std::size_t count) {
  std::vector<Keypoint> keypoints(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = i % 2 == 0 ? 0.1 : 1.0;
    keypoints[i].x_px = static_cast<float>(random.Uniform(0.0, 999.0 * share));
    keypoints[i].y_px = static_cast<float>(random.Uniform(0.0, 999.0 * share));
    keypoints[i].response = static_cast<float>(random.Uniform(0.0, 1.0) + (i % 2 == 0 ? 1.0 : 0.0));
  }
  return keypoints;
}

TEST(SpreadOverImage, OrdersAllByContrastThenPlaceWhereAllMayStay) {
  const std::vector<Keypoint> keypoints = {
      {5.0F, 5.0F, 1.0F, 0.0F, 1.0F}, {9.0F, 2.0F, 1.0F, 0.0F, 1.0F},
      {3.0F, 2.0F, 1.0F, 2.0F, 1.0F}, {3.0F, 2.0F, 1.0F, 1.0F, 1.0F},
      {7.0F, 7.0F, 1.0F, 0.0F, 4.0F},
  };
  EXPECT_THAT(SpreadOverImage(keypoints, 10, 10, 5), ElementsAre(4, 3, 2, 1, 0));
}

TEST(SpreadOverImage, LeavesSomeToEveryPartOfTheImage) {
  Random random(1);
  const std::vector<Keypoint> keypoints = Bush(random, 4000);
  const std::vector<std::uint32_t> kept = SpreadOverImage(keypoints, 1000, 1000, 500);
  ASSERT_EQ(kept.size(), 500U);
  const auto in_bush = std::count_if(kept.begin(), kept.end(), [&](std::uint32_t i) {
    return keypoints[i].x_px < 100.0F && keypoints[i].y_px < 100.0F;
  });
  EXPECT_LT(in_bush, 100);
}

TEST(SpreadOverImage, PrefersContrastWithinOnePart) {
  std::vector<Keypoint> keypoints(100);
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    keypoints[i].x_px = 0.01F * static_cast<float>(i);
    keypoints[i].response = static_cast<float>(i % 7);
  }
  for (const std::uint32_t i : SpreadOverImage(keypoints, 1000, 1000, 10)) {
    EXPECT_EQ(keypoints[i].response, 6.0F);
  }
}

TEST(SpreadOverImage, DoesNotCareInWhatOrderTheyCome) {
  Random random(2);
  std::vector<Keypoint> keypoints = Bush(random, 1000);
  const auto kept_of = [&] {
    std::vector<float> responses;
    for (const std::uint32_t i : SpreadOverImage(keypoints, 1000, 1000, 200)) {
      responses.push_back(keypoints[i].response);
    }
    return responses;
  };
  const std::vector<float> before = kept_of();
  std::reverse(keypoints.begin(), keypoints.end());
  EXPECT_EQ(kept_of(), before);
}

TEST(SpreadOverImage, KeepsNoneOfNone) {
  EXPECT_TRUE(SpreadOverImage({}, 10, 10, 5).empty());
  EXPECT_TRUE(SpreadOverImage(std::vector<Keypoint>(3), 10, 10, 0).empty());
}

}  // namespace
}  // namespace lodemark
