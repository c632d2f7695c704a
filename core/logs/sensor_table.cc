#include "core/logs/sensor_table.h"

#include <utility>

#include "core/base/units.h"
#include "core/logs/csv_columns.h"
#include "core/logs/parse_number.h"
#include "core/logs/sensor_table_columns.h"

namespace lodemark {
namespace {

constexpr double kStandardGravity_mps2 = 9.80665;  // what a g is, by definition

// Beyond these no sensor measures; the interface takes no more.
constexpr double kLargestForce_mps2 = 1e4;
constexpr double kLargestTurnRate_radps = 1e3;
constexpr double kSmallestPressure_hpa = 1.0;
constexpr double kLargestPressure_hpa = 2e3;
constexpr double kLargestSpeed_mps = 1e3;

// Rows of the smartLoc recordings: their word, seconds since the first epoch, velocities and turn
// rates about the vehicle's x forward, y left and z up, covariances; apart by blanks.
constexpr std::string_view kOdometryWord = "odom3";
constexpr int kOdometryTime = 1;
constexpr int kOdometrySpeed = 2;
constexpr int kOdometryYawRate = 7;
constexpr double kLargestTime_s = 1e7;

// Lines before the first that tells what the file is.
constexpr int kMostLeadingLines = 80;

bool StartsWithNumber(std::string_view line) {
  return ParseDouble(line.substr(0, line.find(','))).has_value();
}

bool IsOdometry(std::string_view line) {
  const std::string_view word = line.substr(0, line.find(' '));
  return word == kOdometryWord || word == "pseudorange3" || word == "point3";
}

}  // namespace

struct SensorTableReader::Impl {
  explicit Impl(LineReader line_reader) : lines(std::move(line_reader)) {
    report.file = lines.name();
  }

  LineReader lines;
  ReadReport report;
  CsvColumns columns;
  CsvRow cells;
  SensorTableClock clock = SensorTableClock::kSecondsOfRecording;
  bool odometry = false;  // odom3 rows
  std::string guessed;
  std::string waiting;  // the first row, read to see what the file is
  bool has_waiting = false;

  // Reads the header, or what stands for one.
  Status Begin(std::string_view stated) {
    std::string_view line;
    for (int i = 0; i < kMostLeadingLines && lines.Next(&line); ++i) {
      const std::string_view text = TrimSpaces(line);
      if (text.empty()) continue;
      if (stated.empty() && IsOdometry(text)) {
        odometry = true;
        Keep(line);
        return {};
      }
      if (StartsWithNumber(text)) {
        Keep(line);
        if (stated.empty()) guessed = GuessSensorColumns(text);
        return TakeHeader(stated.empty() ? guessed : stated);
      }
      if (stated.empty()) {
        const bool comment = text.front() == '#';
        const Status taken = TakeHeader(TrimSpaces(text.substr(comment ? 1 : 0)));
        if (taken.ok() || !comment) return taken;
      }
    }
    if (!lines.status().ok()) return lines.status().error();
    return Error{ErrorCode::kBadData, lines.name() + ": holds no row of numbers"};
  }

  void Keep(std::string_view line) {
    waiting = line;
    has_waiting = true;
  }

  Status TakeHeader(std::string_view header) {
    columns = CsvColumns(header, SensorTableNames());
    if (!HasSensor(columns)) {
      return Error{ErrorCode::kBadData,
                   lines.name() +
                       ": its columns cannot be told; begin it with a line such as "
                       "time_gps_ns,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,..., or "
                       "say so in the manifest"};
    }
    clock = *ClockOf(columns);
    return {};
  }

  bool HasVector(int field) const {
    return columns.Has(field) && columns.Has(field + 1) && columns.Has(field + 2);
  }

  std::optional<std::array<double, 3>> Vector(const CsvCells& row, int field, double to_si,
                                              double largest) const {
    if (!HasVector(field)) return std::nullopt;
    std::array<double, 3> vector = {};
    for (int i = 0; i < 3; ++i) {
      const auto value = row.Double(field + i, -largest / to_si, largest / to_si);
      if (!value) return std::nullopt;
      vector[static_cast<std::size_t>(i)] = *value * to_si;
    }
    return vector;
  }

  std::optional<double> Scalar(const CsvCells& row, int field, double to_si, double least,
                               double most) const {
    const auto value = row.Double(field, least / to_si, most / to_si);
    return value ? std::optional(*value * to_si) : std::nullopt;
  }

  bool ReadCsv(std::string_view line, SensorRow* row) {
    columns.Split(line, lines.last_line_unterminated(), &cells);
    const CsvCells read(columns, cells, lines.line_number(), &report);
    const auto time_ns = ReadSensorTime(read, clock);
    if (!time_ns) return false;
    *row = SensorRow();
    row->time_ns = *time_ns;
    row->force_mps2 = Vector(read, kForceSi, 1.0, kLargestForce_mps2);
    if (!row->force_mps2) {
      row->force_mps2 = Vector(read, kForceG, kStandardGravity_mps2, kLargestForce_mps2);
    }
    row->turn_rate_radps = Vector(read, kTurnRateSi, 1.0, kLargestTurnRate_radps);
    if (!row->turn_rate_radps) {
      row->turn_rate_radps =
          Vector(read, kTurnRateDegrees, kRadiansPerDegree, kLargestTurnRate_radps);
    }
    row->pressure_hpa =
        Scalar(read, kPressureHpa, 1.0, kSmallestPressure_hpa, kLargestPressure_hpa);
    if (!row->pressure_hpa) {
      row->pressure_hpa =
          Scalar(read, kPressurePa, 0.01, kSmallestPressure_hpa, kLargestPressure_hpa);
    }
    row->speed_mps = Scalar(read, kSpeedSi, 1.0, -kLargestSpeed_mps, kLargestSpeed_mps);
    if (!row->speed_mps) {
      row->speed_mps = Scalar(read, kSpeedKmh, 1.0 / 3.6, -kLargestSpeed_mps, kLargestSpeed_mps);
    }
    row->yaw_rate_radps =
        Scalar(read, kYawRateSi, 1.0, -kLargestTurnRate_radps, kLargestTurnRate_radps);
    if (!row->yaw_rate_radps) {
      row->yaw_rate_radps = Scalar(read, kYawRateDegrees, kRadiansPerDegree,
                                   -kLargestTurnRate_radps, kLargestTurnRate_radps);
    }
    const bool has_vehicle = row->speed_mps && row->yaw_rate_radps;
    if (row->force_mps2 || row->turn_rate_radps || row->pressure_hpa || has_vehicle) return true;
    report.Skip(lines.line_number(), 0, "the row has no complete value of any sensor");
    return false;
  }

  // False for rows of other kinds, too.
  bool ReadOdometry(std::string_view line, SensorRow* row) {
    std::array<std::optional<double>, kOdometryYawRate + 1> values = {};
    std::string_view rest = line;
    std::string_view word;
    for (std::size_t i = 0; i < values.size() && !rest.empty(); ++i) {
      const std::size_t blank = rest.find(' ');
      const std::string_view cell = rest.substr(0, blank);
      if (i == 0) word = cell;
      if (i > 0) values[i] = ParseDouble(cell);
      rest.remove_prefix(blank == std::string_view::npos ? rest.size() : blank + 1);
    }
    if (word != kOdometryWord) {
      ++report.rows_unknown;
      return false;
    }
    const auto within = [&](int i, double least, double most) {
      const std::optional<double>& value = values[static_cast<std::size_t>(i)];
      return value && *value >= least && *value <= most;
    };
    if (!within(kOdometryTime, 0.0, kLargestTime_s) ||
        !within(kOdometrySpeed, -kLargestSpeed_mps, kLargestSpeed_mps) ||
        !within(kOdometryYawRate, -kLargestTurnRate_radps, kLargestTurnRate_radps)) {
      report.Skip(lines.line_number(), 0, "the odom3 row lacks a time, speed or turn rate");
      return false;
    }
    *row = SensorRow();
    row->time_ns = static_cast<std::int64_t>(*values[kOdometryTime] * 1e9);
    row->speed_mps = values[kOdometrySpeed];
    row->yaw_rate_radps = values[kOdometryYawRate];
    return true;
  }

  bool Read(std::string_view line, SensorRow* row) {
    const std::string_view text = TrimSpaces(line);
    if (text.empty() || text.front() == '#') return false;
    const bool read = odometry ? ReadOdometry(text, row) : ReadCsv(line, row);
    report.rows_read += read ? 1 : 0;
    return read;
  }
};

SensorTableReader::SensorTableReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SensorTableReader::SensorTableReader(SensorTableReader&&) noexcept = default;
SensorTableReader& SensorTableReader::operator=(SensorTableReader&&) noexcept = default;
SensorTableReader::~SensorTableReader() = default;

Result<SensorTableReader> SensorTableReader::Open(const std::string& path,
                                                  std::string_view columns) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return FromLines(std::move(*lines), columns);
}

Result<SensorTableReader> SensorTableReader::FromLines(LineReader lines, std::string_view columns) {
  auto impl = std::make_unique<Impl>(std::move(lines));
  const Status begun = impl->Begin(columns);
  if (!begun.ok()) return begun.error();
  return SensorTableReader(std::move(impl));
}

bool SensorTableReader::Next(SensorRow* row) {
  Impl& s = *impl_;
  if (s.has_waiting) {
    s.has_waiting = false;
    if (s.Read(s.waiting, row)) return true;
  }
  std::string_view line;
  while (s.lines.Next(&line)) {
    if (s.Read(line, row)) return true;
  }
  return false;
}

bool SensorTableReader::is_relative() const {
  return impl_->clock == SensorTableClock::kSecondsOfRecording;
}
const std::string& SensorTableReader::guessed_columns() const { return impl_->guessed; }
const ReadReport& SensorTableReader::report() const { return impl_->report; }
const Status& SensorTableReader::status() const { return impl_->lines.status(); }
double SensorTableReader::progress() const { return impl_->lines.progress(); }

}  // namespace lodemark
