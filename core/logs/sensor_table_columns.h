// The columns that tables of sensor samples may have, each with its unit.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/logs/csv_columns.h"

namespace lodemark {

// Fields of one column each; those of a vector follow one another x y z. Time comes first, a field
// for each SensorTableClock.
inline constexpr int kSensorTime = 0;
inline constexpr int kForceSi = 6;
inline constexpr int kForceG = 9;
inline constexpr int kTurnRateSi = 12;
inline constexpr int kTurnRateDegrees = 15;
inline constexpr int kPressureHpa = 18;
inline constexpr int kPressurePa = 19;
inline constexpr int kSpeedSi = 20;
inline constexpr int kSpeedKmh = 21;
inline constexpr int kYawRateSi = 22;
inline constexpr int kYawRateDegrees = 23;

// How the table counts time.
enum class SensorTableClock : std::uint8_t {
  kGpsNanoseconds,      // since 1980-01-06, no leap seconds
  kGpsSeconds,          // the same
  kCalendarGpsSeconds,  // days of GPS time, counted since 1970-01-01
  kUnixNanoseconds,     // UTC
  kUnixSeconds,         // UTC
  kSecondsOfRecording,  // since the first epoch
};
inline constexpr int kSensorTableClockCount = 6;

// The names for CsvColumns.
std::span<const ColumnName> SensorTableNames();

// The clock whose column the table has.
std::optional<SensorTableClock> ClockOf(const CsvColumns& columns);

// Whether there are a time and all columns of at least one sensor.
bool HasSensor(const CsvColumns& columns);
// A header line, with a '#' before it or without.
bool IsSensorHeader(std::string_view line);

// GPS time of the cell, or nanoseconds of the recording. Empty, and the row counted as skipped,
// if it is no time.
std::optional<std::int64_t> ReadSensorTime(const CsvCells& cells, SensorTableClock clock);

// The header that a row without one calls for: time, specific force, turn rate. Empty if its
// numbers do not tell, as where they are not of a device that rests or moves gently.
std::string GuessSensorColumns(std::string_view first_row);

}  // namespace lodemark
