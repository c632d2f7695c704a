// What a GNSS file is and what it holds, found by reading all of it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/gnss/observation.h"
#include "core/logs/read_report.h"
#include "core/logs/recording.h"

namespace lodemark {

struct SurveyedSignal {
  std::set<SatelliteId> satellites;
  std::int64_t observations = 0;
  std::int64_t with_code = 0;
  std::int64_t with_phase = 0;
  double cn0_sum_dbhz = 0.0;
  std::int64_t with_cn0 = 0;
};

struct LogSurvey {
  std::string file;
  FileKind kind = FileKind::kUnknown;
  std::string description;  // "GnssLogger text v3.0.6.4, Xiaomi M2006J10C"

  // Of epochs, or of reference times in navigation and orbit files.
  std::optional<std::int64_t> first_gps_ns;
  std::optional<std::int64_t> last_gps_ns;
  std::int64_t epochs = 0;
  double usual_interval_s = 0.0;  // median, 0 with fewer than two epochs
  std::int64_t backward_steps = 0;
  std::int64_t repeated_times = 0;

  std::map<std::string, std::int64_t> rows;  // by leading word, or by kind of record
  std::map<std::pair<System, SignalCode>, SurveyedSignal> signals;
  std::map<System, std::set<SatelliteId>> satellites;  // of navigation and orbit files
  std::map<std::string, std::int64_t> raw_outcomes;    // Android only: "usable", or why not
  ReadReport report;

  // Why the file is of no use although it could be read, one sentence each.
  std::vector<std::string> faults;
};

// Fails if the file cannot be read to its end, or is of no kind we know.
Result<LogSurvey> SurveyFile(const std::string& path, const std::function<void(double)>& progress);

// "G L1 C/A"-like names are for people; this is RINEX: "G 1C".
std::string SignalName(System system, SignalCode signal);

}  // namespace lodemark
