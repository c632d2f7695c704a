// The kinds of rows in a GnssLogger text and the columns each has.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/logs/csv_columns.h"

namespace lodemark {

// Leading words of the rows this reader knows.
enum class RowKind : std::uint8_t {
  kRaw,
  kFix,
  kStatus,
  kNav,
  kAgc,
  kUncalAccel,
  kAccel,
  kUncalGyro,
  kGyro,
  kUncalMag,
  kMag,
  kOrientationDeg,
  kGameRotationVector,
  kPressure,
};
inline constexpr int kRowKindCount = 14;

std::optional<RowKind> RowKindFromWord(std::string_view word);
std::string_view WordOf(RowKind kind);

std::span<const ColumnName> ColumnNamesOf(RowKind kind);

// The column order of logs without a header for this kind, by the number of columns of the row.
std::string_view DefaultHeader(RowKind kind, int columns);

// Whether the columns suffice to read rows of this kind at all.
bool Suffices(RowKind kind, const CsvColumns& columns);

// A sensor row with biases after its values.
bool IsUncalibrated(RowKind kind);

// The fields of each kind but Raw, whose are in raw_row.h.
enum FixField : int {
  kFixProvider,
  kFixLatitude,
  kFixLongitude,
  kFixAltitude,
  kFixSpeed,
  kFixAccuracy,
  kFixBearing,
  kFixUnixTime,
  kFixSpeedAccuracy,
  kFixElapsedRealtime,
  kFixVerticalAccuracy,
};

enum StatusField : int {
  kStatusUnixTime,
  kStatusConstellation,
  kStatusSvid,
  kStatusCarrier,
  kStatusCn0,
  kStatusAzimuth,
  kStatusElevation,
  kStatusUsed,
};

enum AgcField : int {
  kAgcUnixTime,
  kAgcElapsedRealtime,
  kAgcDb,
  kAgcCarrier,
  kAgcConstellation,
};

enum SensorField : int {
  kSensorUnixTime,
  kSensorElapsedRealtime,
  kSensorX,
  kSensorY,
  kSensorZ,
  kSensorW,
  kSensorBiasX,
  kSensorBiasY,
  kSensorBiasZ,
};

}  // namespace lodemark
