// Where photographs of two places were taken, against the survey; and photographs of other places.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/resection/unknown_focal.h"
#include "test/recorded/photo_scene.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

using test::FeaturesOf;
using test::Locate;
using test::Located;
using test::PhotoFeatures;
using test::PhotoScene;
using test::ReadPhotoScene;
using test::RecordingPath;
using test::SurveyedPhoto;
using test::UsualLens;

constexpr const char* kFountain = "vision/strecha_fountain_p11";
constexpr const char* kCastle = "vision/strecha_castle_p19";

bool IsAccepted(const ResectedPose& pose) {
  return pose.verdict == PoseVerdict::kPose || pose.verdict == PoseVerdict::kWeak;
}

struct Errors {
  double mean_m = 0.0;
  double worst_m = 0.0;
  std::vector<double> squares;  // Mahalanobis distances to the survey by the stated covariance
};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Of the photographs the map was not made from (or was, to see how well map and survey agree).
Errors LocateAll(const PhotoScene& scene, bool queries) {
  Errors errors;
  int count = 0;
  for (const SurveyedPhoto& photo : scene.photos) {
    if (photo.is_query != queries) continue;
    const Located located = Locate(*scene.map, scene.lens, FeaturesOf(photo.path).features);
    EXPECT_EQ(located.pose.verdict, PoseVerdict::kPose) << photo.path;
    const double first_m = (located.first.centre_in_enu_m() - photo.camera_in_enu_m).norm();
    const double error_m = (located.pose.centre_in_enu_m() - photo.camera_in_enu_m).norm();
    std::printf("%s: %.2f cm, then %.2f cm (sigma %.2f cm, shared %.2f cm), %d then %d inliers\n",
                photo.path.c_str() + photo.path.rfind('/') + 1, 100.0 * first_m, 100.0 * error_m,
                100.0 * std::sqrt(located.pose.covariance.topLeftCorner<3, 3>().trace()),
                100.0 * located.pose.shared_sigma_m, located.first.inliers, located.pose.inliers);
    const Eigen::Matrix3d stated_m2 = located.pose.covariance.topLeftCorner<3, 3>();
    const Eigen::Vector3d offset_m = located.pose.centre_in_enu_m() - photo.camera_in_enu_m;
    const Eigen::Vector3d weighted = stated_m2.ldlt().solve(offset_m);
    errors.squares.push_back(offset_m.dot(weighted));
    errors.mean_m += error_m;
    errors.worst_m = std::max(errors.worst_m, error_m);
    ++count;
  }
  errors.mean_m /= std::max(1, count);
  std::printf("mean %.2f cm, worst %.2f cm of %d; median square in sigmas %.1f\n",
              100.0 * errors.mean_m, 100.0 * errors.worst_m, count, Median(errors.squares));
  return errors;
}

TEST(RecordedPhotos, AreLocatedAtTheFountainWithinMillimetres) {
  LODEMARK_NEEDS_RECORDING(kFountain);
  const auto scene = ReadPhotoScene(RecordingPath(kFountain));
  ASSERT_TRUE(scene);
  const Errors errors = LocateAll(*scene, true);
  EXPECT_LT(errors.mean_m, 0.003);
  EXPECT_LT(errors.worst_m, 0.006);
  EXPECT_LT(Median(errors.squares), 8.0);
}

// The survey of the courtyard holds no better than this: the photographs that the landmarks were
// triangulated from, with the surveyed poses, are themselves put 1.4 cm from there in the mean and
// 3.1 cm at worst, by sights whose noise alone makes 0.2 to 0.6 cm. pycolmap 4.2.1 with COLMAP's
// own features and exact matching, on the same landmarks: queries 3.2 cm in the mean, 2.4 cm in the
// median, 7.5 cm at worst; at the fountain 0.28 cm in the mean.
TEST(RecordedPhotos, AreLocatedInTheCastleCourtyardWithinCentimetres) {
  LODEMARK_NEEDS_RECORDING(kCastle);
  const auto scene = ReadPhotoScene(RecordingPath(kCastle));
  ASSERT_TRUE(scene);
  const Errors queries = LocateAll(*scene, true);
  EXPECT_LT(queries.mean_m, 0.032);
  EXPECT_LT(queries.worst_m, 0.08);
  EXPECT_LT(Median(queries.squares), 6.0);
  const Errors known = LocateAll(*scene, false);
  EXPECT_LT(known.mean_m, 0.018);
  EXPECT_LT(known.worst_m, 0.04);
  EXPECT_LT(Median(known.squares), 6.0);
}

// Two thirds of the lens's focal lengths: what somebody may guess of a camera.
Lens ShortenedLens(const Lens& lens) {
  LensParameters parameters = lens.parameters();
  parameters.fx_px *= 0.67;
  parameters.fy_px *= 0.67;
  return *Lens::Create(parameters);
}

TEST(RecordedPhotos, TellTheFocalLengthTheyWereTakenWith) {
  LODEMARK_NEEDS_RECORDING(kFountain);
  LODEMARK_NEEDS_RECORDING(kCastle);
  std::vector<double> squares;
  for (const char* recording : {kFountain, kCastle}) {
    const auto scene = ReadPhotoScene(RecordingPath(recording));
    ASSERT_TRUE(scene);
    for (const SurveyedPhoto& photo : scene->photos) {
      if (!photo.is_query) continue;
      const Located located = Locate(*scene->map, scene->lens, FeaturesOf(photo.path).features);
      const Result<ResectedCamera> camera =
          ResectWithFocal(located.first_sights, ShortenedLens(scene->lens), {}, {});
      ASSERT_TRUE(camera.ok());
      EXPECT_TRUE(IsAccepted(camera->pose)) << photo.path;
      const double off_px = camera->focal_px - scene->lens.parameters().fx_px;
      const double error_m = (camera->pose.centre_in_enu_m() - photo.camera_in_enu_m).norm();
      std::printf("%s: focal length %+.2f px off (sigma %.2f px), place %.2f cm\n",
                  photo.path.c_str() + photo.path.rfind('/') + 1, off_px, camera->focal_sigma_px,
                  100.0 * error_m);
      EXPECT_LT(std::abs(off_px), 0.005 * scene->lens.parameters().fx_px);
      EXPECT_LT(error_m, 0.15);
      squares.push_back(off_px * off_px / (camera->focal_sigma_px * camera->focal_sigma_px));
    }
  }
  EXPECT_GE(squares.size(), 9U);
  EXPECT_LT(Median(squares), 4.0);
}

// Files of a recording's images, every so many.
std::vector<std::string> Images(const std::string& recording, std::size_t step) {
  std::vector<std::string> all;
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator(RecordingPath(recording) + "/images", error)) {
    if (entry.is_regular_file()) all.push_back(entry.path().string());
  }
  std::sort(all.begin(), all.end());
  std::vector<std::string> some;
  for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  return some;
}

TEST(RecordedPhotos, OfOtherPlacesAreNeverLocated) {
  LODEMARK_NEEDS_RECORDING(kFountain);
  LODEMARK_NEEDS_RECORDING(kCastle);
  const auto fountain = ReadPhotoScene(RecordingPath(kFountain));
  const auto castle = ReadPhotoScene(RecordingPath(kCastle));
  ASSERT_TRUE(fountain && castle);
  int asked = 0;
  const auto expect_not_in = [&](const PhotoScene& scene, const Lens& lens,
                                 const Features& features, const std::string& path) {
    const ResectedPose pose = Locate(*scene.map, lens, features).first;
    EXPECT_FALSE(IsAccepted(pose))
        << path << ": " << pose.inliers << " inliers, chance " << pose.log10_chance;
    ++asked;
  };
  for (const SurveyedPhoto& photo : castle->photos) {
    expect_not_in(*fountain, castle->lens, FeaturesOf(photo.path).features, photo.path);
  }
  for (const auto& [recording, step] :
       {std::pair<const char*, std::size_t>{"vision/lund_photos_gps", 1},
        {"vision/copr_gcp_20090902", 1},
        {"vision/kitti00_20111003", 12},
        {"vision/planar_pairs", 1}}) {
    for (const std::string& path : Images(recording, step)) {
      const PhotoFeatures photo = FeaturesOf(path);
      const Lens lens = UsualLens(photo.width_px, photo.height_px);
      expect_not_in(*fountain, lens, photo.features, path);
      expect_not_in(*castle, lens, photo.features, path);
    }
  }
  std::printf("%d queries\n", asked);
  EXPECT_GE(asked, 100);
}

// The fountain stands in the castle's courtyard: the last photographs of it show the facade beside,
// which the castle's map knows. The two surveys have frames of their own, but distances between
// the cameras are the same in both.
TEST(RecordedPhotos, OfTheFountainAreLocatedInTheCourtyardItStandsIn) {
  LODEMARK_NEEDS_RECORDING(kFountain);
  LODEMARK_NEEDS_RECORDING(kCastle);
  const auto fountain = ReadPhotoScene(RecordingPath(kFountain));
  const auto castle = ReadPhotoScene(RecordingPath(kCastle));
  ASSERT_TRUE(fountain && castle);
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> places;  // by survey, by the other's map
  for (const SurveyedPhoto& photo : fountain->photos) {
    const ResectedPose pose =
        Locate(*castle->map, fountain->lens, FeaturesOf(photo.path).features).pose;
    if (IsAccepted(pose)) places.emplace_back(photo.camera_in_enu_m, pose.centre_in_enu_m());
  }
  EXPECT_GE(places.size(), 3U);
  for (const auto& [surveyed_m, found_m] : places) {
    for (const auto& [other_surveyed_m, other_found_m] : places) {
      EXPECT_NEAR((found_m - other_found_m).norm(), (surveyed_m - other_surveyed_m).norm(), 0.15);
    }
  }
}

}  // namespace
}  // namespace lodemark
