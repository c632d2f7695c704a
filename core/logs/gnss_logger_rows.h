// The rows of a GnssLogger text besides Raw.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/logs/csv_columns.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/gnss_logger_columns.h"

namespace lodemark {

// Each replaces *record, reusing its memory, or counts the row as skipped and gives false.
bool ReadFix(const CsvCells& cells, const CsvRow& row, LoggedFix* record);
bool ReadStatus(const CsvCells& cells, LoggedStatus* record);
bool ReadAgc(const CsvCells& cells, LoggedAgc* record);
bool ReadSensor(RowKind kind, const CsvCells& cells, LoggedSensor* record);

// Nav rows end in as many columns as the message has bytes, so these are read by their order.
bool ReadNavigationMessage(std::string_view line, std::int64_t line_number,
                           LoggedNavigationMessage* record, ReadReport* report);

}  // namespace lodemark
