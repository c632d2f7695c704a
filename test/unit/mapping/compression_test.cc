#include "tools/mapping/compression.h"

#include <gtest/gtest.h>

#include <map>

#include "core/base/random.h"

namespace lodemark {
namespace {

// Images that see landmarks of their own part of a street; the first image sees few.
MapContent Street() {
  MapContent content;
  Random random(7);
  for (std::uint32_t i = 1; i <= 5; ++i) {
    DatabaseImage image;
    image.id = i;
    content.images.push_back(image);
  }
  std::uint32_t id = 0;
  for (std::uint32_t image = 1; image <= 5; ++image) {
    for (int k = 0; k < (image == 1 ? 30 : 400); ++k) {
      Landmark landmark;
      landmark.id = ++id;
      landmark.position_in_enu_m = {10.0 * image + random.Uniform(), random.Uniform(), 0.0};
      landmark.covariance_m2 = 1e-4 * Eigen::Matrix3d::Identity();
      content.landmarks.push_back(landmark);
      for (std::uint32_t seen = image; seen <= std::min(5U, image + (k % 2 == 0 ? 1U : 0U));
           ++seen) {
        DescriptorOrigin origin;
        origin.landmark_id = id;
        origin.image_id = seen;
        content.origins.push_back(origin);
        content.places_in_image.emplace_back(static_cast<float>(random.Uniform()),
                                             static_cast<float>(random.Uniform()));
        content.descriptors.insert(content.descriptors.end(), 128, static_cast<std::uint8_t>(id));
      }
    }
  }
  return content;
}

std::map<std::uint32_t, int> PerImage(const MapContent& content) {
  std::map<std::uint32_t, int> counts;
  for (const DescriptorOrigin& origin : content.origins) ++counts[origin.image_id];
  return counts;
}

TEST(Compression, KeepsTheShareAndWhatBelongsToIt) {
  MapContent content = Street();
  const std::size_t before = content.landmarks.size();
  KeepBestLandmarks(0.2, &content);
  EXPECT_NEAR(static_cast<double>(content.landmarks.size()), 0.2 * static_cast<double>(before),
              1.0);
  EXPECT_EQ(content.descriptors.size(), 128 * content.origins.size());
  EXPECT_EQ(content.places_in_image.size(), content.origins.size());
  for (std::size_t i = 0; i < content.origins.size(); ++i) {
    EXPECT_EQ(content.descriptors[128 * i],
              static_cast<std::uint8_t>(content.origins[i].landmark_id));
  }
  EXPECT_EQ(content.images.size(), 5U);
}

TEST(Compression, LeavesEveryImageItsShare) {
  MapContent content = Street();
  KeepBestLandmarks(0.1, &content);
  for (const auto& [image, count] : PerImage(content)) EXPECT_GE(count, 20) << image;
}

TEST(Compression, CoversAllPartsOfAnImage) {
  MapContent content = Street();
  KeepBestLandmarks(0.1, &content);
  std::map<int, int> quarters;
  for (std::size_t i = 0; i < content.origins.size(); ++i) {
    if (content.origins[i].image_id != 3) continue;
    const Eigen::Vector2f place = content.places_in_image[i];
    ++quarters[(place.x() > 0.5F ? 1 : 0) + (place.y() > 0.5F ? 2 : 0)];
  }
  ASSERT_EQ(quarters.size(), 4U);
  for (const auto& [quarter, count] : quarters) EXPECT_GE(count, 6) << quarter;
}

TEST(Compression, PrefersTheOftenSeenAndTheWellPlaced) {
  MapContent content = Street();
  content.landmarks[100].covariance_m2 *= 1e6;
  const std::vector<std::uint32_t> ranked = RankLandmarks(content, content.landmarks.size());
  ASSERT_EQ(ranked.size(), content.landmarks.size());
  EXPECT_EQ(ranked.back(), 100U);
  // Every second landmark is seen twice: of the first tenth nearly all.
  int twice = 0;
  for (std::size_t i = 0; i < 160; ++i) twice += ranked[i] % 2 == 0 ? 1 : 0;
  EXPECT_GT(twice, 120);
}

TEST(Compression, IsTheSameEveryTimeAndWorksWithoutImages) {
  MapContent content = Street();
  EXPECT_EQ(RankLandmarks(content, 50), RankLandmarks(content, 50));
  content.images.clear();
  content.places_in_image.clear();
  for (DescriptorOrigin& origin : content.origins) origin.image_id = 0;
  KeepBestLandmarks(0.25, &content);
  // Every part of the street keeps some.
  std::map<int, int> parts;
  for (const Landmark& landmark : content.landmarks) {
    ++parts[static_cast<int>(landmark.position_in_enu_m.x() / 10.0)];
  }
  EXPECT_EQ(parts.size(), 5U);
  MapContent empty;
  KeepBestLandmarks(0.5, &empty);
  EXPECT_TRUE(empty.landmarks.empty());
}

}  // namespace
}  // namespace lodemark
