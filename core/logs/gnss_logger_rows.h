// The rows of a GnssLogger text besides Raw: what each one's columns are and how they are read.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "core/logs/csv_columns.h"
#include "core/logs/gnss_logger.h"

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

// Each replaces *record, reusing its memory, or counts the row as skipped and gives false.
bool ReadFix(const CsvCells& cells, const CsvRow& row, LoggedFix* record);
bool ReadStatus(const CsvCells& cells, LoggedStatus* record);
bool ReadAgc(const CsvCells& cells, LoggedAgc* record);
bool ReadSensor(RowKind kind, const CsvCells& cells, LoggedSensor* record);

// Nav rows end in as many columns as the message has bytes, so these are read by their order.
bool ReadNavigationMessage(std::string_view line, std::int64_t line_number,
                           LoggedNavigationMessage* record, ReadReport* report);

}  // namespace lodemark
