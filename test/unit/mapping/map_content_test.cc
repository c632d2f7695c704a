#include "tools/mapping/map_content.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "test/unit/mapping/scratch_folder.h"
#include "tools/mapping/landmark_map.h"

namespace lodemark {
namespace {

MapContent Content() {
  MapContent content;
  DatabaseImage image;
  image.id = 4;
  image.name = "a.jpg";
  image.position_in_enu_m = {0.0, -10.0, 1.0};
  image.pose_known = true;
  content.images.push_back(image);
  for (std::uint32_t id = 1; id <= 300; ++id) {
    Landmark landmark;
    landmark.id = id;
    landmark.position_in_enu_m = {0.1 * id, 0.0, 1.0};
    landmark.covariance_m2 = 1e-4 * Eigen::Matrix3d::Identity();
    content.landmarks.push_back(landmark);
    DescriptorOrigin origin;
    origin.landmark_id = id;
    origin.image_id = id % 2 == 0 ? 4 : 0;
    content.origins.push_back(origin);
    for (std::uint32_t k = 0; k < 128; ++k) {
      content.descriptors.push_back(static_cast<std::uint8_t>((id * 7 + k * id) % 97));
    }
  }
  NoteViewingDirections(&content);
  return content;
}

TEST(MapContent, KnowsFromWhereLandmarksWereSeen) {
  const MapContent content = Content();
  EXPECT_EQ(content.origins[0].distance_m, 0.0F);  // no image
  const DescriptorOrigin& seen = content.origins[1];
  EXPECT_NEAR(seen.distance_m, std::hypot(0.2, 10.0), 1e-5);
  EXPECT_NEAR(seen.direction_to_camera.norm(), 1.0F, 1e-6F);
  EXPECT_LT(seen.direction_to_camera.y(), -0.99F);
}

TEST(WriteMap, WritesWhatOpensAgain) {
  const test::ScratchFolder folder;
  MapInfo info;
  info.datum = "ITRF2014";
  info.epoch_year = 2020.5;
  info.provenance = "a test";
  const std::string path = folder.File("street.map");
  double done = 0.0;
  const Status status = WriteMap(path, info, Content(), [&](double share) { done = share; });
  ASSERT_TRUE(status.ok()) << status.error().message;
  EXPECT_EQ(done, 1.0);
  const auto map = FeatureMap::Open(path);
  ASSERT_TRUE(map.ok()) << map.error().message;
  EXPECT_EQ((*map)->info().landmarks, 300);
  EXPECT_EQ((*map)->info().descriptors, 300);
  EXPECT_EQ((*map)->info().images, 1);
  EXPECT_EQ((*map)->info().datum, "ITRF2014");
  EXPECT_TRUE((*map)->Check(5).empty());
  EXPECT_FALSE(WriteMap(path, info, Content(), [](double) {}).ok());  // there already
}

TEST(WriteMap, LeavesNoFileBehindWhenItFails) {
  const test::ScratchFolder folder;
  MapContent content = Content();
  content.landmarks[7].position_in_enu_m.x() = 1e7;
  const std::string path = folder.File("street.map");
  EXPECT_FALSE(WriteMap(path, {}, content, [](double) {}).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(LandmarkMap, IsBuiltFromTableAndRawFiles) {
  const test::ScratchFolder folder;
  LandmarkMapInput input;
  input.landmarks = folder.Write("landmarks.csv",
                                 "landmark_id,lat_deg,lon_deg,h_ell_m,sigma_m\n"
                                 "5,48.00001,8.0,100,0.2\n2,48.0,8.0,101,\n");
  input.descriptor_ids = folder.Write("ids.bin", std::string_view("\5\0\0\0\2\0\0\0\5\0\0\0", 12));
  input.descriptors = folder.Write("d.bin", std::string(3 * 128, 'a'));
  const auto built = BuildLandmarkMap(input, [](const char*, double) {});
  ASSERT_TRUE(built.ok()) << built.error().message;
  ASSERT_EQ(built->content.landmarks.size(), 2U);
  EXPECT_EQ(built->content.landmarks[0].id, 2U);
  EXPECT_NEAR(built->content.landmarks[0].covariance_m2(0, 0), 0.0, 1e-12);
  EXPECT_NEAR(built->content.landmarks[1].covariance_m2(2, 2), 0.04, 1e-12);
  const Eigen::Vector3d apart =
      built->content.landmarks[1].position_in_enu_m - built->content.landmarks[0].position_in_enu_m;
  EXPECT_NEAR(apart.y(), 1.11, 0.01);
  EXPECT_NEAR(apart.z(), -1.0, 0.01);
  EXPECT_EQ(built->content.origins.size(), 3U);
  input.frame.local = true;
  EXPECT_FALSE(BuildLandmarkMap(input, [](const char*, double) {}).ok());
}

}  // namespace
}  // namespace lodemark
