// Maps of real photographs with surveyed poses: do landmarks lie where others put them, and are
// photographs that the map never saw found?
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/map/descriptor.h"
#include "core/session/photo_position.h"
#include "test/recordings.h"
#include "test/unit/mapping/scratch_folder.h"
#include "tools/mapping/compression.h"
#include "tools/mapping/landmark_table.h"
#include "tools/mapping/posed_map.h"
#include "tools/mapping/poses_table.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

constexpr char kFountain[] = "vision/strecha_fountain_p11";

PosedMapInput InputFor(const std::string& folder) {
  PosedMapInput input;
  input.images = folder + "/images";
  input.poses = folder + "/poses.csv";
  input.camera_positions = folder + "/cameras_geodetic.csv";
  input.role = "database";
  input.position_sigma_m = 0.01;
  input.detector.most_features = 8000;
  input.detector.longest_side_px = 0;
  return input;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Distances of the query photographs' centres from the surveyed ones; infinite without a pose.
std::vector<double> QueryErrors(const std::string& folder, const std::string& map_path) {
  std::vector<double> errors_m;
  const auto map = FeatureMap::Open(map_path);
  if (!map) return errors_m;
  const auto poses = ReadPosesTable(folder + "/poses.csv");
  const auto places = ReadCameraPlaces(folder + "/cameras_geodetic.csv", {});
  if (!poses || !places) return errors_m;
  const EnuFrame frame((*map)->info().origin);
  for (std::size_t i = 0; i < poses->size(); ++i) {
    if ((*places)[i].role != "query") continue;
    const auto photo = ReadPhoto(folder + "/images/" + (*poses)[i].name);
    if (!photo) return {};
    PhotoOptions options;
    options.detector.longest_side_px = 0;
    const auto found = LocatePhoto(
        **map, {photo->pixels.data(), photo->width_px, photo->height_px, photo->width_px},
        *Lens::Create(*(*poses)[i].pinhole), {}, options);
    const bool has_pose = found && (found->pose.verdict == PoseVerdict::kPose ||
                                    found->pose.verdict == PoseVerdict::kWeak);
    errors_m.push_back(
        has_pose
            ? (found->pose.centre_in_enu_m() - frame.FromEcef((*places)[i].place.point_m)).norm()
            : 1e9);
  }
  return errors_m;
}

TEST(PosedMapRecorded, FountainsLandmarksLieOnThoseOfAnotherTriangulation) {
  LODEMARK_NEEDS_RECORDING(kFountain);
  const std::string folder = test::RecordingPath(kFountain);
  Result<BuiltMap> built = BuildPosedMap(InputFor(folder), [](const char*, double) {});
  ASSERT_TRUE(built.ok()) << built.error().message;
  EXPECT_EQ(built->registration->used, 11);
  EXPECT_NEAR(built->registration->enu_from_model.scale, 1.0, 1e-4);
  EXPECT_GT(built->content.landmarks.size(), 5000U);
  const auto theirs = ReadLandmarkTable(folder + "/landmarks.csv.gz", {});
  ASSERT_TRUE(theirs.ok()) << theirs.error().message;
  const auto looks = ReadLandmarkDescriptors(folder + "/landmark_descriptors_u8x128.bin",
                                             folder + "/landmark_descriptor_ids_i32.bin",
                                             DescriptorKind::kRootSift, *theirs);
  ASSERT_TRUE(looks.ok()) << looks.error().message;

  // A descriptor that looks the same was taken at the same feature of the same photograph.
  constexpr std::uint32_t kSame = 5'000;
  const EnuFrame frame(built->info.origin);
  const MapContent& ours = built->content;
  std::vector<std::uint32_t> distances(ours.origins.size());
  std::vector<double> apart_m;
  for (std::size_t i = 0; i < looks->landmark_ids.size(); i += 10) {
    DistancesTo(DescriptorKind::kRootSift, looks->descriptors.data() + 128 * i,
                ours.descriptors.data(), distances.size(), distances.data());
    const auto nearest = std::min_element(distances.begin(), distances.end());
    if (*nearest > kSame) continue;
    const auto at = static_cast<std::size_t>(nearest - distances.begin());
    const Landmark& landmark = ours.landmarks[ours.origins[at].landmark_id - 1];
    const auto their =
        std::lower_bound(theirs->begin(), theirs->end(), looks->landmark_ids[i],
                         [](const TableLandmark& one, std::uint32_t id) { return one.id < id; });
    apart_m.push_back((landmark.position_in_enu_m - frame.FromEcef(their->place.point_m)).norm());
  }
  EXPECT_GT(apart_m.size(), 300U);
  EXPECT_LT(Median(apart_m), 0.01);
}

TEST(PosedMapRecorded, FountainsQueriesAreLocalisedAlsoInASmallMap) {
  LODEMARK_NEEDS_RECORDING(kFountain);
  const std::string folder = test::RecordingPath(kFountain);
  Result<BuiltMap> built = BuildPosedMap(InputFor(folder), [](const char*, double) {});
  ASSERT_TRUE(built.ok()) << built.error().message;
  const test::ScratchFolder scratch;
  for (const double keep : {1.0, 0.2}) {
    MapContent content = built->content;
    if (keep < 1.0) KeepBestLandmarks(keep, &content);
    const std::string path = scratch.File("keep" + std::to_string(keep) + ".map");
    const Status written = WriteMap(path, built->info, content, [](double) {});
    ASSERT_TRUE(written.ok()) << written.error().message;
    const std::vector<double> errors_m = QueryErrors(folder, path);
    ASSERT_EQ(errors_m.size(), 4U);
    EXPECT_LT(Median(errors_m), keep < 1.0 ? 0.02 : 0.01) << keep;
    EXPECT_LT(*std::max_element(errors_m.begin(), errors_m.end()), 0.05) << keep;
  }
}

}  // namespace
}  // namespace lodemark
