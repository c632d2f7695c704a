// What a file is, told from its first lines or messages.
#include <algorithm>

#include "core/logs/line_reader.h"
#include "core/logs/parse_number.h"
#include "core/logs/recording.h"
#include "core/logs/sensor_table_columns.h"
#include "core/logs/ubx_frames.h"

namespace lodemark {
namespace {

// A GnssLogger header has some 40 lines before the first row.
constexpr int kMostLines = 80;

// RINEX puts the name of a header record into columns 61 to 80.
constexpr std::size_t kLabelColumn = 60;

std::string_view LabelOf(std::string_view line) {
  return line.size() > kLabelColumn ? TrimSpaces(line.substr(kLabelColumn)) : std::string_view();
}

// Types of RINEX 2, 3 and 4: table A1 of RINEX 2.11, 5.1 of RINEX 4.00.
FileKind RinexKind(std::string_view line) {
  switch (line[20]) {
    case 'O':
      return FileKind::kRinexObservation;
    case 'N':
    case 'G':
    case 'H':
    case 'E':
    case 'L':
    case 'J':
    case 'C':
    case 'I':
      return FileKind::kRinexNavigation;
    default:
      return FileKind::kUnknown;
  }
}

bool NamesColumn(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t comma = header.find(',');
    if (TrimSpaces(header.substr(0, comma)) == name) return true;
    if (comma == std::string_view::npos) return false;
    header.remove_prefix(comma + 1);
  }
  return false;
}

FileKind KindOfFirstLine(std::string_view line) {
  const std::string_view label = LabelOf(line);
  if (label == "RINEX VERSION / TYPE") return RinexKind(line);
  if (label == "CRINEX VERS   / TYPE") return FileKind::kRinexObservation;
  const bool sp3 = line.size() > 2 && line[0] == '#' && line[1] >= 'a' && line[1] <= 'd' &&
                   (line[2] == 'P' || line[2] == 'V');
  if (sp3) return FileKind::kSp3;
  if (NamesColumn(line, "RawPseudorangeMeters") && NamesColumn(line, "TimeNanos")) {
    return FileKind::kDeviceGnss;
  }
  if (NamesColumn(line, "rawPrM") && NamesColumn(line, "millisSinceGpsEpoch")) {
    return FileKind::kDerived;
  }
  if (NamesColumn(line, "time_gps_ns") && NamesColumn(line, "latitude_deg") &&
      NamesColumn(line, "longitude_deg")) {
    return FileKind::kTrajectory;
  }
  if (IsSensorHeader(line) || line.starts_with("odom3 ")) return FileKind::kSensors;
  return FileKind::kUnknown;
}

bool IsGnssLogLine(std::string_view line) {
  if (line.starts_with('#')) {
    line = TrimSpaces(line.substr(1));
    return line.starts_with("Raw,") || line.starts_with("Header Description:");
  }
  return line.starts_with("Raw,") && std::count(line.begin(), line.end(), ',') >= 20;
}

}  // namespace

Result<FileKind> SniffFile(const std::string& path) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  std::string_view line;
  bool first = true;
  for (int i = 0; i < kMostLines && lines->Next(&line); ++i) {
    if (line.size() == LineReader::kLongestLine) break;  // no text
    if (TrimSpaces(line).empty()) continue;
    if (first) {
      const FileKind kind = KindOfFirstLine(line);
      if (kind != FileKind::kUnknown) return kind;
      first = false;
    }
    if (IsGnssLogLine(line)) return FileKind::kGnssLog;
  }
  return BeginsLikeUbx(path) ? FileKind::kUbx : FileKind::kUnknown;
}

std::string_view RoleOf(FileKind kind) {
  switch (kind) {
    case FileKind::kGnssLog:
      return "gnss_log";
    case FileKind::kRinexObservation:
      return "observation";
    case FileKind::kRinexNavigation:
      return "navigation";
    case FileKind::kSp3:
      return "precise_orbits";
    case FileKind::kDeviceGnss:
      return "device_gnss";
    case FileKind::kDerived:
      return "derived";
    case FileKind::kTrajectory:
      return "trajectory";
    case FileKind::kUbx:
      return "receiver_raw";
    case FileKind::kSensors:
      return "imu";
    case FileKind::kUnknown:
      break;
  }
  return {};
}

}  // namespace lodemark
