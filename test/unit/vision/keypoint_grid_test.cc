#include "core/vision/keypoint_grid.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/random.h"

namespace lodemark {
namespace {

std::vector<std::uint32_t> Near(const KeypointGrid& grid, const Eigen::Vector2d& pixel) {
  std::vector<std::uint32_t> found;
  grid.ForEachNear(pixel, [&](std::uint32_t i) { found.push_back(i); });
  std::sort(found.begin(), found.end());
  return found;
}

TEST(KeypointGrid, FindsWhatAComparisonWithAllFinds) {
  Random random(1);
  std::vector<Keypoint> keypoints(500);
  for (Keypoint& keypoint : keypoints) {
    keypoint.x_px = static_cast<float>(random.Uniform(-50.0, 1600.0));
    keypoint.y_px = static_cast<float>(random.Uniform(0.0, 900.0));
  }
  for (const double radius_px : {0.5, 7.0, 130.0, 5000.0}) {
    const KeypointGrid grid(keypoints, radius_px);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d pixel(random.Uniform(-300.0, 2000.0), random.Uniform(-300.0, 1200.0));
      std::vector<std::uint32_t> expected;
      for (std::uint32_t k = 0; k < keypoints.size(); ++k) {
        const Eigen::Vector2d at(keypoints[k].x_px, keypoints[k].y_px);
        if ((at - pixel).norm() <= radius_px) expected.push_back(k);
      }
      EXPECT_EQ(Near(grid, pixel), expected);
    }
  }
}

TEST(KeypointGrid, PassesOverWhatIsNotFinite) {
  std::vector<Keypoint> keypoints(3);
  keypoints[0].x_px = std::numeric_limits<float>::quiet_NaN();
  keypoints[1].y_px = std::numeric_limits<float>::infinity();
  const KeypointGrid grid(keypoints, 5.0);
  EXPECT_EQ(Near(grid, {0.0, 0.0}), std::vector<std::uint32_t>{2});
  EXPECT_TRUE(Near(grid, {std::numeric_limits<double>::quiet_NaN(), 0.0}).empty());
  EXPECT_TRUE(Near(grid, {1e300, -1e300}).empty());
}

TEST(KeypointGrid, TakesPlacesHoweverFarApart) {
  std::vector<Keypoint> keypoints(2);
  keypoints[0].x_px = -3e38F;
  keypoints[1].x_px = 3e38F;
  const KeypointGrid grid(keypoints, 1.0);
  EXPECT_EQ(Near(grid, {3e38F, 0.0}), std::vector<std::uint32_t>{1});
  EXPECT_TRUE(Near(KeypointGrid({}, 1.0), {0.0, 0.0}).empty());
}

}  // namespace
}  // namespace lodemark
