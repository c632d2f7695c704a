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
#include "tools/simulator/inertial_sensors.h"
#include "tools/simulator/simulator.h"

namespace lodemark {
namespace {

constexpr std::int64_t kUnixOffset_ms = 315'964'800'000;  // of 1980-01-06
constexpr double kTruthStep_s = 0.25;
constexpr double kTruthMargin_s = 1.0;   // receiver clocks stray, so the truth reaches further
constexpr double kSensorsAhead_s = 1.0;  // sensors run before the first epoch
constexpr double kRawRowsLate_s = 0.12;  // measurements reach the log so much after their epoch
constexpr double kCompassEvery_s = 0.5;
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

// What the phone's own positioning would have logged.
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

 private:
  Random random_;
  GaussMarkov east_m_, north_m_, up_m_;
};

// The rows of the inertial sensors and the compass, in the order of their times.
class SensorRows {
 public:
  explicit SensorRows(const Scenario& scenario)
      : motion_(scenario),
        interval_s_(1.0 / scenario.sensor_rate_hz),
        random_(scenario.seed * 6364136223846793005ULL + 1442695040888963407ULL),
        force_errors_(PhoneAccelerometer(), &random_),
        turn_errors_(PhoneGyroscope(), &random_) {
    next_ = -std::lround(kSensorsAhead_s / interval_s_);
  }

  // All until the epoch's measurements were written.
  void AppendUntil(const SimulatedEpoch& epoch, std::int64_t start_gps_ns, std::string* text) {
    const double epoch_s = 1e-9 * static_cast<double>(epoch.true_gps_ns - start_gps_ns);
    for (;; ++next_) {
      const double time_s = static_cast<double>(next_) * interval_s_;
      if (time_s > epoch_s + kRawRowsLate_s) return;
      UncalibratedRow row;
      row.utc_ms = UnixMilliseconds(start_gps_ns + std::llround(time_s * 1e9));
      row.elapsed_realtime_ns =
          epoch.raw.clock.elapsed_realtime_ns + std::llround((time_s - epoch_s) * 1e9);
      Append(time_s, &row, text);
    }
  }

 private:
  void Append(double time_s, UncalibratedRow* row, std::string* text) {
    const InertialTruth truth = motion_.At(time_s, interval_s_);
    row->kind = "UncalAccel";
    Set(force_errors_.Measure(truth.force_mps2, interval_s_, &random_), force_errors_.stated_bias(),
        row);
    AppendUncalibratedRow(*row, text);
    row->kind = "UncalGyro";
    Set(turn_errors_.Measure(truth.turn_rate_radps, interval_s_, &random_),
        turn_errors_.stated_bias(), row);
    AppendUncalibratedRow(*row, text);
    const double compass = std::floor(time_s / kCompassEvery_s);
    if (compass == compass_) return;
    compass_ = compass;
    row->kind = "UncalMag";
    // 34 microtesla north and 36 down, some 4 degrees west of north.
    constexpr double kWest_rad = 4.0 * kRadiansPerDegree;
    const Eigen::Vector3d field_in_enu(-34.0 * std::sin(kWest_rad), 34.0 * std::cos(kWest_rad),
                                       -36.0);
    const Eigen::Vector3d bias(12.0, -30.0, 8.0);
    Eigen::Vector3d measured = motion_.hold().EnuFromDevice(time_s).conjugate() * field_in_enu;
    for (double& component : measured) component += random_.Gaussian(0.0, 0.3);
    Set(measured + bias, bias, row);
    AppendUncalibratedRow(*row, text);
  }

  static void Set(const Eigen::Vector3d& values, const Eigen::Vector3d& biases,
                  UncalibratedRow* row) {
    for (int i = 0; i < 3; ++i) {
      row->values[i] = values[i];
      row->biases[i] = biases[i];
    }
  }

  InertialMotion motion_;
  double interval_s_;
  Random random_;
  SensorErrors force_errors_;
  SensorErrors turn_errors_;
  std::int64_t next_ = 0;  // number of the sample, counted from the start
  double compass_ = -1e9;
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
  SensorRows sensors(scenario);
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
    sensors.AppendUntil(epoch, scenario.start_gps_ns, &log);
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
