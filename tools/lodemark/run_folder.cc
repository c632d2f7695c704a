#include "tools/lodemark/run_folder.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/lodemark/command.h"
#include "tools/lodemark/csv_table.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

// Beyond year 2106; bounds keep differences of times from overflowing.
constexpr std::int64_t kLatestTime_ns = 4'000'000'000'000'000'000;

constexpr std::size_t kLargestRunJson_bytes = 16u * 1024 * 1024;

bool IsTime(std::int64_t time_gps_ns) { return time_gps_ns >= 0 && time_gps_ns < kLatestTime_ns; }

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
  RunFolder run;
  run.path = path;
  run.name = OwnName(path);
  const Result<Trajectory> trajectory = ReadTrajectory(file, &run.trajectory_report);
  if (!trajectory) return trajectory.error();
  run.epochs = trajectory->points();
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
  const int sigma = table->Column("sigma_m");
  const int rate_residual = table->Column("range_rate_residual_mps");
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
    row.sigma_m = table->Number(sigma);
    row.range_rate_residual_mps = table->Number(rate_residual);
    row.elevation_deg = table->Number(elevation);
    row.azimuth_deg = table->Number(azimuth);
    row.cn0_dbhz = table->Number(cn0);
    sink(row);
  }
  *report = table->report();
  return table->status();
}

Status ReadRunLandmarks(const std::string& folder,
                        const std::function<void(const RunLandmark&)>& sink, ReadReport* report) {
  const std::string path = (fs::path(folder) / "landmarks.csv").string();
  report->file = path;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  Result<CsvTable> table =
      CsvTable::Open(path, {"time_gps_ns", "landmark_id", "used", "x_px", "y_px"});
  if (!table) return table.error();
  const int time = table->Column("time_gps_ns");
  const int id = table->Column("landmark_id");
  const int used = table->Column("used");
  const int reason = table->Column("reason");
  const int x = table->Column("x_px");
  const int y = table->Column("y_px");
  const int residual_x = table->Column("residual_x_px");
  const int residual_y = table->Column("residual_y_px");
  const int latitude = table->Column("latitude_deg");
  const int longitude = table->Column("longitude_deg");
  const int height = table->Column("height_m");
  RunLandmark row;
  while (table->Next()) {
    const std::optional<std::int64_t> time_ns = table->Integer(time);
    const std::optional<std::int64_t> landmark = table->Integer(id);
    const std::optional<double> x_px = table->Number(x);
    const std::optional<double> y_px = table->Number(y);
    if (!time_ns || !IsTime(*time_ns)) {
      table->Skip(time, "time_gps_ns is no time in nanoseconds");
    } else if (!landmark || *landmark < 0) {
      table->Skip(id, "landmark_id is no number of a landmark");
    } else if (!x_px || !y_px) {
      table->Skip(x_px ? y : x, "is no place in a photograph");
    } else {
      row.time_gps_ns = *time_ns;
      row.landmark_id = *landmark;
      row.used = table->Text(used) == "1";
      row.reason = table->Text(reason);
      row.x_px = *x_px;
      row.y_px = *y_px;
      row.residual_x_px = table->Number(residual_x);
      row.residual_y_px = table->Number(residual_y);
      row.latitude_deg = table->Number(latitude);
      row.longitude_deg = table->Number(longitude);
      row.height_m = table->Number(height);
      sink(row);
    }
  }
  *report = table->report();
  return table->status();
}

Result<std::vector<RunInput>> ReadRunInputs(const std::string& folder) {
  const std::string path = (fs::path(folder) / "run.json").string();
  std::vector<RunInput> inputs;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return inputs;
  const Result<std::string> text = ReadFileWhole(path, kLargestRunJson_bytes);
  if (!text) return text.error();
  const nlohmann::json object = nlohmann::json::parse(*text, nullptr, false);
  if (!object.is_object()) {
    return Error{ErrorCode::kBadData, path + ": is not JSON; run 'lodemark replay' again"};
  }
  const auto list = object.find("inputs");
  if (list == object.end() || !list->is_array()) return inputs;
  for (const nlohmann::json& input : *list) {
    if (!input.is_object()) continue;
    const auto role = input.find("role");
    const auto file = input.find("file");
    if (role == input.end() || file == input.end() || !role->is_string() || !file->is_string()) {
      continue;
    }
    inputs.push_back({role->get<std::string>(), file->get<std::string>()});
  }
  return inputs;
}

}  // namespace lodemark
