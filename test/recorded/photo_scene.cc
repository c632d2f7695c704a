#include "test/recorded/photo_scene.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/map/feature_map_writer.h"
#include "core/vision/look_up.h"
#include "test/unit/map/map_scene.h"

namespace lodemark::test {
namespace {

// The sets count pixels from the corner of the upper left pixel, not its centre: features of the
// photographs that the landmarks were made from lie (-0.50, -0.49) px, in the median of the
// medians, from where camera.json would have them.
constexpr double kCorner_px = 0.5;

// As good as 0.3 px at 12 m; the sets say nothing.
constexpr double kLandmarkSigma_m = 0.003;

constexpr double kGuidedRadius_px = 8.0;

using Row = std::map<std::string, std::string>;

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

// Plain or gzipped.
std::vector<Row> ReadTable(const std::string& path) {
  std::vector<Row> rows;
  const gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) return rows;
  std::vector<std::string> names;
  char buffer[1024];
  while (gzgets(file, buffer, sizeof(buffer)) != nullptr) {
    std::string line(buffer);
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
    const std::vector<std::string> fields = Fields(line);
    if (names.empty()) {
      names = fields;
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) row[names[i]] = fields[i];
    rows.push_back(row);
  }
  gzclose(file);
  return rows;
}

double Number(const Row& row, const std::string& name) {
  const auto field = row.find(name);
  double value = 0.0;
  if (field == row.end()) {
    ADD_FAILURE() << "no column " << name;
    return value;
  }
  const std::string& text = field->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(error == std::errc()) << name << ": " << text;
  return value;
}

Eigen::Vector3d EastNorthUp(const Row& row) {
  return {Number(row, "east_m"), Number(row, "north_m"), Number(row, "up_m")};
}

std::unique_ptr<FeatureMap> MakeMap(const std::string& folder) {
  const ScratchFolder scratch;
  const std::string path = scratch.File("photo_scene.map");
  MapInfo info;
  info.origin = {0.85, 0.15, 130.0};
  info.datum = "WGS84 (G2139)";
  info.provenance = folder;
  Result<std::unique_ptr<FeatureMapWriter>> writer = FeatureMapWriter::Create(path, info);
  if (!writer) return nullptr;
  DatabaseImage image;
  image.name = "all";
  if (!(*writer)->AddImage(image)) return nullptr;
  for (const Row& row : ReadTable(folder + "/landmarks.csv.gz")) {
    Landmark landmark;
    landmark.id = static_cast<std::uint32_t>(Number(row, "landmark_id"));
    landmark.position_in_enu_m = EastNorthUp(row);
    landmark.covariance_m2 = kLandmarkSigma_m * kLandmarkSigma_m * Eigen::Matrix3d::Identity();
    if (!(*writer)->AddLandmark(landmark)) return nullptr;
  }
  const std::vector<std::uint8_t> ids = ReadBytes(folder + "/landmark_descriptor_ids_i32.bin");
  std::vector<DescriptorOrigin> origins(ids.size() / 4);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    std::memcpy(&origins[i].landmark_id, ids.data() + 4 * i, 4);
  }
  const Status added =
      (*writer)->AddDescriptors(origins, ReadBytes(folder + "/landmark_descriptors_u8x128.bin"));
  if (!added || !(*writer)->Commit()) return nullptr;
  writer->reset();
  Result<std::unique_ptr<FeatureMap>> map = FeatureMap::Open(path);
  return map ? std::move(*map) : nullptr;
}

std::vector<LandmarkSight> SightsOf(const std::vector<LandmarkMatch>& matches) {
  std::vector<LandmarkSight> sights;
  for (const LandmarkMatch& match : matches) {
    sights.push_back({match.pixel, match.pixel_sigma_px, match.landmark.position_in_enu_m,
                      match.landmark.covariance_m2, -match.ratio});
  }
  return sights;
}

}  // namespace

std::optional<PhotoScene> ReadPhotoScene(const std::string& folder) {
  std::map<std::string, std::string> roles;
  std::map<std::string, Eigen::Vector3d> places;
  for (const Row& row : ReadTable(folder + "/cameras_geodetic.csv")) {
    roles[row.at("name")] = row.at("role");
    places[row.at("name")] = EastNorthUp(row);
  }
  const std::vector<Row> poses = ReadTable(folder + "/poses.csv");
  if (poses.empty()) return std::nullopt;
  LensParameters parameters;
  parameters.width_px = static_cast<int>(Number(poses[0], "width"));
  parameters.height_px = static_cast<int>(Number(poses[0], "height"));
  parameters.fx_px = Number(poses[0], "fx");
  parameters.fy_px = Number(poses[0], "fy");
  parameters.cx_px = Number(poses[0], "ppx") - kCorner_px;
  parameters.cy_px = Number(poses[0], "ppy") - kCorner_px;
  const Result<Lens> lens = Lens::Create(parameters);
  if (!lens) return std::nullopt;
  PhotoScene scene{{}, *lens, MakeMap(folder)};
  if (!scene.map) return std::nullopt;
  for (const Row& row : poses) {
    const std::string& name = row.at("name");
    scene.photos.push_back({folder + "/images/" + name, roles[name] == "query", places[name]});
  }
  return scene;
}

PhotoFeatures FeaturesOf(const std::string& path) {
  const cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  const GrayImage view{image.data, image.cols, image.rows,
                       static_cast<std::ptrdiff_t>(image.step[0])};
  Result<Features> features = DetectFeatures(view, {});
  EXPECT_TRUE(features.ok()) << path;
  if (!features) return {};
  return {std::move(*features), image.cols, image.rows};
}

Lens UsualLens(int width_px, int height_px) {
  LensParameters parameters;
  parameters.width_px = width_px;
  parameters.height_px = height_px;
  parameters.fx_px = 0.9 * std::max(width_px, height_px);
  parameters.fy_px = parameters.fx_px;
  parameters.cx_px = 0.5 * (width_px - 1);
  parameters.cy_px = 0.5 * (height_px - 1);
  return Lens::Create(parameters).value();
}

Located Locate(const FeatureMap& map, const Lens& lens, const Features& features) {
  Located located;
  const Result<std::vector<LandmarkMatch>> matches = LookUp(map, features, lens, {}, {});
  EXPECT_TRUE(matches.ok());
  if (!matches) return located;
  located.first_sights = SightsOf(*matches);
  const Result<ResectedPose> first = Resect(located.first_sights, lens, {}, {});
  EXPECT_TRUE(first.ok());
  if (!first) return located;
  located.first = located.pose = *first;
  if (first->verdict != PoseVerdict::kPose && first->verdict != PoseVerdict::kWeak) return located;
  const Result<std::vector<LandmarkMatch>> guided =
      LookUpGuided(map, features, lens, first->camera_from_enu, kGuidedRadius_px, {});
  EXPECT_TRUE(guided.ok());
  if (!guided) return located;
  const Result<ResectedPose> pose = Resect(SightsOf(*guided), lens, {}, {});
  EXPECT_TRUE(pose.ok());
  if (pose) located.pose = *pose;
  return located;
}

}  // namespace lodemark::test
