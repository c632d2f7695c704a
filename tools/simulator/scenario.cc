#include "tools/simulator/scenario.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "tools/simulator/photo_fields.h"
#include "tools/simulator/receiver_path.h"
#include "tools/simulator/scenario_fields.h"
#include "tools/simulator/signal_paths.h"

namespace lodemark {
namespace {

using nlohmann::json;

// 2024-05-16 02:00:00 GPS time, ten in the morning in Wuhan.
// Of a phone that takes photographs, above the ground.
constexpr double kPhotographer_m = 1.5;

constexpr std::int64_t kPresetStart_gps_ns = 1'399'860'000LL * kSecond_ns;

Scenario Base() {
  Scenario scenario;
  scenario.place = {30.5287 * kRadiansPerDegree, 114.3561 * kRadiansPerDegree, 24.0};
  scenario.place_name = "Wuhan, CN";
  scenario.start_gps_ns = kPresetStart_gps_ns;
  return scenario;
}

// "2024-05-16T02:00:00" in GPS time.
std::optional<std::int64_t> TimeFromText(const std::string& text) {
  CalendarTime c;
  int read = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%lf%n", &c.year, &c.month, &c.day, &c.hour,
                  &c.minute, &c.second, &read) != 6 ||
      static_cast<std::size_t>(read) != text.size()) {
    return std::nullopt;
  }
  return NanosecondsFromCalendar(c);
}

void ReadWaypoints(const json& list, ScenarioFields* fields, Scenario* scenario) {
  constexpr std::size_t kMostWaypoints = 10'000;
  constexpr double kFarthest_m = 20e3;
  scenario->waypoints_m.clear();
  if (!list.is_array() || list.size() > kMostWaypoints) {
    return fields->Fail("waypoints_m", "has to be a list of [east, north]");
  }
  for (const json& point : list) {
    const bool pair =
        point.is_array() && point.size() == 2 && point[0].is_number() && point[1].is_number();
    if (!pair || !(std::abs(point[0].get<double>()) <= kFarthest_m) ||
        !(std::abs(point[1].get<double>()) <= kFarthest_m)) {
      return fields->Fail("waypoints_m", "has to be a list of [east, north] within 20 km");
    }
    scenario->waypoints_m.push_back({point[0].get<double>(), point[1].get<double>()});
  }
}

void ReadPlace(const std::string& file, const json& object, ScenarioFields* parent,
               Scenario* scenario) {
  if (!object.is_object()) return parent->Fail("place", "has to be an object");
  ScenarioFields fields(file, object, "place.");
  double latitude_deg = scenario->place.latitude_rad * kDegreesPerRadian;
  double longitude_deg = scenario->place.longitude_rad * kDegreesPerRadian;
  fields.Number("latitude_deg", -89.9, 89.9, &latitude_deg);
  fields.Number("longitude_deg", -180.0, 180.0, &longitude_deg);
  fields.Number("height_m", -500.0, 9000.0, &scenario->place.height_m);
  scenario->place_name.clear();
  fields.Text("name", &scenario->place_name);
  scenario->place.latitude_rad = latitude_deg * kRadiansPerDegree;
  scenario->place.longitude_rad = longitude_deg * kRadiansPerDegree;
  parent->Adopt(fields.Verdict());
}

// Nobody walks through walls.
void CheckOutdoors(const Scenario& scenario, ScenarioFields* fields) {
  const Result<SignalSurroundings> surroundings =
      SignalSurroundings::Make(scenario.photography.scene.buildings);
  if (!surroundings || surroundings->empty()) return;
  const ReceiverPath path(scenario);
  for (int i = 0; i < scenario.epochs; ++i) {
    const double time_s = i * scenario.interval_s;
    if (!surroundings->IsIndoors(path.At(time_s).position_in_enu)) continue;
    char text[80];
    std::snprintf(text, sizeof text, "leads into a building of the scene after %.1f s", time_s);
    return fields->Fail("waypoints_m", text);
  }
}

}  // namespace

Result<Scenario> PresetScenario(std::string_view name) {
  Scenario scenario = Base();
  scenario.sensor_rate_hz = 2.0;  // a sample log is to be small
  if (name == "static") return scenario;
  if (name == "walk") {
    scenario.name = "walk";
    scenario.seed = 2;
    scenario.multipath_sigma_m = 1.6;
    // Round a block, clockwise.
    scenario.waypoints_m = {{0, 0}, {8, 46}, {58, 38}, {49, -16}, {0, 0}, {8, 46}};
    return scenario;
  }
  return Error{ErrorCode::kInvalidArgument,
               "there is no preset '" + std::string(name) + "'; there are static and walk"};
}

Result<Scenario> ScenarioFromJson(const std::string& file, std::string_view text) {
  const json object = json::parse(text, nullptr, false);
  if (object.is_discarded()) return Error{ErrorCode::kBadData, file + ": is not JSON"};
  if (!object.is_object()) {
    return Error{ErrorCode::kBadData, file + ": has to hold one JSON object"};
  }
  Scenario scenario = Base();
  ScenarioFields fields(file, object, "");
  fields.Text("name", &scenario.name);
  if (const json* place = fields.Take("place")) ReadPlace(file, *place, &fields, &scenario);
  std::string start;
  fields.Text("start_gps", &start);
  if (!start.empty()) {
    const std::optional<std::int64_t> time_ns = TimeFromText(start);
    if (time_ns && *time_ns > kWeek_ns) {
      scenario.start_gps_ns = *time_ns;
    } else {
      fields.Fail("start_gps", "has to look like 2024-05-16T02:00:00");
    }
  }
  double duration_s = 120.0;
  fields.Number("interval_s", 0.05, 60.0, &scenario.interval_s);
  fields.Number("duration_s", 1.0, 86'400.0, &duration_s);
  scenario.epochs = static_cast<int>(std::lround(duration_s / scenario.interval_s));
  if (scenario.epochs < 1 || scenario.epochs > 100'000) {
    fields.Fail("duration_s", "over interval_s has to give 1 to 100,000 epochs");
  }
  fields.Text("systems", &scenario.systems);
  if (scenario.systems.empty() || scenario.systems.find_first_not_of("GREC") != std::string::npos) {
    fields.Fail("systems", "has to be letters of G, R, E, C");
  }
  fields.Number("elevation_mask_deg", 0.0, 60.0, &scenario.elevation_mask_deg);
  fields.Number("multipath_sigma_m", 0.0, 50.0, &scenario.multipath_sigma_m);
  fields.Number("clock_drift_nsps", -20e3, 20e3, &scenario.clock_drift_nsps);
  std::int64_t seed = 1;
  fields.Integer("seed", 0, std::int64_t{1} << 53, &seed);
  scenario.seed = static_cast<std::uint64_t>(seed);
  if (const json* list = fields.Take("waypoints_m")) ReadWaypoints(*list, &fields, &scenario);
  fields.Number("speed_mps", 0.1, 60.0, &scenario.speed_mps);
  fields.Number("pause_s", 0.0, 3600.0, &scenario.pause_s);
  fields.Number("stop_s", 0.0, 3600.0, &scenario.stop_s);
  fields.Number("sensor_rate_hz", 0.1, 500.0, &scenario.sensor_rate_hz);
  ReadPhotoFields(&fields, &scenario.photography);
  if (!scenario.photography.groups.empty()) {
    scenario.rise_m = 0.0;  // the ground that photographs show is level
    scenario.phone_height_m = kPhotographer_m;
  }
  fields.Number("phone_height_m", 0.0, 50.0, &scenario.phone_height_m);
  if (const std::optional<Error> error = fields.Verdict()) return *error;
  CheckOutdoors(scenario, &fields);
  if (const std::optional<Error> error = fields.Verdict()) return *error;
  return scenario;
}

}  // namespace lodemark
