#include "core/map/feature_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/map/map_scene.h"

namespace lodemark {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::unique_ptr<FeatureMap> Opened(const std::string& path) {
  Result<std::unique_ptr<FeatureMap>> map = FeatureMap::Open(path);
  EXPECT_TRUE(map.ok()) << map.error().message;
  return map ? *std::move(map) : nullptr;
}

std::string AllMessages(const std::vector<Error>& errors) {
  std::string messages;
  for (const Error& error : errors) messages += error.message + "\n";
  return messages;
}

class MapOfKind : public ::testing::TestWithParam<DescriptorKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, MapOfKind,
                         ::testing::Values(DescriptorKind::kRootSift, DescriptorKind::kOrb));

TEST_P(MapOfKind, GivesBackWhatWasPutIn) {
  const ScratchFolder folder;
  MapScene::Size size;
  size.kind = GetParam();
  size.landmarks = 700;
  const MapScene scene(1, size);
  const Status made = scene.Make(folder.File("map.db"));
  ASSERT_TRUE(made.ok()) << made.error().message;
  const auto map = Opened(folder.File("map.db"));
  ASSERT_NE(map, nullptr);

  EXPECT_EQ(map->info().id.size(), 32U);
  EXPECT_EQ(map->info().origin.latitude_rad, scene.info.origin.latitude_rad);
  EXPECT_EQ(map->info().origin.longitude_rad, scene.info.origin.longitude_rad);
  EXPECT_EQ(map->info().origin.height_m, scene.info.origin.height_m);
  EXPECT_EQ(map->info().datum, scene.info.datum);
  EXPECT_EQ(map->info().epoch_year, scene.info.epoch_year);
  EXPECT_EQ(map->info().descriptor_kind, GetParam());
  EXPECT_EQ(map->info().provenance, scene.info.provenance);
  EXPECT_EQ(map->info().landmarks, 700);
  EXPECT_EQ(map->info().descriptors, 2100);
  EXPECT_EQ(map->info().images, 6);
  EXPECT_EQ(map->info().building_parts, 2);
  EXPECT_EQ(map->landmark_id_limit(), scene.landmarks.back().id + 1);

  const auto landmarks = map->Landmarks();
  ASSERT_TRUE(landmarks.ok()) << landmarks.error().message;
  ASSERT_EQ(landmarks->size(), scene.landmarks.size());
  for (std::size_t i = 0; i < landmarks->size(); ++i) {
    EXPECT_EQ((*landmarks)[i].id, scene.landmarks[i].id);
    EXPECT_EQ((*landmarks)[i].position_in_enu_m, scene.landmarks[i].position_in_enu_m);
    EXPECT_TRUE((*landmarks)[i].covariance_m2.isApprox(scene.landmarks[i].covariance_m2, 1e-15));
  }
  const auto images = map->Images();
  ASSERT_TRUE(images.ok()) << images.error().message;
  ASSERT_EQ(images->size(), scene.images.size());
  for (std::size_t i = 0; i < images->size(); ++i) {
    EXPECT_EQ((*images)[i].id, scene.images[i].id);
    EXPECT_EQ((*images)[i].name, scene.images[i].name);
    EXPECT_EQ((*images)[i].pose_known, scene.images[i].pose_known);
    EXPECT_EQ((*images)[i].position_in_enu_m, scene.images[i].position_in_enu_m);
    EXPECT_EQ((*images)[i].camera_from_enu.coeffs(), scene.images[i].camera_from_enu.coeffs());
  }
  const auto parts = map->BuildingParts();
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ASSERT_EQ(parts->size(), 2U);
  EXPECT_EQ((*parts)[1].id, 9U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*parts)[i].building, scene.parts[i].building);
    EXPECT_EQ((*parts)[i].footprint_in_enu_m, scene.parts[i].footprint_in_enu_m);
    EXPECT_EQ((*parts)[i].base_m, scene.parts[i].base_m);
    EXPECT_EQ((*parts)[i].top_m, scene.parts[i].top_m);
    EXPECT_EQ((*parts)[i].top_sigma_m, scene.parts[i].top_sigma_m);
    EXPECT_EQ((*parts)[i].raised, scene.parts[i].raised);
  }

  const std::vector<StoredDescriptor> stored = DescriptorsOf(*map);
  ASSERT_EQ(stored.size(), scene.origins.size());
  std::vector<StoredDescriptor> expected;
  for (std::size_t i = 0; i < scene.origins.size(); ++i) {
    expected.push_back(Comparable(
        scene.origins[i], scene.descriptors.data() + i * scene.bytes_each(), scene.bytes_each()));
  }
  std::sort(expected.begin(), expected.end());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    EXPECT_EQ(std::get<0>(stored[i]), std::get<0>(expected[i]));
    EXPECT_EQ(std::get<1>(stored[i]), std::get<1>(expected[i]));
    EXPECT_EQ(std::get<3>(stored[i]), std::get<3>(expected[i]));
    // The packed form keeps the direction to a degree and the distance to a thousandth.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(std::get<2>(stored[i])[axis], std::get<2>(expected[i])[axis], 200);
    }
    const auto distance_mm = static_cast<double>(std::get<2>(expected[i])[3]);
    EXPECT_NEAR(std::get<2>(stored[i])[3], distance_mm, 1e-3 * distance_mm);
  }
  EXPECT_EQ(AllMessages(map->Check(10)), "");
}

TEST(FeatureMap, FindsTheLandmarksAroundAPlace) {
  const ScratchFolder folder;
  MapScene::Size size;
  size.landmarks = 2000;
  size.views = 0;
  MapScene scene(2, size);
  auto writer = FeatureMapWriter::Create(folder.File("map.db"), scene.info);
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  for (const Landmark& landmark : scene.landmarks) {
    ASSERT_TRUE((*writer)->AddLandmark(landmark).ok());
  }
  ASSERT_TRUE((*writer)->Commit().ok());
  const auto map = Opened(folder.File("map.db"));
  ASSERT_NE(map, nullptr);
  Random random(3);
  std::size_t found = 0;
  for (int query = 0; query < 50; ++query) {
    const Eigen::Vector3d place(random.Uniform(-900, 900), random.Uniform(-900, 900), 10.0);
    const double distance_m = query == 0 ? 1e9 : random.Uniform(0, 400);
    std::vector<std::uint32_t> expected;
    for (const Landmark& landmark : scene.landmarks) {
      if ((landmark.position_in_enu_m - place).norm() <= distance_m)
        expected.push_back(landmark.id);
    }
    const auto landmarks = map->LandmarksWithin(place, distance_m);
    ASSERT_TRUE(landmarks.ok()) << landmarks.error().message;
    std::vector<std::uint32_t> ids;
    for (const Landmark& landmark : *landmarks) ids.push_back(landmark.id);
    EXPECT_EQ(ids, expected);
    found += ids.size();
  }
  EXPECT_GT(found, 2500U);
  // A landmark at the very edge counts.
  const Landmark& last = scene.landmarks.back();
  EXPECT_EQ(map->LandmarksWithin(last.position_in_enu_m, 0.0)->size(), 1U);
  EXPECT_THAT(*map->LandmarksWithin(last.position_in_enu_m, -1.0), IsEmpty());
  EXPECT_FALSE(map->LandmarksWithin({0, NAN, 0}, 1.0).ok());
}

TEST(FeatureMap, GivesLandmarksByIdAndLeavesOutUnknownOnes) {
  const ScratchFolder folder;
  const MapScene scene(4);
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  const auto map = Opened(folder.File("map.db"));
  ASSERT_NE(map, nullptr);
  const std::vector<std::uint32_t> ids = {0, 1, 4, 4, 5, 7, 4'000'000'000U};
  const auto landmarks = map->LandmarksById(ids);
  ASSERT_TRUE(landmarks.ok()) << landmarks.error().message;
  ASSERT_EQ(landmarks->size(), 3U);
  EXPECT_EQ((*landmarks)[1].id, 4U);
  EXPECT_EQ((*landmarks)[2].position_in_enu_m, scene.landmarks[2].position_in_enu_m);
  const std::vector<std::uint32_t> descending = {4, 1};
  EXPECT_FALSE(map->LandmarksById(descending).ok());
}

TEST(FeatureMap, HoldsNothingAsWell) {
  const ScratchFolder folder;
  auto writer = FeatureMapWriter::Create(folder.File("map.db"), MapInfo());
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  ASSERT_TRUE((*writer)->Commit().ok());
  const auto map = Opened(folder.File("map.db"));
  ASSERT_NE(map, nullptr);
  EXPECT_THAT(*map->Landmarks(), IsEmpty());
  EXPECT_THAT(*map->Images(), IsEmpty());
  EXPECT_THAT(*map->BuildingParts(), IsEmpty());
  EXPECT_THAT(*map->LandmarksWithin({0, 0, 0}, 10.0), IsEmpty());
  EXPECT_THAT(DescriptorsOf(*map), IsEmpty());
  EXPECT_EQ(map->landmark_id_limit(), 0U);
  EXPECT_EQ(AllMessages(map->Check(10)), "");
}

TEST(FeatureMap, LiesInMemoryAsWellAsInAFile) {
  const ScratchFolder folder;
  const MapScene scene(5);
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  const auto map = FeatureMap::OpenBytes("asset", ReadBytes(folder.File("map.db")));
  ASSERT_TRUE(map.ok()) << map.error().message;
  EXPECT_EQ(DescriptorsOf(**map), DescriptorsOf(*Opened(folder.File("map.db"))));
  EXPECT_EQ(AllMessages((*map)->Check(10)), "");
  EXPECT_THAT(FeatureMap::OpenBytes("asset", {}).error().message, HasSubstr("asset: is empty"));
}

TEST(FeatureMap, OpensByARelativePathThatLooksLikeSomethingElse) {
  const ScratchFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const MapScene scene(6);
  for (const char* name : {"file:map.db?mode=memory", ":memory:", "map.db"}) {
    EXPECT_TRUE(scene.Make(name).ok()) << name;
    EXPECT_TRUE(std::filesystem::exists(folder.File(name))) << name;
    EXPECT_TRUE(FeatureMap::Open(name).ok()) << name;
  }
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace lodemark
