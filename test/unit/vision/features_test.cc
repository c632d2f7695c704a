#include "core/vision/features.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <tuple>

#include "core/base/random.h"
#include "core/base/units.h"
#include "test/unit/vision/blob_scene.h"

namespace lodemark {
namespace {

using test::Blob;
using test::Paint;
using test::Picture;
using test::SceneToImage;

Features Detect(const Picture& picture, const DetectorOptions& options = {}) {
  Result<Features> features = DetectFeatures(picture.view(), options);
  EXPECT_TRUE(features.ok()) << (features ? "" : features.error().message);
  return features ? std::move(features).value() : Features{};
}

DetectorOptions Kind(DescriptorKind kind) {
  DetectorOptions options;
  options.kind = kind;
  return options;
}

Picture Scene(const SceneToImage& image_from_scene, int width_px = 640, int height_px = 480) {
  return Paint(test::RandomBlobs(7, 1500, 640.0, 480.0), image_from_scene, width_px, height_px);
}

Picture Flat(int width_px, int height_px, std::uint8_t grey) {
  return {width_px, height_px, width_px,
          std::vector<std::uint8_t>(
              static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), grey)};
}

Picture Noise(int width_px, int height_px) {
  Picture picture = Flat(width_px, height_px, 0);
  Random random(3);
  for (std::size_t i = 0; i + 8 <= picture.pixels.size(); i += 8) {
    const std::uint64_t bits = random.NextBits();
    for (std::size_t k = 0; k < 8; ++k) {
      picture.pixels[i + k] = static_cast<std::uint8_t>(bits >> (8 * k));
    }
  }
  return picture;
}

bool AreSame(const Features& a, const Features& b) {
  const auto key = [](const Keypoint& k) {
    return std::tuple(k.x_px, k.y_px, k.size_px, k.angle_rad, k.response);
  };
  return a.descriptors == b.descriptors &&
         std::equal(a.keypoints.begin(), a.keypoints.end(), b.keypoints.begin(), b.keypoints.end(),
                    [&](const Keypoint& p, const Keypoint& q) { return key(p) == key(q); });
}

// How the features of one picture lie in another where they ought to be.
struct Agreement {
  double found_again = 0.0;  // share of those that ought to be inside, within 1 px and 30 % of size
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  double rms_px = 0.0;
  double turned_along = 0.0;  // share of those found whose angle turned with the picture, 0.1 rad
};

Agreement Compare(const Features& before, const Features& after, const SceneToImage& moved,
                  const Picture& picture) {
  Agreement agreement;
  int expected = 0;
  int found = 0;
  double sum2_px2 = 0.0;
  int turned = 0;
  for (const Keypoint& keypoint : before.keypoints) {
    const Eigen::Vector2d at = moved * Eigen::Vector2d(keypoint.x_px, keypoint.y_px);
    const double size_px = moved.scale * keypoint.size_px;
    const double border_px = 40.0 + 2.0 * size_px;
    if (at.x() < border_px || at.y() < border_px || at.x() > picture.width_px - border_px ||
        at.y() > picture.height_px - border_px || size_px < 3.0) {
      continue;
    }
    ++expected;
    Eigen::Vector2d nearest(1.0, 0.0);
    double turn_rad = kPi;
    for (const Keypoint& other : after.keypoints) {
      if (std::abs(std::log(other.size_px / size_px)) > 0.26) continue;
      const Eigen::Vector2d off = Eigen::Vector2d(other.x_px, other.y_px) - at;
      const double off_rad =
          std::remainder(other.angle_rad - keypoint.angle_rad - moved.turn_rad, 2.0 * kPi);
      const bool is_nearer = off.norm() < nearest.norm() - 1e-3;
      const bool is_same = off.norm() < nearest.norm() + 1e-3;
      if (!is_nearer && !(is_same && std::abs(off_rad) < std::abs(turn_rad))) continue;
      nearest = off;
      turn_rad = off_rad;
    }
    if (nearest.norm() >= 1.0) continue;
    ++found;
    agreement.mean_px += nearest;
    sum2_px2 += nearest.squaredNorm();
    if (std::abs(turn_rad) < 0.1) ++turned;
  }
  EXPECT_GT(expected, 50);
  if (found == 0) return agreement;
  agreement.found_again = static_cast<double>(found) / expected;
  agreement.mean_px /= found;
  agreement.rms_px = std::sqrt(sum2_px2 / found);
  agreement.turned_along = static_cast<double>(turned) / found;
  return agreement;
}

TEST(DetectFeatures, FindsSpotsOfEverySizeWhereTheyAre) {
  for (const double sigma_px : {1.2, 2.0, 3.2, 5.0, 8.0}) {
    Random random(5);
    Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
    constexpr int kSpots = 30;
    for (int i = 0; i < kSpots; ++i) {
      const Eigen::Vector2d centre(random.Uniform(90.0, 110.0), random.Uniform(90.0, 110.0));
      const Features features =
          Detect(Paint({{centre, sigma_px, 100.0}}, SceneToImage{}, 200, 200));
      Eigen::Vector2d nearest(9.0, 9.0);
      for (const Keypoint& keypoint : features.keypoints) {
        const Eigen::Vector2d off = Eigen::Vector2d(keypoint.x_px, keypoint.y_px) - centre;
        if (off.norm() < nearest.norm()) nearest = off;
      }
      EXPECT_LT(nearest.norm(), 0.25) << sigma_px;
      sum_px += nearest;
    }
    EXPECT_LT((sum_px / kSpots).norm(), 0.03) << sigma_px;
  }
}

struct Law {
  DescriptorKind kind;
  double found_again;
  double mean_px;
  double rms_px;
};

class DetectFeaturesLaws : public testing::TestWithParam<Law> {
 protected:
  void Expect(const SceneToImage& moved, int width_px, int height_px) {
    const Law law = GetParam();
    const Picture picture = Scene(moved, width_px, height_px);
    const Agreement agreement =
        Compare(Detect(Scene({}), Kind(law.kind)), Detect(picture, Kind(law.kind)), moved, picture);
    EXPECT_GT(agreement.found_again, law.found_again);
    EXPECT_LT(agreement.mean_px.norm(), law.mean_px);
    EXPECT_LT(agreement.rms_px, law.rms_px);
    EXPECT_GT(agreement.turned_along, 0.6);
  }
};

TEST_P(DetectFeaturesLaws, MovesWithTheImage) { Expect({0.0, 1.0, {17.0, -9.0}}, 640, 480); }

TEST_P(DetectFeaturesLaws, MovesByPartsOfPixels) { Expect({0.0, 1.0, {3.37, 5.71}}, 640, 480); }

TEST_P(DetectFeaturesLaws, TurnsByQuarters) { Expect({0.5 * kPi, 1.0, {479.0, 0.0}}, 480, 640); }

TEST_P(DetectFeaturesLaws, TurnsByHalves) { Expect({kPi, 1.0, {639.0, 479.0}}, 640, 480); }

TEST_P(DetectFeaturesLaws, GrowsWithTheImage) { Expect({0.0, 1.5, {0.25, 0.25}}, 960, 720); }

INSTANTIATE_TEST_SUITE_P(Sift, DetectFeaturesLaws,
                         testing::Values(Law{DescriptorKind::kRootSift, 0.85, 0.03, 0.25}));
INSTANTIATE_TEST_SUITE_P(Orb, DetectFeaturesLaws,
                         testing::Values(Law{DescriptorKind::kOrb, 0.6, 0.1, 0.7}));

TEST(DetectFeatures, GivesPositionsInThePhotographWhateverItWorkedAt) {
  const SceneToImage twice{0.0, 2.0, {0.5, 0.5}};  // pixel centres of a photograph twice as fine
  const Picture photograph = Scene(twice, 1280, 960);
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    DetectorOptions options = Kind(kind);
    options.longest_side_px = 640;
    const Agreement agreement =
        Compare(Detect(Scene({}), options), Detect(photograph, options), twice, photograph);
    EXPECT_GT(agreement.found_again, 0.8);
    EXPECT_LT(agreement.mean_px.norm(), 0.05);
  }
}

TEST(DetectFeatures, TakesTheSameFromEveryStride) {
  const Picture picture = Scene({}, 320, 240);
  Picture padded{320, 240, 331, std::vector<std::uint8_t>(331 * 239 + 320, 255)};
  for (int y = 0; y < 240; ++y) {
    std::copy_n(picture.pixels.begin() + y * 320, 320, padded.pixels.begin() + y * 331);
  }
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    EXPECT_TRUE(AreSame(Detect(picture, Kind(kind)), Detect(padded, Kind(kind))));
  }
}

TEST(DetectFeatures, RepeatsItselfInOneOrder) {
  const Picture picture = Scene({});
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    const Features first = Detect(picture, Kind(kind));
    EXPECT_GT(first.keypoints.size(), 200U);
    EXPECT_EQ(first.descriptors.size(), first.keypoints.size() * DescriptorBytes(kind));
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(AreSame(first, Detect(picture, Kind(kind))));
    EXPECT_TRUE(std::is_sorted(first.keypoints.begin(), first.keypoints.end(),
                               [](const Keypoint& a, const Keypoint& b) {
                                 return std::tie(b.response, a.y_px, a.x_px, a.angle_rad) <
                                        std::tie(a.response, b.y_px, b.x_px, b.angle_rad);
                               }));
  }
}

TEST(DetectFeatures, DescribesByRootsOfWhatOpenCvFinds) {
  const Picture picture = Scene({}, 320, 240);
  const Features features = Detect(picture);
  ASSERT_GT(features.keypoints.size(), 50U);
  std::size_t alike = 0;
  std::size_t rounded_alike = 0;
  std::vector<std::uint8_t> pixels = picture.pixels;
  const cv::Mat image(240, 320, CV_8UC1, pixels.data());
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat histograms;
  cv::SIFT::create()->detectAndCompute(image, cv::noArray(), keypoints, histograms);
  for (std::size_t i = 0; i < features.keypoints.size(); ++i) {
    const Keypoint& keypoint = features.keypoints[i];
    int same = 0;
    for (int k = 0; k < histograms.rows; ++k) {
      const cv::KeyPoint& theirs = keypoints[static_cast<std::size_t>(k)];
      if (std::hypot(theirs.pt.x - 0.25F - keypoint.x_px, theirs.pt.y - 0.25F - keypoint.y_px) >
              1e-3F ||
          std::abs(theirs.angle - keypoint.angle_rad * kDegreesPerRadian) > 1e-3) {
        continue;
      }
      const double sum = cv::sum(histograms.row(k))[0];
      double largest_off = 0.0;
      for (int j = 0; j < 128; ++j) {
        const double root = 512.0 * std::sqrt(histograms.at<float>(k, j) / sum);
        const double ours = features.descriptors[i * 128 + static_cast<std::size_t>(j)];
        largest_off = std::max(largest_off, std::abs(std::min(root, 255.0) - ours));
      }
      // Their histograms are whole numbers: the root of a small one may be rounded to another.
      if (largest_off <= 15.0) ++same;
      if (largest_off <= 0.501) ++rounded_alike;
    }
    EXPECT_LE(same, 1) << i;
    alike += same == 1 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(alike), 0.99 * static_cast<double>(features.keypoints.size()));
  EXPECT_GT(static_cast<double>(rounded_alike),
            0.9 * static_cast<double>(features.keypoints.size()));
}

TEST(DetectFeatures, KeepsToItsBudgetAllOverTheImage) {
  const Picture picture = Noise(640, 480);
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    DetectorOptions options = Kind(kind);
    options.most_features = 300;
    const Features features = Detect(picture, options);
    EXPECT_EQ(features.keypoints.size(), 300U);
    int quarter[4] = {};
    for (const Keypoint& keypoint : features.keypoints) {
      ++quarter[(keypoint.x_px < 320.0F ? 0 : 1) + (keypoint.y_px < 240.0F ? 0 : 2)];
    }
    for (const int count : quarter) EXPECT_GT(count, 40);
  }
}

TEST(DetectFeatures, FindsNothingWhereThereIsNothing) {
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    for (const std::uint8_t grey : {std::uint8_t{0}, std::uint8_t{127}, std::uint8_t{255}}) {
      EXPECT_TRUE(Detect(Flat(320, 240, grey), Kind(kind)).keypoints.empty());
    }
    Picture ramp = Flat(640, 480, 0);  // all that a bad blur leaves
    for (std::size_t i = 0; i < ramp.pixels.size(); ++i) {
      ramp.pixels[i] = static_cast<std::uint8_t>(40 + (i % 640) / 8);
    }
    EXPECT_TRUE(Detect(ramp, Kind(kind)).keypoints.empty());
  }
}

TEST(DetectFeatures, TakesImagesOfEverySmallSize) {
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    for (const int side_px : {1, 2, 3, 5, 8, 15, 16, 17, 31, 33, 62, 63, 64, 65}) {
      Detect(Noise(side_px, side_px), Kind(kind));
      Detect(Noise(side_px, 300), Kind(kind));
      Detect(Noise(300, side_px), Kind(kind));
    }
    EXPECT_TRUE(Detect(Noise(1, 1), Kind(kind)).keypoints.empty());
    Detect(Noise(65'535, 1), Kind(kind));
    Detect(Noise(3, 65'535), Kind(kind));
  }
}

TEST(DetectFeatures, TakesLargePhotographsAtItsOwnResolution) {
  const Picture picture = Noise(8'000, 6'000);
  for (const DescriptorKind kind : {DescriptorKind::kRootSift, DescriptorKind::kOrb}) {
    const Features features = Detect(picture, Kind(kind));
    EXPECT_LE(features.keypoints.size(), 4'000U);
    for (const Keypoint& keypoint : features.keypoints) {
      EXPECT_TRUE(keypoint.x_px > 0.0F && keypoint.x_px < 7'999.0F && keypoint.y_px > 0.0F &&
                  keypoint.y_px < 5'999.0F);
    }
  }
}

TEST(DetectFeatures, RefusesWhatIsNoImage) {
  const std::vector<std::uint8_t> pixels(100);
  const std::uint8_t* const p = pixels.data();
  const std::pair<GrayImage, const char*> cases[] = {
      {{p, 0, 0, 0}, "size 0 x 0"},
      {{p, 0, 10, 10}, "size 0 x 10"},
      {{p, -5, 10, 10}, "size -5"},
      {{p, 65'536, 1, 65'536}, "size 65536"},
      {{nullptr, 10, 10, 10}, "no pixels"},
      {{p, 10, 10, 9}, "stride of 9"},
      {{p, 10, 10, -10}, "stride of -10"},
      {{p, 10, 10, 0}, "stride of 0"},
      {{p, 60'000, 60'000, 60'000}, "200 megapixels"},
  };
  for (const auto& [image, message] : cases) {
    const Result<Features> features = DetectFeatures(image, {});
    ASSERT_FALSE(features.ok()) << message;
    EXPECT_EQ(features.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(features.error().message, testing::HasSubstr(message));
  }
}

TEST(DetectFeatures, RefusesOptionsThatMakeNoSense) {
  const Picture picture = Flat(64, 64, 0);
  DetectorOptions none;
  none.most_features = 0;
  EXPECT_FALSE(DetectFeatures(picture.view(), none).ok());
  DetectorOptions negative;
  negative.longest_side_px = -1;
  EXPECT_FALSE(DetectFeatures(picture.view(), negative).ok());
}

}  // namespace
}  // namespace lodemark
