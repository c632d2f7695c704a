#include "core/map/feature_map_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "test/unit/map/map_scene.h"

namespace lodemark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::unique_ptr<FeatureMapWriter> Written(const std::string& path) {
  Result<std::unique_ptr<FeatureMapWriter>> writer = FeatureMapWriter::Open(path);
  EXPECT_TRUE(writer.ok()) << writer.error().message;
  return writer ? *std::move(writer) : nullptr;
}

std::vector<std::uint32_t> LandmarkIds(const FeatureMap& map) {
  std::vector<std::uint32_t> ids;
  const Result<std::vector<Landmark>> landmarks = map.Landmarks();
  EXPECT_TRUE(landmarks.ok()) << landmarks.error().message;
  for (const Landmark& landmark : *landmarks) ids.push_back(landmark.id);
  return ids;
}

// The maps hold the same, whatever their lists are like.
void ExpectSameContent(const std::string& path_a, const std::string& path_b) {
  const auto a = FeatureMap::Open(path_a);
  const auto b = FeatureMap::Open(path_b);
  ASSERT_TRUE(a.ok()) << a.error().message;
  ASSERT_TRUE(b.ok()) << b.error().message;
  EXPECT_EQ((*a)->info().landmarks, (*b)->info().landmarks);
  EXPECT_EQ((*a)->info().descriptors, (*b)->info().descriptors);
  EXPECT_EQ((*a)->info().images, (*b)->info().images);
  EXPECT_EQ((*a)->landmark_id_limit(), (*b)->landmark_id_limit());
  EXPECT_EQ(LandmarkIds(**a), LandmarkIds(**b));
  const auto in_a = DescriptorsOf(**a);
  const auto in_b = DescriptorsOf(**b);
  ASSERT_EQ(in_a.size(), in_b.size());
  for (std::size_t i = 0; i < in_a.size(); ++i) ASSERT_EQ(in_a[i], in_b[i]) << i;
  for (const auto* map : {&*a, &*b}) {
    for (const Error& error : (*map)->Check(10)) ADD_FAILURE() << error.message;
  }
}

MapScene::Size Large() {
  MapScene::Size size;
  size.landmarks = 1500;
  size.images = 9;
  return size;
}

TEST(FeatureMapWriter, RemovingImagesIsAsIfTheyHadNeverBeenThere) {
  const ScratchFolder folder;
  const MapScene scene(11, Large());
  ASSERT_TRUE(scene.Make(folder.File("changed.db")).ok());
  {
    const auto writer = Written(folder.File("changed.db"));
    ASSERT_NE(writer, nullptr);
    for (const std::uint32_t id : {11U, 12U, 13U, 18U}) {
      const Status status = writer->RemoveImage(id);
      ASSERT_TRUE(status.ok()) << status.error().message;
    }
    ASSERT_TRUE(writer->Commit().ok());
  }
  auto writer = FeatureMapWriter::Create(folder.File("made.db"), scene.info);
  ASSERT_TRUE(scene.AddTo(**writer, {10, 14, 15, 16, 17}).ok());
  for (const BuildingPart& part : scene.parts) ASSERT_TRUE((*writer)->AddBuildingPart(part).ok());
  ASSERT_TRUE((*writer)->Commit().ok());
  EXPECT_LT((*FeatureMap::Open(folder.File("made.db")))->info().landmarks, 1500);
  ExpectSameContent(folder.File("changed.db"), folder.File("made.db"));
}

TEST(FeatureMapWriter, AddingInStepsIsAsGoodAsAtOnce) {
  const ScratchFolder folder;
  MapScene::Size size = Large();
  size.views = 1;  // so that every landmark comes with one image
  const MapScene scene(12, size);
  ASSERT_TRUE(scene.Make(folder.File("once.db")).ok());
  auto writer = FeatureMapWriter::Create(folder.File("steps.db"), scene.info);
  ASSERT_TRUE(scene.AddTo(**writer, {10, 11, 12, 13, 14, 15}).ok());
  ASSERT_TRUE((*writer)->Commit().ok());
  // The same writer goes on, and then another.
  ASSERT_TRUE(scene.AddTo(**writer, {16}).ok());
  ASSERT_TRUE((*writer)->Commit().ok());
  writer->reset();
  const auto next = Written(folder.File("steps.db"));
  ASSERT_NE(next, nullptr);
  ASSERT_TRUE(scene.AddTo(*next, {17, 18}).ok());
  for (const BuildingPart& part : scene.parts) ASSERT_TRUE(next->AddBuildingPart(part).ok());
  ASSERT_TRUE(next->Commit().ok());
  ExpectSameContent(folder.File("steps.db"), folder.File("once.db"));
}

TEST(FeatureMapWriter, PutsBackWhatItRemoved) {
  const ScratchFolder folder;
  MapScene::Size size = Large();
  size.views = 1;
  const MapScene scene(13, size);
  ASSERT_TRUE(scene.Make(folder.File("once.db")).ok());
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  const auto writer = Written(folder.File("map.db"));
  ASSERT_NE(writer, nullptr);
  ASSERT_TRUE(writer->RemoveImage(14).ok());
  ASSERT_TRUE(scene.AddTo(*writer, {14}).ok());
  ASSERT_TRUE(writer->RemoveImage(14).ok());  // this time from what was not committed yet
  ASSERT_TRUE(scene.AddTo(*writer, {14}).ok());
  ASSERT_TRUE(writer->Commit().ok());
  ExpectSameContent(folder.File("map.db"), folder.File("once.db"));
}

TEST(FeatureMapWriter, TouchesOnlyTheListsThatHoldTheImage) {
  const ScratchFolder folder;
  const MapScene scene(14);
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  const auto writer = Written(folder.File("map.db"));
  ASSERT_NE(writer, nullptr);
  const Status status = writer->RemoveImage(99);
  EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(status.error().message, HasSubstr("map.db: images: id 99: there is no such image"));
}

TEST(FeatureMapWriter, RemovesLandmarksWithTheirDescriptors) {
  const ScratchFolder folder;
  const MapScene scene(15, Large());
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  {
    const auto writer = Written(folder.File("map.db"));
    const std::vector<std::uint32_t> unknown = {1, 2};
    EXPECT_THAT(writer->RemoveLandmarks(unknown).error().message, HasSubstr("id 2"));
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 3; i < scene.landmarks.size(); ++i) ids.push_back(scene.landmarks[i].id);
    ASSERT_TRUE(writer->RemoveLandmarks(ids).ok());
    ASSERT_TRUE(writer->Commit().ok());
  }
  const auto map = FeatureMap::Open(folder.File("map.db"));
  ASSERT_TRUE(map.ok()) << map.error().message;
  EXPECT_THAT(LandmarkIds(**map), ElementsAre(1, 4, 7));
  EXPECT_EQ(DescriptorsOf(**map).size(), 9U);
  EXPECT_THAT((*map)->Check(10), IsEmpty());
}

TEST(FeatureMapWriter, LearnsANewIndexWhenAskedAndWhenOutgrown) {
  const ScratchFolder folder;
  const MapScene scene(16, Large());
  ASSERT_TRUE(scene.Make(folder.File("once.db")).ok());
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  {
    const auto writer = Written(folder.File("map.db"));
    ASSERT_TRUE(writer->Reindex(77).ok());
    ASSERT_TRUE(writer->Commit().ok());
  }
  ExpectSameContent(folder.File("map.db"), folder.File("once.db"));

  MapScene::Size size = Large();
  size.views = 1;
  size.landmarks = 25'000;
  size.images = 2;
  MapScene growing(17, size);
  auto writer = FeatureMapWriter::Create(folder.File("growing.db"), growing.info);
  ASSERT_TRUE((*writer)->AddLandmark(growing.landmarks[0]).ok());
  ASSERT_TRUE((*writer)
                  ->AddDescriptors({growing.origins.data(), 1}, {growing.descriptors.data(), 128})
                  .ok());
  ASSERT_TRUE((*writer)->Commit().ok());
  EXPECT_EQ((*FeatureMap::Open(folder.File("growing.db")))->quantizer().list_count(), 1);
  growing.origins.erase(growing.origins.begin());
  growing.descriptors.erase(growing.descriptors.begin(), growing.descriptors.begin() + 128);
  ASSERT_TRUE(growing.AddTo(**writer).ok());
  ASSERT_TRUE((*writer)->Commit().ok());
  const auto map = FeatureMap::Open(folder.File("growing.db"));
  ASSERT_TRUE(map.ok()) << map.error().message;
  EXPECT_GT((*map)->quantizer().list_count(), 1);
  EXPECT_EQ((*map)->info().descriptors, 25'000);
  EXPECT_THAT((*map)->Check(10), IsEmpty());
}

TEST(FeatureMapWriter, LeavesTheOldStateWithoutCommit) {
  const ScratchFolder folder;
  const MapScene scene(18);
  {
    auto writer = FeatureMapWriter::Create(folder.File("never.db"), scene.info);
  }
  EXPECT_THAT(std::filesystem::is_empty(folder.path()), true);

  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  const std::vector<std::uint8_t> before = ReadBytes(folder.File("map.db"));
  {
    const auto writer = Written(folder.File("map.db"));
    ASSERT_TRUE(writer->RemoveImage(10).ok());
    ASSERT_TRUE(writer->AddLandmark({7000, {0, 0, 0}, Eigen::Matrix3d::Identity()}).ok());
  }
  EXPECT_EQ(ReadBytes(folder.File("map.db")), before);
}

TEST(FeatureMapWriter, LetsReadersSeeTheOldStateAndTellsThemOfTheNew) {
  const ScratchFolder folder;
  const MapScene scene(19);
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  const auto map = FeatureMap::Open(folder.File("map.db"));
  ASSERT_TRUE(map.ok());
  const std::vector<StoredDescriptor> before = DescriptorsOf(**map);
  const auto writer = Written(folder.File("map.db"));
  ASSERT_TRUE(writer->RemoveImage(10).ok());
  EXPECT_EQ(DescriptorsOf(**map), before);
  EXPECT_EQ(DescriptorsOf(**FeatureMap::Open(folder.File("map.db"))), before);
  const Status committed = writer->Commit();
  ASSERT_TRUE(committed.ok()) << committed.error().message;
  const auto landmarks = (*map)->Landmarks();
  ASSERT_FALSE(landmarks.ok());
  EXPECT_THAT(landmarks.error().message, HasSubstr("changed since it was opened; open it again"));
  EXPECT_LT(DescriptorsOf(**FeatureMap::Open(folder.File("map.db"))).size(), before.size());
}

TEST(FeatureMapWriter, LetsNoOtherWriterIn) {
  const ScratchFolder folder;
  ASSERT_TRUE(MapScene(20).Make(folder.File("map.db")).ok());
  const auto writer = Written(folder.File("map.db"));
  const auto second = FeatureMapWriter::Open(folder.File("map.db"));
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().message, HasSubstr("in use by another"));
}

TEST(FeatureMapWriter, RefusesWhatAMapCannotHold) {
  const ScratchFolder folder;
  const MapScene scene(21);
  auto made = FeatureMapWriter::Create(folder.File("map.db"), scene.info);
  ASSERT_TRUE(made.ok());
  FeatureMapWriter& writer = **made;
  const auto message = [&](const Landmark& landmark) {
    const Status status = writer.AddLandmark(landmark);
    return status ? "added" : status.error().message;
  };
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  EXPECT_EQ(message({5, {1, 2, 3}, unit}), "added");
  EXPECT_EQ(message({6, {1, 2, 3}, Eigen::Matrix3d::Zero()}), "added");
  EXPECT_THAT(message({5, {1, 2, 3}, unit}),
              HasSubstr("map.db: landmarks: id 5: is there already"));
  EXPECT_THAT(message({7, {1, NAN, 3}, unit}), HasSubstr("position is not finite"));
  EXPECT_THAT(message({7, {1, 1e5, 3}, unit}), HasSubstr("100 km"));
  EXPECT_THAT(message({7, {1, 1, 3}, -unit}), HasSubstr("covariance is not positive"));
  EXPECT_THAT(message({7, {1, 1, 3}, 2e6 * unit}), HasSubstr("covariance is above"));
  EXPECT_THAT(message({1U << 26, {1, 1, 3}, unit}), HasSubstr("id is above"));
  Eigen::Matrix3d covariance_m2 = unit;
  covariance_m2(0, 1) = 0.5;
  EXPECT_THAT(message({7, {1, 1, 3}, covariance_m2}), HasSubstr("covariance is not symmetric"));
  covariance_m2(1, 0) = 0.5;
  EXPECT_EQ(message({7, {1, 1, 3}, covariance_m2}), "added");
  covariance_m2(0, 1) = covariance_m2(1, 0) = 1.01;
  EXPECT_THAT(message({8, {1, 1, 3}, covariance_m2}), HasSubstr("covariance is not positive"));
  // Each pair could be, all three together could not.
  covariance_m2 << 1, 0.9, -0.9, 0.9, 1, 0.9, -0.9, 0.9, 1;
  EXPECT_THAT(message({8, {1, 1, 3}, covariance_m2}), HasSubstr("covariance is not positive"));
  covariance_m2(2, 1) = NAN;
  EXPECT_THAT(message({8, {1, 1, 3}, covariance_m2}), HasSubstr("covariance is not finite"));

  DatabaseImage image = scene.images[0];
  EXPECT_TRUE(writer.AddImage(image).ok());
  EXPECT_FALSE(writer.AddImage(image).ok());
  image.id = 50;
  image.camera_from_enu.coeffs() *= 1.1;
  EXPECT_THAT(writer.AddImage(image).error().message, HasSubstr("not a unit quaternion"));
  image = scene.images[1];
  image.name = "a\x1b[2Jb";
  EXPECT_THAT(writer.AddImage(image).error().message, HasSubstr("not plain UTF-8 text"));
  image.name = "\xc3";
  EXPECT_FALSE(writer.AddImage(image).ok());
  image.name = "Zürich 北京 \xf0\x9f\x97\xba";
  EXPECT_TRUE(writer.AddImage(image).ok());
  BuildingPart part = scene.parts[0];
  EXPECT_TRUE(writer.AddBuildingPart(part).ok());
  EXPECT_FALSE(writer.AddBuildingPart(part).ok());
  part.id = 50;
  part.footprint_in_enu_m[1].x() = INFINITY;
  EXPECT_FALSE(writer.AddBuildingPart(part).ok());
  part = scene.parts[1];
  std::swap(part.footprint_in_enu_m[0], part.footprint_in_enu_m[1]);
  EXPECT_THAT(writer.AddBuildingPart(part).error().message, HasSubstr("footprint is not convex"));
  part.footprint_in_enu_m.clear();
  EXPECT_FALSE(writer.AddBuildingPart(part).ok());

  std::vector<std::uint8_t> descriptor(128);
  DescriptorOrigin origin;
  origin.landmark_id = 5;
  EXPECT_TRUE(writer.AddDescriptors({&origin, 1}, descriptor).ok());
  EXPECT_FALSE(writer.AddDescriptors({&origin, 1}, {descriptor.data(), 127}).ok());
  origin.direction_to_camera = {0.5F, 0, 0};
  EXPECT_FALSE(writer.AddDescriptors({&origin, 1}, descriptor).ok());
  origin.direction_to_camera = {1, 0, 0};
  origin.distance_m = NAN;
  EXPECT_FALSE(writer.AddDescriptors({&origin, 1}, descriptor).ok());

  // None of that did harm, and a landmark that is missing can still be added.
  origin.distance_m = 3.0F;
  origin.landmark_id = 9;
  ASSERT_TRUE(writer.AddDescriptors({&origin, 1}, descriptor).ok());
  EXPECT_THAT(writer.Commit().error().message,
              HasSubstr("landmarks: id 9: has descriptors but was not added"));
  EXPECT_EQ(message({9, {1, 2, 3}, unit}), "added");
  EXPECT_TRUE(writer.Commit().ok());
  const auto map = FeatureMap::Open(folder.File("map.db"));
  EXPECT_THAT(LandmarkIds(**map), ElementsAre(5, 6, 7, 9));
  EXPECT_EQ((*map)->info().descriptors, 2);
  EXPECT_THAT((*map)->Check(9), IsEmpty());
}

TEST(FeatureMapWriter, DoesNotWriteOverAFile) {
  const ScratchFolder folder;
  WriteBytes(folder.File("map.db"), {1, 2, 3});
  const auto writer = FeatureMapWriter::Create(folder.File("map.db"), MapInfo());
  ASSERT_FALSE(writer.ok());
  EXPECT_THAT(writer.error().message, HasSubstr("map.db: exists already"));
  EXPECT_EQ(ReadBytes(folder.File("map.db")).size(), 3U);
  EXPECT_THAT(FeatureMapWriter::Create(folder.File("no/map.db"), MapInfo()).error().message,
              HasSubstr("cannot be made"));
  MapInfo info;
  info.origin.latitude_rad = 2.0;
  EXPECT_THAT(FeatureMapWriter::Create(folder.File("new.db"), info).error().message,
              HasSubstr("latitude of the origin"));
  EXPECT_FALSE(std::filesystem::exists(folder.File("new.db")));
  EXPECT_THAT(FeatureMapWriter::Open(folder.File("map.db")).error().message,
              HasSubstr("not an SQLite file"));
}

TEST(FeatureMapWriter, KeepsTheOldStateWhenTheDiskIsFull) {
  const ScratchFolder folder;
  const MapScene scene(22);
  ASSERT_TRUE(scene.Make(folder.File("map.db")).ok());
  const auto before = DescriptorsOf(**FeatureMap::Open(folder.File("map.db")));

  // A limit on the size of files stands in for a disk without room.
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  {
    const auto writer = Written(folder.File("map.db"));
    rlimit limit = old_limit;
    limit.rlim_cur = ReadBytes(folder.File("map.db")).size();
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const MapScene more(23, Large());
    Status status;
    for (std::size_t i = 0; i < more.origins.size() && status; ++i) {
      DescriptorOrigin origin = more.origins[i];
      origin.landmark_id = 1;
      status = writer->AddDescriptors({&origin, 1}, {more.descriptors.data() + i * 128, 128});
    }
    if (status) status = writer->Commit();
    setrlimit(RLIMIT_FSIZE, &old_limit);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::kIo);
    EXPECT_THAT(status.error().message, HasSubstr("map.db: "));
    EXPECT_FALSE(writer->AddLandmark({900, {0, 0, 0}, Eigen::Matrix3d::Zero()}).ok());
  }
  std::signal(SIGXFSZ, old_handler);
  const auto map = FeatureMap::Open(folder.File("map.db"));
  ASSERT_TRUE(map.ok()) << map.error().message;
  EXPECT_EQ(DescriptorsOf(**map), before);
  EXPECT_THAT((*map)->Check(9), IsEmpty());
}

}  // namespace
}  // namespace lodemark
