#include "tools/lodemark/run_folder.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/lodemark/csv_table.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestHeight_m = 1e8;  // beyond any orbit we could be asked about

// Beyond year 2106; bounds keep differences of times from overflowing.
constexpr std::int64_t kLatestTime_ns = 4'000'000'000'000'000'000;

bool IsTime(std::int64_t time_gps_ns) { return time_gps_ns >= 0 && time_gps_ns < kLatestTime_ns; }

struct TrajectoryColumns {
  explicit TrajectoryColumns(const CsvTable& table)
      : time(table.Column("time_gps_ns")),
        latitude(table.Column("latitude_deg")),
        longitude(table.Column("longitude_deg")),
        height(table.Column("height_m")),
        velocity{table.Column("velocity_east_mps"), table.Column("velocity_north_mps"),
                 table.Column("velocity_up_mps")},
        accuracy(table.Column("accuracy_m")),
        vertical_accuracy(table.Column("vertical_accuracy_m")),
        speed_accuracy(table.Column("speed_accuracy_mps")),
        protection_level(table.Column("protection_level_m")),
        vertical_protection_level(table.Column("vertical_protection_level_m")),
        covariance{table.Column("covariance_ee_m2"), table.Column("covariance_en_m2"),
                   table.Column("covariance_nn_m2")},
        up_variance(table.Column("covariance_uu_m2")),
        satellites_used(table.Column("satellites_used")),
        status(table.Column("status")) {}

  int time, latitude, longitude, height;
  std::array<int, 3> velocity;
  int accuracy, vertical_accuracy, speed_accuracy, protection_level, vertical_protection_level;
  std::array<int, 3> covariance;
  int up_variance, satellites_used, status;
};

std::optional<std::array<double, 3>> Triple(const CsvTable& table,
                                            const std::array<int, 3>& columns) {
  std::array<double, 3> values;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> value = table.Number(columns[i]);
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  return values;
}

std::optional<double> NotNegative(std::optional<double> value) {
  return value && *value >= 0.0 ? value : std::nullopt;
}

// False, with the reason in the table's report, if the row is malformed.
bool ReadEpoch(CsvTable* table, const TrajectoryColumns& at, RunEpoch* epoch) {
  *epoch = {};
  const std::optional<std::int64_t> time_ns = table->Integer(at.time);
  if (!time_ns || !IsTime(*time_ns)) {
    table->Skip(at.time, "time_gps_ns is no time in nanoseconds");
    return false;
  }
  epoch->time_gps_ns = *time_ns;
  epoch->status = table->Text(at.status);
  const bool empty = table->Text(at.latitude).empty() && table->Text(at.longitude).empty();
  if (empty) return true;
  const std::optional<double> latitude = table->Number(at.latitude);
  const std::optional<double> longitude = table->Number(at.longitude);
  const std::optional<double> height = table->Number(at.height);
  if (!latitude || std::abs(*latitude) > 90.0) {
    table->Skip(at.latitude, "latitude_deg is no latitude");
    return false;
  }
  if (!longitude || std::abs(*longitude) > 360.0) {
    table->Skip(at.longitude, "longitude_deg is no longitude");
    return false;
  }
  if (!height || std::abs(*height) > kLargestHeight_m) {
    table->Skip(at.height, "height_m is no height");
    return false;
  }
  epoch->answered = true;
  epoch->latitude_deg = *latitude;
  epoch->longitude_deg = *longitude;
  epoch->height_m = *height;
  epoch->velocity_enu_mps = Triple(*table, at.velocity);
  epoch->accuracy_m = NotNegative(table->Number(at.accuracy));
  epoch->vertical_accuracy_m = NotNegative(table->Number(at.vertical_accuracy));
  epoch->speed_accuracy_mps = NotNegative(table->Number(at.speed_accuracy));
  epoch->protection_level_m = NotNegative(table->Number(at.protection_level));
  epoch->vertical_protection_level_m = NotNegative(table->Number(at.vertical_protection_level));
  epoch->horizontal_covariance_m2 = Triple(*table, at.covariance);
  epoch->up_variance_m2 = NotNegative(table->Number(at.up_variance));
  const std::optional<std::int64_t> used = table->Integer(at.satellites_used);
  if (used && *used >= 0 && *used < 1000) epoch->satellites_used = static_cast<int>(*used);
  return true;
}

std::string FirstProblem(const ReadReport& report) {
  if (report.problems.empty()) return report.file;
  return FormatProblem(report.file, report.problems.front());
}

std::string OwnName(const std::string& path) {
  fs::path folder = fs::path(path).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  const std::string name = folder.filename().string();
  return name.empty() || name == "." || name == ".." ? path : name;
}

}  // namespace

Result<RunFolder> ReadRunFolder(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    return Error{ErrorCode::kIo, path + ": no such run folder; make one with 'lodemark replay'"};
  }
  if (!fs::is_directory(path, ignored)) {
    return Error{ErrorCode::kIo,
                 path + ": is a file; name the folder that 'lodemark replay --out' wrote"};
  }
  const std::string file = (fs::path(path) / "trajectory.csv").string();
  if (!fs::exists(file, ignored)) {
    return Error{ErrorCode::kIo,
                 path + ": holds no trajectory.csv; name a folder that 'lodemark replay' wrote"};
  }
  Result<CsvTable> table =
      CsvTable::Open(file, {"time_gps_ns", "latitude_deg", "longitude_deg", "height_m"});
  if (!table) return table.error();
  RunFolder run;
  run.path = path;
  run.name = OwnName(path);
  const TrajectoryColumns columns(*table);
  RunEpoch epoch;
  while (table->Next()) {
    if (ReadEpoch(&*table, columns, &epoch)) run.epochs.push_back(epoch);
  }
  if (!table->status().ok()) return table->status().error();
  run.trajectory_report = table->report();
  if (run.epochs.empty()) {
    if (run.trajectory_report.rows_skipped > 0) {
      return Error{ErrorCode::kBadData,
                   FirstProblem(run.trajectory_report) + ", and no other row can be read either"};
    }
    return Error{ErrorCode::kBadData, file + ": holds no epoch; the replay was cut short or empty"};
  }
  return run;
}

std::vector<std::string> RunNames(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  names.reserve(paths.size());
  for (const std::string& path : paths) {
    bool unique = true;
    for (const std::string& other : paths) {
      if (&other != &path && OwnName(other) == OwnName(path)) unique = false;
    }
    names.push_back(unique ? OwnName(path) : path);
  }
  return names;
}

Result<std::vector<RunEvent>> ReadRunEvents(const std::string& folder, ReadReport* report) {
  const std::string path = (fs::path(folder) / "events.jsonl").string();
  std::vector<RunEvent> events;
  report->file = path;
  std::error_code ignored;
  // An empty list of events is an empty file, which is no error.
  if (!fs::exists(path, ignored) || fs::file_size(path, ignored) == 0) return events;
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  std::string_view line;
  while (lines->Next(&line)) {
    if (line.empty()) continue;
    const nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
    const auto time = object.is_object() ? object.find("time_gps_ns") : object.end();
    if (!object.is_object() || time == object.end() || !time->is_number_integer() ||
        !IsTime(time->get<std::int64_t>())) {
      report->Skip(lines->line_number(), 0, "no JSON object with an integer time_gps_ns");
      continue;
    }
    RunEvent event;
    event.time_gps_ns = time->get<std::int64_t>();
    const auto text = [&object](const char* name) {
      const auto found = object.find(name);
      return found != object.end() && found->is_string() ? found->get<std::string>()
                                                         : std::string();
    };
    event.event = text("event");
    event.text = text("text");
    events.push_back(std::move(event));
    ++report->rows_read;
  }
  if (!lines->status().ok()) return lines->status().error();
  return events;
}

Status ReadRunSignals(const std::string& folder, const std::function<void(const RunSignal&)>& sink,
                      ReadReport* report) {
  const std::string path = (fs::path(folder) / "satellites.csv").string();
  report->file = path;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  Result<CsvTable> table = CsvTable::Open(path, {"time_gps_ns", "satellite", "signal", "used"});
  if (!table) return table.error();
  const int time = table->Column("time_gps_ns");
  const int satellite = table->Column("satellite");
  const int signal = table->Column("signal");
  const int used = table->Column("used");
  const int reason = table->Column("reason");
  const int residual = table->Column("residual_m");
  const int elevation = table->Column("elevation_deg");
  const int azimuth = table->Column("azimuth_deg");
  const int cn0 = table->Column("cn0_dbhz");
  RunSignal row;
  while (table->Next()) {
    const std::optional<std::int64_t> time_ns = table->Integer(time);
    if (!time_ns || !IsTime(*time_ns)) {
      table->Skip(time, "time_gps_ns is no time in nanoseconds");
      continue;
    }
    row.time_gps_ns = *time_ns;
    row.satellite = table->Text(satellite);
    row.signal = table->Text(signal);
    row.used = table->Text(used) == "1";
    row.reason = table->Text(reason);
    row.residual_m = table->Number(residual);
    row.elevation_deg = table->Number(elevation);
    row.azimuth_deg = table->Number(azimuth);
    row.cn0_dbhz = table->Number(cn0);
    sink(row);
  }
  *report = table->report();
  return table->status();
}

}  // namespace lodemark
