// What `lodemark replay` left in a run folder (docs/formats.md), read back.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/logs/read_report.h"
#include "core/logs/trajectory.h"

namespace lodemark {

// One line of events.jsonl.
struct RunEvent {
  std::int64_t time_gps_ns = 0;
  std::string event;
  std::string text;
};

// One row of satellites.csv; the texts are valid until the next row.
struct RunSignal {
  std::int64_t time_gps_ns = 0;
  std::string_view satellite;
  std::string_view signal;
  bool used = false;
  std::string_view reason;
  std::optional<double> residual_m;
  std::optional<double> sigma_m;
  std::optional<double> range_rate_residual_mps;
  std::optional<double> elevation_deg;
  std::optional<double> azimuth_deg;
  std::optional<double> cn0_dbhz;
};

// One row of landmarks.csv; the text is valid until the next row.
struct RunLandmark {
  std::int64_t time_gps_ns = 0;
  std::int64_t landmark_id = 0;
  bool used = false;
  std::string_view reason;
  double x_px = 0.0;
  double y_px = 0.0;
  std::optional<double> residual_x_px;
  std::optional<double> residual_y_px;
  std::optional<double> latitude_deg;
  std::optional<double> longitude_deg;
  std::optional<double> height_m;
};

// What run.json says the run was made of.
struct RunInput {
  std::string role;
  std::string file;
};

struct RunFolder {
  std::string path;
  std::string name;                     // the folder's own
  std::vector<TrajectoryPoint> epochs;  // in order of time, with and without an estimate
  ReadReport trajectory_report;
};

// Fails if there is no folder, no trajectory.csv in it, or not one readable row.
Result<RunFolder> ReadRunFolder(const std::string& path);

// Names that tell the runs apart: the folder's own, or the whole path where two agree.
std::vector<std::string> RunNames(const std::vector<std::string>& paths);

// The events, none if the run has no such file. Malformed lines are counted and skipped.
Result<std::vector<RunEvent>> ReadRunEvents(const std::string& folder, ReadReport* report);

// Calls sink for every row of satellites.csv; nothing happens if the run has no such file.
Status ReadRunSignals(const std::string& folder, const std::function<void(const RunSignal&)>& sink,
                      ReadReport* report);

// The same for landmarks.csv. Malformed rows are counted and skipped; a file without the columns
// is an error.
Status ReadRunLandmarks(const std::string& folder,
                        const std::function<void(const RunLandmark&)>& sink, ReadReport* report);

// The inputs that run.json lists; none if there is no such file.
Result<std::vector<RunInput>> ReadRunInputs(const std::string& folder);

}  // namespace lodemark
