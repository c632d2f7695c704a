// lodemark map build: a feature map from surveyed marks, from posed photographs, or from a table;
// with buildings, or of buildings alone.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/units.h"
#include "core/logs/camera_file.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/map_commands.h"
#include "tools/lodemark/text_table.h"
#include "tools/mapping/building_map.h"
#include "tools/mapping/landmark_map.h"
#include "tools/mapping/marked_map.h"
#include "tools/mapping/posed_map.h"

namespace lodemark {
namespace {

struct MapBuildOptions {
  NewMapOptions map;
  std::string kind = "sift";
  std::string images;
  std::string camera;
  std::string poses;
  std::string camera_positions;
  std::string role;
  std::string marks;
  std::string survey;
  std::string landmarks;
  std::string descriptors;
  std::string descriptor_ids;
  std::string buildings;
  std::optional<double> ground_m;
  HeightRules heights;
  double sigma_m = 0.0;
  double ratio = 0.8;
  int features = 8000;
  int longest_side_px = 2400;
  int least_views = 2;
  double least_parallax_deg = 1.5;
};

DescriptorKind KindOf(const MapBuildOptions& options) {
  return options.kind == "orb" ? DescriptorKind::kOrb : DescriptorKind::kRootSift;
}

DetectorOptions DetectorFrom(const MapBuildOptions& options) {
  DetectorOptions detector;
  detector.kind = KindOf(options);
  detector.most_features = options.features;
  detector.longest_side_px = options.longest_side_px;
  return detector;
}

Result<BuiltMap> BuildFromTable(const MapBuildOptions& options, const FrameOptions& frame,
                                const PlaceOptions& places) {
  LandmarkMapInput input;
  input.landmarks = options.landmarks;
  input.descriptors = options.descriptors;
  input.descriptor_ids = options.descriptor_ids;
  input.kind = KindOf(options);
  input.places = places;
  input.frame = frame;
  input.labels = {options.map.datum, options.map.epoch_year};
  if (options.sigma_m > 0.0) input.default_sigma_m = options.sigma_m;
  return BuildLandmarkMap(input, StageBars());
}

Result<BuiltMap> BuildFromPoses(const MapBuildOptions& options, const FrameOptions& frame,
                                const PlaceOptions& places) {
  PosedMapInput input;
  input.images = options.images;
  input.poses = options.poses;
  if (!options.camera.empty()) {
    const Result<CameraFile> camera = ReadCameraFile(options.camera);
    if (!camera) return camera.error();
    input.lens = camera->lens;
  }
  input.camera_positions = options.camera_positions;
  input.role = options.role;
  if (options.sigma_m > 0.0) input.position_sigma_m = options.sigma_m;
  input.places = places;
  input.frame = frame;
  input.labels = {options.map.datum, options.map.epoch_year};
  input.detector = DetectorFrom(options);
  input.matching.largest_ratio = options.ratio;
  input.triangulation.least_views = options.least_views;
  input.triangulation.least_parallax_rad = options.least_parallax_deg * kRadiansPerDegree;
  return BuildPosedMap(input, StageBars());
}

Result<BuiltMap> BuildFromMarks(const MapBuildOptions& options, const FrameOptions& frame,
                                const PlaceOptions& places) {
  MarkedMapInput input;
  input.images = options.images;
  input.marks = options.marks;
  input.survey = options.survey;
  if (!options.camera.empty()) {
    const Result<CameraFile> camera = ReadCameraFile(options.camera);
    if (!camera) return camera.error();
    input.lens = camera->lens;
  }
  if (options.sigma_m > 0.0) input.default_sigma_m = options.sigma_m;
  input.places = places;
  input.frame = frame;
  input.labels = {options.map.datum, options.map.epoch_year};
  input.detector = DetectorFrom(options);
  return BuildMarkedMap(input, StageBars());
}

BuildingInput BuildingsFrom(const MapBuildOptions& options) {
  BuildingInput input;
  input.footprints = options.buildings;
  input.ground_m = options.ground_m;
  input.heights = options.heights;
  return input;
}

// Which of the ways; an error if the options name none, several, or one in part.
enum class BuildWay : std::uint8_t { kMarks, kPoses, kTable, kBuildings };
Result<BuildWay> WayOf(const MapBuildOptions& options) {
  const auto invalid = [](const char* text) { return Error{ErrorCode::kInvalidArgument, text}; };
  const int ways = (options.marks.empty() ? 0 : 1) + (options.poses.empty() ? 0 : 1) +
                   (options.landmarks.empty() ? 0 : 1);
  if (ways == 0 && !options.buildings.empty()) {
    if (options.images.empty() && options.map.keep.empty()) return BuildWay::kBuildings;
    return invalid("--images and --keep make no sense with --buildings alone");
  }
  if (ways != 1) {
    return invalid(
        "name one thing to build from: --images with --marks and --survey, --images with --poses, "
        "or --landmarks with --descriptors and --descriptor-ids; besides or instead --buildings");
  }
  if (options.ground_m && options.buildings.empty()) {
    return invalid("--ground says how high the ground of --buildings lies, which are missing");
  }
  if (!options.landmarks.empty()) {
    if (!options.descriptors.empty() && !options.descriptor_ids.empty()) return BuildWay::kTable;
    return invalid("--landmarks needs --descriptors and --descriptor-ids");
  }
  if (options.images.empty()) return invalid("name the folder of the photographs, --images");
  if (!options.marks.empty()) {
    if (!options.survey.empty()) return BuildWay::kMarks;
    return invalid("--marks needs --survey, where the points are");
  }
  if (!options.role.empty() && options.camera_positions.empty()) {
    return invalid("--role needs --camera-positions, where the roles are");
  }
  return BuildWay::kPoses;
}

int RunMapBuild(const MapBuildOptions& options) {
  const Result<FrameOptions> frame = FrameOptionsFrom(options.map);
  if (!frame) return ReportError(frame.error());
  const Result<PlaceOptions> places = PlaceOptionsFrom(options.map);
  if (!places) return ReportError(places.error());
  const Result<BuildWay> way = WayOf(options);
  if (!way) return ReportError(way.error());
  Result<BuiltMap> built = Error{};
  std::string source;
  switch (*way) {
    case BuildWay::kMarks:
      built = BuildFromMarks(options, *frame, *places);
      source = options.survey + ", " + options.marks + " and " + options.images;
      break;
    case BuildWay::kPoses:
      built = BuildFromPoses(options, *frame, *places);
      source = options.poses + " and " + options.images;
      break;
    case BuildWay::kTable:
      built = BuildFromTable(options, *frame, *places);
      source = options.landmarks;
      break;
    case BuildWay::kBuildings:
      built = BuildBuildingMap(BuildingsFrom(options), *frame,
                               {options.map.datum, options.map.epoch_year}, StageBars());
      source = options.buildings;
      break;
  }
  if (!built) return ReportError(built.error());
  if (*way != BuildWay::kBuildings && !options.buildings.empty()) {
    const Status added = AddBuildings(BuildingsFrom(options), StageBars(), &*built);
    if (!added) return ReportError(added.error());
    source += " and " + options.buildings;
  }
  const std::string how = "lodemark " + VersionText() + " map build from " + source;
  return FinishMap(options.map, how, std::move(built).value());
}

}  // namespace

void AddMapBuildCommand(CLI::App& map, int* exit_code) {
  const auto options = std::make_shared<MapBuildOptions>();
  CLI::App* command =
      map.add_subcommand("build", "Make a map of photographs, of a table, or of buildings");
  AddNewMapOptions(*command, &options->map);
  command->add_option("--kind", options->kind, "Of the descriptors")
      ->check(CLI::IsMember({"sift", "orb"}))
      ->capture_default_str();
  command->add_option("--images", options->images, "Folder of the photographs");
  command->add_option("--camera", options->camera, "camera.json of the photographs");
  command->add_option("--poses", options->poses,
                      "csv: name,qw,qx,qy,qz,tx,ty,tz (world to camera) of each photograph");
  command->add_option("--camera-positions", options->camera_positions,
                      "csv: name and the place of each camera on the earth; lays the poses there");
  command->add_option("--role", options->role,
                      "Use only photographs with this role in --camera-positions");
  command->add_option("--marks", options->marks,
                      "csv: image,point,x_px,y_px of surveyed points in the photographs");
  command->add_option("--survey", options->survey, "csv: point and its place, with sigmas");
  command->add_option("--landmarks", options->landmarks, "csv: landmark_id and a place");
  command->add_option("--descriptors", options->descriptors, "Their bytes, one after another");
  command->add_option("--descriptor-ids", options->descriptor_ids,
                      "32-bit landmark_id of each descriptor");
  const std::string buildings = "Buildings";
  command
      ->add_option(
          "--buildings", options->buildings,
          "GeoJSON of footprints with height or building:levels, as OpenStreetMap has them")
      ->group(buildings);
  command
      ->add_option("--ground", options->ground_m,
                   "Height of the ground above the ellipsoid in m; default: the origin's")
      ->check(CLI::Range(-12'000.0, 9'000.0))
      ->group(buildings);
  command
      ->add_option("--default-height", options->heights.default_m,
                   "Of buildings without height and levels, in m")
      ->check(CLI::Range(1.0, 500.0))
      ->capture_default_str()
      ->group(buildings);
  command
      ->add_option("--default-height-sigma", options->heights.default_sigma_m, "Its 1 sigma, in m")
      ->check(CLI::Range(0.0, 200.0))
      ->capture_default_str()
      ->group(buildings);
  command
      ->add_option(
          "--sigma", options->sigma_m,
          "Of places whose table says none, in m (cameras 0.1, surveyed 0.02, landmarks 0: then it "
          "counts as noise of the photographs)")
      ->check(CLI::PositiveNumber);
  command->add_option("--features", options->features, "Most in one photograph")
      ->check(CLI::Range(10, 200'000))
      ->capture_default_str();
  command
      ->add_option("--longest-side", options->longest_side_px,
                   "Larger photographs are scaled down to this, in pixels; 0: SIFT to 12.5 "
                   "megapixels, ORB never")
      ->check(CLI::Range(0, 65'535))
      ->capture_default_str();
  command->add_option("--ratio", options->ratio, "Nearest to second nearest descriptor")
      ->check(CLI::Range(0.1, 1.0))
      ->capture_default_str();
  command->add_option("--least-views", options->least_views, "Photographs that show a landmark")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  command
      ->add_option("--least-parallax", options->least_parallax_deg,
                   "Widest angle between a landmark's rays, in degrees")
      ->check(CLI::Range(0.1, 90.0))
      ->capture_default_str();
  command->callback([options, exit_code] { *exit_code = RunMapBuild(*options); });
}

}  // namespace lodemark
