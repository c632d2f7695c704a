#include "core/logs/sensor_table_columns.h"

#include <cmath>
#include <span>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

// In the order of SensorTableClock come the names of a time; names are compared without regard to
// case. The unit in brackets is how EuRoC writes its headers.
constexpr ColumnName kNames[] = {
    {"time_gps_ns", 0},
    {"timestamp_gps_ns", 0},
    {"timestamp [ns]", 0},
    {"time_gps_s", 1},
    {"time_calendar_gps_s", 2},
    {"time_unix_ns", 3},
    {"time_unix_s", 4},
    {"time_s", 5},
    {"accel_x_mps2", kForceSi},
    {"accel_y_mps2", kForceSi + 1},
    {"accel_z_mps2", kForceSi + 2},
    {"specific_force_x_mps2", kForceSi},
    {"specific_force_y_mps2", kForceSi + 1},
    {"specific_force_z_mps2", kForceSi + 2},
    {"a_RS_S_x [m s^-2]", kForceSi},
    {"a_RS_S_y [m s^-2]", kForceSi + 1},
    {"a_RS_S_z [m s^-2]", kForceSi + 2},
    {"accel_x_g", kForceG},
    {"accel_y_g", kForceG + 1},
    {"accel_z_g", kForceG + 2},
    {"gyro_x_radps", kTurnRateSi},
    {"gyro_y_radps", kTurnRateSi + 1},
    {"gyro_z_radps", kTurnRateSi + 2},
    {"turn_rate_x_radps", kTurnRateSi},
    {"turn_rate_y_radps", kTurnRateSi + 1},
    {"turn_rate_z_radps", kTurnRateSi + 2},
    {"w_RS_S_x [rad s^-1]", kTurnRateSi},
    {"w_RS_S_y [rad s^-1]", kTurnRateSi + 1},
    {"w_RS_S_z [rad s^-1]", kTurnRateSi + 2},
    {"gyro_x_degps", kTurnRateDegrees},
    {"gyro_y_degps", kTurnRateDegrees + 1},
    {"gyro_z_degps", kTurnRateDegrees + 2},
    {"pressure_hpa", kPressureHpa},
    {"pressure_pa", kPressurePa},
    {"speed_mps", kSpeedSi},
    {"speed_kmh", kSpeedKmh},
    {"yaw_rate_radps", kYawRateSi},
    {"yaw_rate_degps", kYawRateDegrees},
};

// The GPS epoch, 1980-01-06, in days since 1970-01-01.
constexpr std::int64_t kGpsEpochSince1970_ns = 3'657 * kDay_ns;

constexpr std::int64_t kLargestTime_ns = 4'000'000'000'000'000'000;  // as the interface takes
constexpr double kLargestTime_s = 4e9;

// A row that tells its columns by its numbers.
constexpr int kGuessedCells = 7;
constexpr double kEarliestCalendar_s = 315'964'800.0;  // 1980-01-06, of seconds since 1970
constexpr double kEarliestCalendar_ns = 3e17;

std::int64_t Nanoseconds(double time_s) {
  const double whole_s = std::floor(time_s);
  return static_cast<std::int64_t>(whole_s) * kSecond_ns +
         static_cast<std::int64_t>(std::round(1e9 * (time_s - whole_s)));
}

}  // namespace

std::span<const ColumnName> SensorTableNames() { return kNames; }

std::optional<SensorTableClock> ClockOf(const CsvColumns& columns) {
  for (int clock = 0; clock < kSensorTableClockCount; ++clock) {
    if (columns.Has(kSensorTime + clock)) return static_cast<SensorTableClock>(clock);
  }
  return std::nullopt;
}

bool HasSensor(const CsvColumns& columns) {
  const auto has_vector = [&columns](int field) {
    return columns.Has(field) && columns.Has(field + 1) && columns.Has(field + 2);
  };
  const bool has_vehicle = (columns.Has(kSpeedSi) || columns.Has(kSpeedKmh)) &&
                           (columns.Has(kYawRateSi) || columns.Has(kYawRateDegrees));
  return ClockOf(columns).has_value() &&
         (has_vector(kForceSi) || has_vector(kForceG) || has_vector(kTurnRateSi) ||
          has_vector(kTurnRateDegrees) || columns.Has(kPressureHpa) || columns.Has(kPressurePa) ||
          has_vehicle);
}

bool IsSensorHeader(std::string_view line) {
  if (line.starts_with('#')) line.remove_prefix(1);
  return HasSensor(CsvColumns(line, SensorTableNames()));
}

std::optional<std::int64_t> ReadSensorTime(const CsvCells& cells, SensorTableClock clock) {
  const int field = kSensorTime + static_cast<int>(clock);
  std::optional<std::int64_t> time_ns;
  if (clock == SensorTableClock::kGpsNanoseconds || clock == SensorTableClock::kUnixNanoseconds) {
    time_ns = cells.RequiredInteger(field, 0, kLargestTime_ns);
  } else if (const auto time_s = cells.RequiredDouble(field, 0.0, kLargestTime_s)) {
    time_ns = Nanoseconds(*time_s);
  }
  if (!time_ns) return std::nullopt;
  switch (clock) {
    case SensorTableClock::kGpsNanoseconds:
    case SensorTableClock::kGpsSeconds:
    case SensorTableClock::kSecondsOfRecording:
      return time_ns;
    case SensorTableClock::kCalendarGpsSeconds:
      return *time_ns - kGpsEpochSince1970_ns;
    case SensorTableClock::kUnixNanoseconds:
    case SensorTableClock::kUnixSeconds:
      break;
  }
  return GpsFromScale(*time_ns - kGpsEpochSince1970_ns, TimeScale::kUtc);
}

std::string GuessSensorColumns(std::string_view first_row) {
  double cells[kGuessedCells] = {};
  for (double& cell : cells) {
    const std::size_t comma = first_row.find(',');
    const std::optional<double> value = ParseDouble(first_row.substr(0, comma));
    if (!value) return {};
    cell = *value;
    if (comma == std::string_view::npos && &cell != &cells[kGuessedCells - 1]) return {};
    first_row.remove_prefix(comma == std::string_view::npos ? first_row.size() : comma + 1);
  }
  const double force = std::hypot(cells[1], cells[2], cells[3]);
  const bool in_g = force > 0.5 && force < 2.0;
  const bool in_si = force > 5.0 && force < 20.0;
  if (!in_g && !in_si) return {};
  std::string header = cells[0] > kEarliestCalendar_ns  ? "time_gps_ns"
                       : cells[0] > kEarliestCalendar_s ? "time_calendar_gps_s"
                                                        : "time_s";
  header += in_g ? ",accel_x_g,accel_y_g,accel_z_g" : ",accel_x_mps2,accel_y_mps2,accel_z_mps2";
  return header + ",gyro_x_radps,gyro_y_radps,gyro_z_radps";
}

}  // namespace lodemark
