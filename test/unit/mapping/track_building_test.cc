#include "tools/mapping/track_building.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/random.h"
#include "tools/mapping/triangulation.h"

namespace lodemark {
namespace {

using testing::ElementsAre;

TrackLink Link(std::uint32_t image_a, std::uint32_t feature_a, std::uint32_t image_b,
               std::uint32_t feature_b, double ratio) {
  return {{image_a, feature_a}, {image_b, feature_b}, ratio};
}

TEST(JoinTracks, JoinsLinksIntoTracksInAnyOrder) {
  std::vector<TrackLink> links = {Link(0, 5, 1, 7, 0.5), Link(2, 9, 1, 7, 0.6),
                                  Link(0, 6, 2, 1, 0.4)};
  const std::vector<FeatureTrack> tracks = JoinTracks(links);
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_THAT(tracks[0], ElementsAre(ImageFeature{0, 5}, ImageFeature{1, 7}, ImageFeature{2, 9}));
  EXPECT_THAT(tracks[1], ElementsAre(ImageFeature{0, 6}, ImageFeature{2, 1}));
  std::reverse(links.begin(), links.end());
  std::swap(links[0].a, links[0].b);
  EXPECT_EQ(JoinTracks(links), tracks);
  EXPECT_TRUE(JoinTracks({}).empty());
}

TEST(JoinTracks, NeverHoldsTwoFeaturesOfOneImage) {
  // The surer link from image 1 wins; the other track keeps the rest.
  const std::vector<FeatureTrack> tracks =
      JoinTracks({Link(0, 1, 1, 1, 0.3), Link(1, 1, 2, 1, 0.5), Link(2, 1, 0, 2, 0.4)});
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_THAT(tracks[0], ElementsAre(ImageFeature{0, 1}, ImageFeature{1, 1}));
  EXPECT_THAT(tracks[1], ElementsAre(ImageFeature{0, 2}, ImageFeature{2, 1}));
}

// Points with random descriptors, seen by cameras side by side.
struct Wall {
  Wall() {
    LensParameters parameters;
    parameters.width_px = 1000;
    parameters.height_px = 800;
    parameters.fx_px = parameters.fy_px = 700.0;
    parameters.cx_px = 499.5;
    parameters.cy_px = 399.5;
    const Lens lens = *Lens::Create(parameters);
    Random random(11);
    for (int p = 0; p < 150; ++p) {
      points.emplace_back(random.Uniform(-3, 3), random.Uniform(-2, 2), random.Uniform(7, 10));
    }
    for (int i = 0; i < 4; ++i) {
      const Rigid3 pose(Eigen::Quaterniond(Eigen::AngleAxisd(0.02 * i, Eigen::Vector3d(0, 1, 0))),
                        Eigen::Vector3d(-0.8 * i, 0.1 * i, 0.2 * i));
      images.push_back({"image" + std::to_string(i), lens, pose, {}});
    }
    Random looks(12);
    std::vector<std::vector<std::uint8_t>> look(points.size());
    for (auto& one : look) {
      for (int k = 0; k < 128; ++k) one.push_back(static_cast<std::uint8_t>(looks.Index(90)));
    }
    for (ReconstructedImage& image : images) {
      for (std::size_t p = 0; p < points.size(); ++p) {
        const auto pixel = image.lens.Project(image.camera_from_world * points[p]);
        if (!pixel) continue;
        Keypoint keypoint;
        keypoint.x_px = static_cast<float>(pixel->x() + 0.3 * random.Gaussian());
        keypoint.y_px = static_cast<float>(pixel->y() + 0.3 * random.Gaussian());
        keypoint.size_px = 3.0F;
        image.features.keypoints.push_back(keypoint);
        for (const std::uint8_t byte : look[p]) {
          image.features.descriptors.push_back(static_cast<std::uint8_t>(byte + random.Index(12)));
        }
      }
    }
  }

  std::vector<Eigen::Vector3d> points;
  std::vector<ReconstructedImage> images;  // feature p of each is point p: all are seen
};

TEST(BuildTracks, FindsWhatImagesHaveInCommonAndNothingElse) {
  const Wall wall;
  double done = 0.0;
  const std::vector<FeatureTrack> tracks =
      BuildTracks(wall.images, {}, [&](double share) { done = share; });
  EXPECT_EQ(done, 1.0);
  EXPECT_GT(tracks.size(), 145U);
  for (const FeatureTrack& track : tracks) {
    std::set<std::uint32_t> things;
    for (const ImageFeature& one : track) things.insert(one.feature);
    EXPECT_EQ(things.size(), 1U);
  }
}

TEST(BuildTracks, KeepsApartWhatLooksAlikeOffTheEpipolarLine) {
  Wall wall;
  // All points look the same: only geometry can tell, and along the line nothing can.
  for (ReconstructedImage& image : wall.images) {
    std::fill(image.features.descriptors.begin(), image.features.descriptors.end(),
              std::uint8_t{40});
  }
  EXPECT_LT(BuildTracks(wall.images, {}, [](double) {}).size(), 15U);
}

TEST(TriangulateTracks, ViewsThatDisagreeMakeTheirOwnLandmarkUncertainOnly) {
  Wall wall;
  const auto tracks = BuildTracks(wall.images, {}, [](double) {});
  const auto triangulate = [&] {
    Reconstruction reconstruction;
    reconstruction.images = wall.images;
    TriangulateTracks(tracks, {}, [](double) {}, &reconstruction);
    return reconstruction;
  };
  const Reconstruction before = triangulate();
  // One in twenty of the points is seen 1.5 px too high in one photograph.
  for (std::size_t p = 0; p < wall.points.size(); p += 20) {
    wall.images[1].features.keypoints[p].y_px += 1.5F;
  }
  const Reconstruction after = triangulate();
  EXPECT_NEAR(after.noise_px, before.noise_px, 0.1 * before.noise_px);
  ASSERT_EQ(after.points.size(), before.points.size());
  int enlarged = 0;
  for (std::size_t i = 0; i < after.points.size(); ++i) {
    const double times = after.points[i].covariance.trace() / before.points[i].covariance.trace();
    if (after.points[i].seen.front().feature % 20 == 0) {
      if (times > 1.5) ++enlarged;
    } else {
      EXPECT_NEAR(times, 1.0, 0.2);
    }
  }
  EXPECT_GE(enlarged, 5);
}

TEST(TriangulateTracks, GivesPointsWhereTheyAreAndTheNoise) {
  const Wall wall;
  Reconstruction reconstruction;
  reconstruction.images = wall.images;
  const auto tracks = BuildTracks(wall.images, {}, [](double) {});
  TriangulateTracks(tracks, {}, [](double) {}, &reconstruction);
  ASSERT_GT(reconstruction.points.size(), 145U);
  // 0.3 px of noise on features 3 px wide.
  const double relative_px = RelativeSigma_px(DescriptorKind::kRootSift, {0, 0, 3.0F, 0, 0});
  EXPECT_NEAR(reconstruction.noise_px, 0.3 / relative_px, 0.12);
  double sum = 0.0;
  for (const ReconstructedPoint& point : reconstruction.points) {
    const Eigen::Vector3d error = point.in_world - wall.points[point.seen.front().feature];
    sum += error.dot(point.covariance.ldlt().solve(error));
  }
  EXPECT_NEAR(sum / static_cast<double>(reconstruction.points.size()), 3.0, 0.9);
}

TEST(PairsToMatch, AreAllOfFewAndTheNearestOfMany) {
  Wall wall;
  EXPECT_EQ(PairsToMatch(wall.images).size(), 6U);
  std::vector<ReconstructedImage> street;
  for (int i = 0; i < 100; ++i) {
    street.push_back(wall.images.front());
    street.back().camera_from_world =
        Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-2.0 * i, 0, 0));
  }
  const auto pairs = PairsToMatch(street);
  EXPECT_LT(pairs.size(), 100U * 24U + 1U);
  for (const auto& [a, b] : pairs) EXPECT_LE(b - a, 24U);
}

}  // namespace
}  // namespace lodemark
