#include "tools/simulator/recording.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/rinex_navigation_writer.h"
#include "tools/simulator/footprints_text.h"
#include "tools/simulator/gnss_logger_text.h"
#include "tools/simulator/simulator.h"

namespace lodemark {
namespace {

constexpr std::int64_t kUnixOffset_ms = 315'964'800'000;  // of 1980-01-06
constexpr double kTruthStep_s = 0.25;
constexpr double kTruthMargin_s = 1.0;  // receiver clocks stray, so the truth reaches further
constexpr int kSensorRowsPerEpoch = 2;
constexpr const char* kPathsFile = "signal_paths.csv";
constexpr const char* kFootprintsFile = "buildings.geojson";

std::int64_t UnixMilliseconds(std::int64_t time_gps_ns) {
  return ScaleFromGps(time_gps_ns, TimeScale::kUtc) / kMillisecond_ns + kUnixOffset_ms;
}

std::string NavigationText(const Scenario& scenario,
                           const std::vector<SimulatedSatellite>& satellites) {
  std::vector<NavigationRecord> records;
  IonosphereMessage ionosphere;
  ionosphere.satellite = {System::kGps, 0};
  ionosphere.model = SimulatedIonosphere();
  records.emplace_back(ionosphere);
  records.emplace_back(LeapSecondMessage{LeapSecondsAtGps(scenario.start_gps_ns)});
  for (const SimulatedSatellite& satellite : satellites) {
    for (const KeplerEphemeris& set : satellite.kepler_sets()) records.emplace_back(set);
    for (const StateEphemeris& set : satellite.state_sets()) records.emplace_back(set);
  }
  RinexNavigationWriterOptions options;
  options.program = "lodemark simulate";
  options.run_by = "simulated";
  const CalendarTime c =
      CalendarFromNanoseconds(ScaleFromGps(scenario.start_gps_ns, TimeScale::kUtc));
  char date[32];
  std::snprintf(date, sizeof date, "%04d%02d%02d %02d%02d%02d UTC", c.year, c.month, c.day, c.hour,
                c.minute, static_cast<int>(c.second));
  options.date = date;
  return WriteRinexNavigation(records, options).text;
}

std::string TruthText(const Scenario& scenario, const Simulator& simulator) {
  std::string text =
      "time_gps_ns,latitude_deg,longitude_deg,height_m,velocity_east_mps,velocity_north_mps,"
      "velocity_up_mps\n";
  const bool moving = scenario.waypoints_m.size() > 1;
  const double length_s = scenario.epochs * scenario.interval_s;
  const double first_s = moving ? -kTruthMargin_s : 0.0;
  const double last_s = moving ? length_s + kTruthMargin_s : 0.0;
  const int rows = static_cast<int>(std::lround((last_s - first_s) / kTruthStep_s)) + 1;
  for (int i = 0; i < rows; ++i) {
    const double time_s = first_s + i * kTruthStep_s;
    const ReceiverState state = simulator.TruthAt(time_s);
    const Geodetic place = GeodeticFromEcef(simulator.frame().ToEcef(state.position_in_enu));
    char row[192];
    std::snprintf(row, sizeof row, "%lld,%.10f,%.10f,%.4f,%.4f,%.4f,%.4f\n",
                  static_cast<long long>(scenario.start_gps_ns + std::llround(time_s * 1e9)),
                  place.latitude_rad * kDegreesPerRadian, place.longitude_rad * kDegreesPerRadian,
                  place.height_m, state.velocity_in_enu.x(), state.velocity_in_enu.y(),
                  state.velocity_in_enu.z());
    text += row;
  }
  return text;
}

// The truth about every satellite's way to the phone, for whoever labels or predicts it.
void AppendPathRows(const SimulatedEpoch& epoch, std::string* text) {
  for (const SimulatedEpoch::Path& path : epoch.paths) {
    char row[160];
    std::snprintf(row, sizeof row, "%lld,%c%02d,%.3f,%.3f,%.3f,%.3f,%.3f\n",
                  static_cast<long long>(epoch.true_gps_ns), SystemLetter(path.satellite.system),
                  path.satellite.number, path.look.elevation_rad * kDegreesPerRadian,
                  path.look.azimuth_rad * kDegreesPerRadian, path.paths.direct,
                  path.paths.reflected, path.paths.extra_path_m);
    *text += row;
  }
}

// What the phone's own positioning and its inertial sensors would have logged.
class PhoneRows {
 public:
  explicit PhoneRows(const Scenario& scenario)
      : random_(scenario.seed * 7919 + 13),
        east_m_(2.2, 45.0, &random_),
        north_m_(2.6, 45.0, &random_),
        up_m_(4.5, 60.0, &random_) {}

  void AppendFix(const SimulatedEpoch& epoch, const EnuFrame& frame, double interval_s,
                 std::int64_t utc_ms, std::string* text) {
    Eigen::Vector3d at = epoch.receiver.position_in_enu;
    at.x() += east_m_.Step(interval_s, &random_);
    at.y() += north_m_.Step(interval_s, &random_);
    at.z() += up_m_.Step(interval_s, &random_);
    FixRow fix;
    fix.place = GeodeticFromEcef(frame.ToEcef(at));
    fix.speed_mps =
        std::abs(epoch.receiver.velocity_in_enu.head<2>().norm() + random_.Gaussian(0.0, 0.05));
    fix.bearing_deg = epoch.receiver.heading_rad * kDegreesPerRadian;
    if (fix.bearing_deg < 0.0) fix.bearing_deg += 360.0;
    fix.accuracy_m = 4.1;
    fix.vertical_accuracy_m = 6.5;
    fix.speed_accuracy_mps = 0.2;
    fix.utc_ms = utc_ms;
    fix.elapsed_realtime_ns = epoch.raw.clock.elapsed_realtime_ns + 21 * kMillisecond_ns;
    AppendFixRow(fix, text);
  }

  // The phone is carried upright, its screen to the walker: x right, y up, z back.
  void AppendSensors(const ReceiverState& state, double time_s, std::int64_t utc_ms,
                     std::int64_t elapsed_realtime_ns, std::string* text) {
    const double speed_mps = state.velocity_in_enu.head<2>().norm();
    const double step_mps2 = 1.8 * speed_mps * std::sin(2.0 * kPi * 1.8 * time_s);
    UncalibratedRow row;
    row.utc_ms = utc_ms;
    row.elapsed_realtime_ns = elapsed_realtime_ns;
    row.kind = "UncalAccel";
    Set(&row, {speed_mps * state.turn_rate_radps, 9.794 + step_mps2, 0.0}, {0.04, -0.02, 0.07},
        0.03);
    AppendUncalibratedRow(row, text);
    row.kind = "UncalGyro";
    Set(&row, {0.0, -state.turn_rate_radps, 0.0}, {0.002, -0.001, 0.0015}, 0.002);
    AppendUncalibratedRow(row, text);
    row.kind = "UncalMag";
    // 34 microtesla north and 36 down, some 4 degrees west of north.
    const double north_rad = state.heading_rad + 4.0 * kRadiansPerDegree;
    Set(&row, {-34.0 * std::sin(north_rad), -36.0, -34.0 * std::cos(north_rad)}, {12.0, -30.0, 8.0},
        0.3);
    AppendUncalibratedRow(row, text);
  }

 private:
  void Set(UncalibratedRow* row, const std::array<double, 3>& values,
           const std::array<double, 3>& biases, double sigma) {
    for (std::size_t i = 0; i < 3; ++i) {
      row->values[i] = values[i] + biases[i] + random_.Gaussian(0.0, sigma);
      row->biases[i] = biases[i];
    }
  }

  Random random_;
  GaussMarkov east_m_, north_m_, up_m_;
};

std::string ManifestText(const Scenario& scenario) {
  const CalendarTime c =
      CalendarFromNanoseconds(ScaleFromGps(scenario.start_gps_ns, TimeScale::kUtc));
  char date[16];
  std::snprintf(date, sizeof date, "%04d-%02d-%02d", c.year, c.month, c.day);
  nlohmann::ordered_json manifest = {
      {"name", scenario.name},
      {"kind", "gnss"},
      {"simulated", true},
      {"device", "simulated phone in the shape of a Xiaomi M2006J10C (Redmi K30 Ultra)"},
      {"place", scenario.place_name},
      {"date_utc", date},
      {"licence", "Apache-2.0"},
      {"files",
       {{"gnss_log", "gnss_log.txt"}, {"navigation", "navigation.rnx"}, {"truth", "truth.csv"}}},
      {"truth_quality", "exact: simulated"},
      {"seed", scenario.seed},
      {"origin_deg_m",
       {scenario.place.latitude_rad * kDegreesPerRadian,
        scenario.place.longitude_rad * kDegreesPerRadian, scenario.place.height_m}},
      {"notes", "Made by lodemark simulate. No measurement in it was ever taken."}};
  if (!scenario.photography.scene.buildings.empty()) {
    manifest["files"]["signal_paths"] = kPathsFile;
    manifest["files"]["buildings"] = kFootprintsFile;
  }
  for (const PhotoGroup& group : scenario.photography.groups) {
    // The phone's own photographs, and those that a map is made from.
    const std::string role = group.frames.empty() ? group.folder + "_" : "";
    manifest["files"][role + "poses"] = group.folder + "/poses.csv";
    manifest["files"][role + "camera"] = group.folder + "/camera.json";
    if (!group.frames.empty()) manifest["files"]["images"] = group.folder + "/data.csv";
  }
  return manifest.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

RecordingFiles MakeRecording(const Scenario& scenario,
                             const std::function<void(double)>& progress) {
  Simulator simulator(scenario);
  PhoneRows phone(scenario);
  RecordingFiles files;
  std::string& log = files["gnss_log.txt"];
  log = GnssLoggerHeader();
  std::string* paths = nullptr;
  if (!scenario.photography.scene.buildings.empty()) {
    files[kFootprintsFile] =
        FootprintsText(scenario.photography.scene.buildings, simulator.frame());
    paths = &files[kPathsFile];
    *paths = "time_gps_ns,satellite,elevation_deg,azimuth_deg,direct,reflected,extra_path_m\n";
  }
  SimulatedEpoch epoch;
  while (simulator.Next(&epoch)) {
    const std::int64_t utc_ms = UnixMilliseconds(epoch.true_gps_ns);
    for (int i = 0; i < kSensorRowsPerEpoch; ++i) {
      const double ahead_s = scenario.interval_s * i / kSensorRowsPerEpoch;
      const double time_s =
          1e-9 * static_cast<double>(epoch.true_gps_ns - scenario.start_gps_ns) + ahead_s;
      phone.AppendSensors(simulator.TruthAt(time_s), time_s, utc_ms + std::llround(ahead_s * 1e3),
                          epoch.raw.clock.elapsed_realtime_ns + std::llround(ahead_s * 1e9), &log);
    }
    AppendRawRows(epoch.raw, utc_ms, &log);
    if (paths != nullptr) AppendPathRows(epoch, paths);
    phone.AppendFix(epoch, simulator.frame(), scenario.interval_s, utc_ms, &log);
    if (progress) progress(simulator.progress());
  }
  files["navigation.rnx"] = NavigationText(scenario, simulator.satellites());
  files["truth.csv"] = TruthText(scenario, simulator);
  files["manifest.json"] = ManifestText(scenario);
  return files;
}

}  // namespace lodemark
