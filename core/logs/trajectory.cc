#include "core/logs/trajectory.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/logs/csv_columns.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

constexpr std::int64_t kLargestTime_ns = 4'600'000'000'000'000'000;
constexpr std::size_t kMostPoints = 5'000'000;  // a day at 50 Hz

constexpr double kLargestHeight_m = 1e8;
constexpr double kLargestSpeed_mps = 1e5;
constexpr double kLargest = 1e15;  // of what has no natural limit

enum Field : int {
  kTime,
  kLatitude,
  kLongitude,
  kHeight,
  kVelocityEast,
  kVelocityNorth,
  kVelocityUp,
  kAccuracy,
  kVerticalAccuracy,
  kSpeedAccuracy,
  kProtectionLevel,
  kVerticalProtectionLevel,
  kCovariance,  // six of them
  kClockBias = kCovariance + 6,
  kClockDrift,
  kSources,
  kSatellitesUsed,
  kHdop,
  kVdop,
  kStatus,
};

// In the order of the file.
constexpr ColumnName kNames[] = {
    {"time_gps_ns", kTime},
    {"latitude_deg", kLatitude},
    {"longitude_deg", kLongitude},
    {"height_m", kHeight},
    {"velocity_east_mps", kVelocityEast},
    {"velocity_north_mps", kVelocityNorth},
    {"velocity_up_mps", kVelocityUp},
    {"accuracy_m", kAccuracy},
    {"vertical_accuracy_m", kVerticalAccuracy},
    {"speed_accuracy_mps", kSpeedAccuracy},
    {"protection_level_m", kProtectionLevel},
    {"vertical_protection_level_m", kVerticalProtectionLevel},
    {"covariance_ee_m2", kCovariance + 0},
    {"covariance_en_m2", kCovariance + 1},
    {"covariance_nn_m2", kCovariance + 2},
    {"covariance_eu_m2", kCovariance + 3},
    {"covariance_nu_m2", kCovariance + 4},
    {"covariance_uu_m2", kCovariance + 5},
    {"clock_bias_m", kClockBias},
    {"clock_drift_mps", kClockDrift},
    {"sources", kSources},
    {"satellites_used", kSatellitesUsed},
    {"hdop", kHdop},
    {"vdop", kVdop},
    {"status", kStatus},
};

std::optional<TrajectoryPoint> ReadPoint(const CsvCells& cells, const CsvRow& row) {
  TrajectoryPoint point;
  const auto time_gps_ns = cells.RequiredInteger(kTime, 0, kLargestTime_ns);
  if (!time_gps_ns) return std::nullopt;
  point.time_gps_ns = *time_gps_ns;
  // A row without a fix has neither; one without the other, or a NaN, is malformed.
  const bool empty = TrimSpaces(row[kLatitude]).empty() && TrimSpaces(row[kLongitude]).empty();
  if (!empty) {
    point.latitude_deg = cells.RequiredDouble(kLatitude, -90.0, 90.0);
    if (!point.latitude_deg) return std::nullopt;
    point.longitude_deg = cells.RequiredDouble(kLongitude, -180.0, 360.0);
    if (!point.longitude_deg) return std::nullopt;
  }
  point.height_m = cells.Double(kHeight, -kLargestHeight_m, kLargestHeight_m);
  for (int i = 0; i < 3; ++i) {
    point.velocity_enu_mps[static_cast<std::size_t>(i)] =
        cells.Double(kVelocityEast + i, -kLargestSpeed_mps, kLargestSpeed_mps);
  }
  point.accuracy_m = cells.Double(kAccuracy, 0.0, kLargest);
  point.vertical_accuracy_m = cells.Double(kVerticalAccuracy, 0.0, kLargest);
  point.speed_accuracy_mps = cells.Double(kSpeedAccuracy, 0.0, kLargest);
  point.protection_level_m = cells.Double(kProtectionLevel, 0.0, kLargest);
  point.vertical_protection_level_m = cells.Double(kVerticalProtectionLevel, 0.0, kLargest);
  for (int i = 0; i < 6; ++i) {
    point.covariance_enu_m2[static_cast<std::size_t>(i)] =
        cells.Double(kCovariance + i, -kLargest, kLargest);
  }
  point.clock_bias_m = cells.Double(kClockBias, -kLargest, kLargest);
  point.clock_drift_mps = cells.Double(kClockDrift, -kLargest, kLargest);
  point.sources = TrimSpaces(row[kSources]).substr(0, 64);
  if (const auto used = cells.Integer(kSatellitesUsed, 0, 10'000)) {
    point.satellites_used = static_cast<std::int32_t>(*used);
  }
  point.hdop = cells.Double(kHdop, 0.0, kLargest);
  point.vdop = cells.Double(kVdop, 0.0, kLargest);
  point.status = TrimSpaces(row[kStatus]).substr(0, 64);
  return point;
}

std::optional<double> Between(const std::optional<double>& a, const std::optional<double>& b,
                              double share) {
  if (!a || !b) return std::nullopt;
  return *a + share * (*b - *a);
}

// The short way round, in -180..180.
double LongitudeBetween(double a_deg, double b_deg, double share) {
  const double step_deg = std::remainder(b_deg - a_deg, 360.0);
  return std::remainder(a_deg + share * step_deg, 360.0);
}

// Appends a comma and the number, or only the comma.
void AppendNumber(const std::optional<double>& value, std::chars_format format, int precision,
                  std::string* text) {
  *text += ',';
  if (!value || !std::isfinite(*value)) return;
  char digits[400];
  const auto [end, error] =
      std::to_chars(std::begin(digits), std::end(digits), *value, format, precision);
  if (error == std::errc()) text->append(digits, end);
}

void AppendFixed(const std::optional<double>& value, int decimals, std::string* text) {
  AppendNumber(value, std::chars_format::fixed, decimals, text);
}

}  // namespace

Trajectory::Trajectory(std::vector<TrajectoryPoint> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&points](std::size_t a, std::size_t b) {
    return std::pair(points[a].time_gps_ns, a) < std::pair(points[b].time_gps_ns, b);
  });
  points_.reserve(points.size());
  for (const std::size_t i : order) {
    if (!points_.empty() && points_.back().time_gps_ns == points[i].time_gps_ns) continue;
    if (points[i].has_position()) positions_.push_back(points_.size());
    points_.push_back(std::move(points[i]));
  }
}

std::optional<TrajectoryPoint> Trajectory::At(std::int64_t time_gps_ns) const {
  TrajectoryPoint at;
  at.time_gps_ns = time_gps_ns;
  const auto copy_from = [&at](const TrajectoryPoint& point) {
    at.latitude_deg = point.latitude_deg;
    at.longitude_deg = point.longitude_deg;
    at.height_m = point.height_m;
    at.velocity_enu_mps = point.velocity_enu_mps;
  };
  if (is_static()) {
    copy_from(points_[0]);
    return at;
  }
  const auto later = std::lower_bound(
      positions_.begin(), positions_.end(), time_gps_ns,
      [this](std::size_t i, std::int64_t time) { return points_[i].time_gps_ns < time; });
  if (later == positions_.end()) return std::nullopt;
  const TrajectoryPoint& b = points_[*later];
  if (b.time_gps_ns == time_gps_ns) {
    copy_from(b);
    return at;
  }
  if (later == positions_.begin()) return std::nullopt;
  const TrajectoryPoint& a = points_[*(later - 1)];
  const std::int64_t gap_ns = b.time_gps_ns - a.time_gps_ns;
  if (gap_ns > kLongestGap_ns) return std::nullopt;
  const double share =
      static_cast<double>(time_gps_ns - a.time_gps_ns) / static_cast<double>(gap_ns);
  at.latitude_deg = Between(a.latitude_deg, b.latitude_deg, share);
  at.longitude_deg = LongitudeBetween(*a.longitude_deg, *b.longitude_deg, share);
  at.height_m = Between(a.height_m, b.height_m, share);
  for (std::size_t i = 0; i < 3; ++i) {
    at.velocity_enu_mps[i] = Between(a.velocity_enu_mps[i], b.velocity_enu_mps[i], share);
  }
  return at;
}

Result<Trajectory> ReadTrajectory(LineReader* lines, ReadReport* report) {
  report->file = lines->name();
  std::string_view line;
  CsvColumns columns;
  while (columns.column_count() == 0 && lines->Next(&line)) {
    if (!TrimSpaces(line).empty()) columns = CsvColumns(line, kNames);
  }
  if (columns.column_count() == 0 || !columns.Has(kTime) || !columns.Has(kLatitude) ||
      !columns.Has(kLongitude)) {
    if (!lines->status().ok()) return lines->status().error();
    return Error{ErrorCode::kBadData,
                 lines->name() +
                     ": the first line does not name the columns time_gps_ns, latitude_deg and "
                     "longitude_deg"};
  }
  std::vector<TrajectoryPoint> points;
  CsvRow row;
  while (lines->Next(&line)) {
    if (TrimSpaces(line).empty()) continue;
    columns.Split(line, false, &row);
    const CsvCells cells(columns, row, lines->line_number(), report);
    if (row.cell_count < columns.column_count()) {
      report->Skip(lines->line_number(), 0,
                   "the row has " + std::to_string(row.cell_count) + " of " +
                       std::to_string(columns.column_count()) + " columns");
      continue;
    }
    std::optional<TrajectoryPoint> point = ReadPoint(cells, row);
    if (!point) continue;
    if (points.size() == kMostPoints) {
      return Error{ErrorCode::kBadData, lines->name() + ": more than 5,000,000 rows"};
    }
    points.push_back(*std::move(point));
    ++report->rows_read;
  }
  if (!lines->status().ok()) return lines->status().error();
  if (points.empty()) {
    const std::string& name = lines->name();
    return Error{ErrorCode::kBadData,
                 (report->problems.empty() ? name + ": the file has only a header"
                                           : FormatProblem(name, report->problems.front())) +
                     "; no row could be read"};
  }
  return Trajectory(std::move(points));
}

Result<Trajectory> ReadTrajectory(const std::string& path, ReadReport* report) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return ReadTrajectory(&*lines, report);
}

std::string TrajectoryHeader() {
  std::string header;
  for (const ColumnName& name : kNames) {
    if (!header.empty()) header += ',';
    header += name.name;
  }
  return header + '\n';
}

void AppendTrajectoryRow(const TrajectoryPoint& point, std::string* text) {
  *text += std::to_string(point.time_gps_ns);
  AppendFixed(point.latitude_deg, 10, text);  // 0.01 mm
  AppendFixed(point.longitude_deg, 10, text);
  AppendFixed(point.height_m, 4, text);
  for (const auto& component_mps : point.velocity_enu_mps) AppendFixed(component_mps, 4, text);
  AppendFixed(point.accuracy_m, 4, text);
  AppendFixed(point.vertical_accuracy_m, 4, text);
  AppendFixed(point.speed_accuracy_mps, 4, text);
  AppendFixed(point.protection_level_m, 4, text);
  AppendFixed(point.vertical_protection_level_m, 4, text);
  for (const auto& element_m2 : point.covariance_enu_m2) {
    AppendNumber(element_m2, std::chars_format::general, 9, text);
  }
  AppendFixed(point.clock_bias_m, 4, text);
  AppendFixed(point.clock_drift_mps, 4, text);
  *text += ',' + point.sources + ',';
  if (point.satellites_used) *text += std::to_string(*point.satellites_used);
  AppendFixed(point.hdop, 3, text);
  AppendFixed(point.vdop, 3, text);
  *text += ',' + point.status + '\n';
}

}  // namespace lodemark
