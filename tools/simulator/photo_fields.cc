#include "tools/simulator/photo_fields.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/units.h"
#include "core/logs/camera_file.h"
#include "tools/simulator/signal_paths.h"

namespace lodemark {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBuildings = 500;
constexpr std::size_t kMostCorners = 64;
constexpr std::size_t kMostTrees = 500;
constexpr std::size_t kMostGroups = 20;
constexpr std::size_t kMostStandpoints = 500;
constexpr std::size_t kMostHolds = 500;
constexpr std::size_t kMostPhotos = 2'000;
constexpr double kFarthest_m = 5'000.0;
constexpr double kShortestEdge_m = 0.2;
constexpr double kLongestEdge_m = 500.0;
constexpr std::int64_t kLargestSeed = std::int64_t{1} << 53;
constexpr std::int64_t kLargestPhoto_px = 50'000'000;

void ReadSeed(ScenarioFields* fields, std::uint64_t* seed) {
  auto number = static_cast<std::int64_t>(*seed);
  fields->Integer("seed", 0, kLargestSeed, &number);
  *seed = static_cast<std::uint64_t>(number);
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Whether edges cross that are no neighbours.
bool CrossesItself(const std::vector<Eigen::Vector2d>& corners) {
  const std::size_t count = corners.size();
  const auto side = [&](std::size_t a, std::size_t b, std::size_t p) {
    return Cross(corners[b % count] - corners[a], corners[p % count] - corners[a]) > 0.0;
  };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 2; k < count; ++k) {
      if (i == 0 && k == count - 1) continue;
      if (side(i, i + 1, k) != side(i, i + 1, k + 1) &&
          side(k, k + 1, i) != side(k, k + 1, i + 1)) {
        return true;
      }
    }
  }
  return false;
}

void ReadFootprint(ScenarioFields* fields, Building* building) {
  const json* list = fields->Take("footprint_m");
  const std::string what = "has to be a list of 3 to 64 corners [east, north] within 5 km";
  if (list == nullptr || !list->is_array() || list->size() < 3 || list->size() > kMostCorners) {
    return fields->Fail("footprint_m", what);
  }
  std::vector<Eigen::Vector2d>& corners = building->footprint_m;
  for (const json& pair : *list) {
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number()) {
      return fields->Fail("footprint_m", what);
    }
    corners.emplace_back(pair[0].get<double>(), pair[1].get<double>());
    if (!(corners.back().cwiseAbs().maxCoeff() <= kFarthest_m)) {
      return fields->Fail("footprint_m", what);
    }
  }
  double twice_area_m2 = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& next = corners[(i + 1) % corners.size()];
    const double edge_m = (next - corners[i]).norm();
    if (!(edge_m >= kShortestEdge_m && edge_m <= kLongestEdge_m)) {
      return fields->Fail("footprint_m", "has to have edges of 0.2 to 500 m");
    }
    twice_area_m2 += Cross(corners[i], next);
  }
  if (CrossesItself(corners)) return fields->Fail("footprint_m", "must not cross itself");
  if (!(std::abs(twice_area_m2) > 0.1)) return fields->Fail("footprint_m", "has no area");
  if (twice_area_m2 < 0.0) std::reverse(corners.begin(), corners.end());
}

void ReadScene(ScenarioFields* parent, Scene* scene) {
  const json* object = parent->Take("scene");
  if (object == nullptr) return;
  if (!object->is_object()) return parent->Fail("scene", "has to be an object");
  ScenarioFields fields(parent->file(), *object, "scene.");
  ReadSeed(&fields, &scene->seed);
  std::string ground = "paving";
  fields.Text("ground", &ground);
  if (const std::optional<GroundKind> kind = GroundKindOf(ground)) {
    scene->ground = *kind;
  } else {
    fields.Fail("ground", "has to be paving, asphalt or grass");
  }
  fields.Objects("buildings", kMostBuildings, [&](ScenarioFields* one) {
    Building building;
    building.seed = scene->buildings.size() + 1;
    ReadFootprint(one, &building);
    one->Number("height_m", 1.0, 500.0, &building.height_m);
    one->Number("base_m", 0.0, 500.0, &building.base_m);
    std::string facade = "plaster";
    one->Text("facade", &facade);
    if (const std::optional<FacadeKind> kind = FacadeKindOf(facade)) {
      building.facade = *kind;
    } else {
      one->Fail("facade",
                "has to be brick, stone, plaster, tiles, glass, concrete, foliage or shops");
    }
    ReadSeed(one, &building.seed);
    scene->buildings.push_back(std::move(building));
  });
  fields.Objects("trees", kMostTrees, [&](ScenarioFields* one) {
    Tree tree;
    tree.seed = scene->trees.size() + 1;
    std::vector<double> at_m;
    one->Numbers("at_m", -kFarthest_m, kFarthest_m, 2, &at_m);
    if (at_m.size() != 2) return one->Fail("at_m", "has to be [east, north]");
    tree.at_m = {at_m[0], at_m[1]};
    one->Number("height_m", 2.0, 30.0, &tree.height_m);
    ReadSeed(one, &tree.seed);
    scene->trees.push_back(tree);
  });
  const Result<SignalSurroundings> surroundings = SignalSurroundings::Make(scene->buildings);
  if (!surroundings) fields.Fail("buildings", "number " + surroundings.error().message);
  parent->Adopt(fields.Verdict());
}

void ReadCamera(ScenarioFields* parent, LensParameters* lens) {
  const json* object = parent->Take("camera");
  if (object == nullptr) return;
  const Result<CameraFile> camera = ParseCameraFile(parent->file() + ": camera", object->dump());
  if (!camera) return parent->Adopt(camera.error());
  if (static_cast<std::int64_t>(camera->lens.width_px) * camera->lens.height_px >
      kLargestPhoto_px) {
    return parent->Fail("camera", "has to have at most 50 megapixels");
  }
  *lens = camera->lens;
}

void ReadDay(ScenarioFields* fields, Daylight* day) {
  double azimuth_deg = day->sun_azimuth_rad * kDegreesPerRadian;
  double elevation_deg = day->sun_elevation_rad * kDegreesPerRadian;
  fields->Number("sun_azimuth_deg", -360.0, 360.0, &azimuth_deg);
  fields->Number("sun_elevation_deg", 0.0, 90.0, &elevation_deg);
  fields->Number("cloud", 0.0, 1.0, &day->cloud);
  fields->Number("winter", 0.0, 1.0, &day->winter);
  ReadSeed(fields, &day->seed);
  day->sun_azimuth_rad = azimuth_deg * kRadiansPerDegree;
  day->sun_elevation_rad = elevation_deg * kRadiansPerDegree;
}

// headings_deg, tilt_deg, roll_deg.
std::vector<CameraHold> ReadHolds(ScenarioFields* fields) {
  std::vector<double> headings_deg = {0.0};
  double tilt_deg = 0.0;
  double roll_deg = 0.0;
  fields->Numbers("headings_deg", -360.0, 360.0, kMostHolds, &headings_deg);
  fields->Number("tilt_deg", -80.0, 80.0, &tilt_deg);
  fields->Number("roll_deg", -180.0, 180.0, &roll_deg);
  std::vector<CameraHold> holds;
  for (const double heading_deg : headings_deg) {
    holds.push_back({heading_deg * kRadiansPerDegree, tilt_deg * kRadiansPerDegree,
                     roll_deg * kRadiansPerDegree});
  }
  return holds;
}

bool IsFolderName(const std::string& name) {
  return !name.empty() && name.size() <= 32 &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

void ReadGroup(const std::map<std::string, Daylight>& days, ScenarioFields* fields,
               Photography* photography, std::size_t* photos) {
  PhotoGroup group;
  fields->Text("folder", &group.folder);
  if (!IsFolderName(group.folder)) {
    fields->Fail("folder", "has to be a name of a to z, 0 to 9 and _");
  }
  for (const PhotoGroup& other : photography->groups) {
    if (other.folder == group.folder) fields->Fail("folder", "is that of other photos, too");
  }
  std::string day;
  fields->Text("day", &day);
  if (const auto found = days.find(day); found != days.end()) {
    group.day = found->second;
  } else if (!day.empty()) {
    fields->Fail("day", "is not among the days");
  }
  fields->Objects("standpoints", kMostStandpoints, [&](ScenarioFields* one) {
    std::vector<double> at_m;
    one->Numbers("at_m", -kFarthest_m, kFarthest_m, 3, &at_m);
    if (at_m.size() != 3) return one->Fail("at_m", "has to be [east, north, up]");
    group.standpoints.push_back({{at_m[0], at_m[1], at_m[2]}, ReadHolds(one)});
    *photos += group.standpoints.back().holds.size();
  });
  fields->Objects("frames", kMostStandpoints, [&](ScenarioFields* one) {
    FrameSeries series;
    one->Number("first_s", 0.0, 86'400.0, &series.first_s);
    one->Number("every_s", 0.01, 3'600.0, &series.every_s);
    one->Flag("ahead", &series.ahead);
    series.holds = ReadHolds(one);
    *photos += series.holds.size();
    group.frames.push_back(std::move(series));
  });
  if (group.standpoints.empty() && group.frames.empty()) {
    fields->Fail("standpoints", "or frames have to be given");
  }
  fields->Flag("survey", &group.survey);
  std::int64_t people = group.most_people;
  fields->Integer("people", 0, 50, &people);
  group.most_people = static_cast<int>(people);
  fields->Number("bus_share", 0.0, 1.0, &group.bus_share);
  fields->Number("exposure_sigma_ev", 0.0, 3.0, &group.exposure_sigma_ev);
  fields->Number("blur_sigma_px", 0.0, 10.0, &group.blur_sigma_px);
  fields->Number("shake_px", 0.0, 60.0, &group.shake_px);
  fields->Number("electrons", 10.0, 1e6, &group.electrons);
  std::int64_t quality = group.jpeg_quality;
  fields->Integer("jpeg_quality", 1, 100, &quality);
  group.jpeg_quality = static_cast<int>(quality);
  photography->groups.push_back(std::move(group));
}

}  // namespace

void ReadPhotoFields(ScenarioFields* fields, Photography* photography) {
  ReadScene(fields, &photography->scene);
  ReadCamera(fields, &photography->lens);
  std::map<std::string, Daylight> days;
  fields->Objects("days", kMostGroups, [&](ScenarioFields* one) {
    std::string name;
    Daylight day;
    day.seed = days.size() + 1;
    one->Text("name", &name);
    ReadDay(one, &day);
    if (name.empty()) one->Fail("name", "has to be given");
    if (!days.emplace(name, day).second) one->Fail("name", "is that of another day, too");
  });
  std::size_t photos = 0;
  fields->Objects("photos", kMostGroups,
                  [&](ScenarioFields* one) { ReadGroup(days, one, photography, &photos); });
  if (photography->groups.empty()) return;
  if (photography->lens.width_px == 0) fields->Fail("camera", "has to be given for photos");
  if (photos > kMostPhotos) fields->Fail("photos", "are more than 2,000");
}

}  // namespace lodemark
