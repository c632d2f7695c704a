// Rows of a csv file of which every one must be right: a map is not made from half a table.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/logs/csv_columns.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

// Columns are found by the names in the header line. Empty lines and those that begin with '#' are
// passed over.
class TableRows {
 public:
  // Fails if the file cannot be read or has no header. The names must outlive the object.
  static Result<TableRows> Open(const std::string& path, std::span<const ColumnName> names);
  static Result<TableRows> FromMemory(std::string name, std::string_view text,
                                      std::span<const ColumnName> names);

  bool Has(int field) const { return columns_.Has(field); }
  // An error that names the columns which the file lacks.
  Status Require(std::span<const int> fields) const;

  // The next row. False at the end, after the first malformed value and after a failure to read.
  bool Next();

  // Of the current row. What is missing or out of its range is remembered and ends the reading.
  std::string_view Text(int field);
  double Number(int field, double least, double most);
  std::int64_t Integer(int field, std::int64_t least, std::int64_t most);
  // The same where an empty cell or no such column is no fault.
  std::optional<double> MaybeNumber(int field, double least, double most);
  std::string_view MaybeText(int field) const;

  // The current row makes no sense for the reason given.
  void Refuse(int field, std::string_view why);

  // Whether all was well so far. The error says file, line and column.
  Status status() const;
  std::int64_t rows() const { return rows_; }
  double progress() const { return lines_.progress(); }
  const std::string& name() const { return lines_.name(); }
  std::int64_t line_number() const { return lines_.line_number(); }

 private:
  explicit TableRows(LineReader lines) : lines_(std::move(lines)) {}
  static Result<TableRows> Begin(LineReader lines, std::span<const ColumnName> names);
  CsvCells Cells();

  LineReader lines_;
  CsvColumns columns_;
  CsvRow row_;
  ReadReport report_;
  std::int64_t rows_ = 0;
};

}  // namespace lodemark
