// Comma-separated rows read by the names of their columns.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/logs/read_report.h"

namespace lodemark {

// A name a column may have in a header, and the field it holds. Several names may mean one field.
struct ColumnName {
  std::string_view name;
  int field = 0;
};

inline constexpr int kMostCsvFields = 96;
inline constexpr int kMostCsvColumns = 256;  // further ones are not looked at

// The cells of one row, by field. Views into the line.
struct CsvRow {
  std::string_view line;
  std::array<std::string_view, kMostCsvFields> cells;
  int cell_count = 0;

  std::string_view operator[](int field) const { return cells[static_cast<std::size_t>(field)]; }
  // From 1; 0 if the row has no such cell.
  std::int32_t ColumnOf(int field) const;
};

// Which column holds which field.
class CsvColumns {
 public:
  CsvColumns() = default;
  // Names are compared without regard to case and blanks; names that are not in the list are
  // columns to pass over. The list must outlive this object.
  CsvColumns(std::string_view header, std::span<const ColumnName> names);

  bool Has(int field) const;
  int column_count() const { return column_count_; }

  // Where a field has several columns, the first that is not empty counts. A line that may be cut
  // off, or has fewer cells than the header, loses its last cell: its digits may be missing.
  void Split(std::string_view line, bool may_be_cut, CsvRow* row) const;

  // The first name in the list that means this field.
  std::string_view NameOf(int field) const;

 private:
  static constexpr std::uint8_t kPassOver = 255;

  std::array<std::uint8_t, kMostCsvColumns> field_of_column_ = {};
  std::span<const ColumnName> names_;
  int column_count_ = 0;
  int field_count_ = 0;
};

// Reads the cells of a row within ranges. What is malformed or out of its range counts as missing
// and is noted in the report; empty cells, NaN, infinities and the largest float or double, which
// loggers write for "none", are missing without a note.
class CsvCells {
 public:
  CsvCells(const CsvColumns& columns, const CsvRow& row, std::int64_t line_number,
           ReadReport* report)
      : columns_(columns), row_(row), line_number_(line_number), report_(report) {}

  std::optional<double> Double(int field, double least, double most) const;
  std::optional<std::int64_t> Integer(int field, std::int64_t least, std::int64_t most) const;

  // The same for fields a row is nothing without: empty counts the row as skipped.
  std::optional<double> RequiredDouble(int field, double least, double most) const;
  std::optional<std::int64_t> RequiredInteger(int field, std::int64_t least,
                                              std::int64_t most) const;

  // Counts the row as skipped because this field is missing or wrong.
  void Skip(int field) const;

  // The cell holds one of the marks loggers write for "none", or nothing.
  bool IsNone(int field) const;

 private:
  void Drop(int field) const;

  const CsvColumns& columns_;
  const CsvRow& row_;
  std::int64_t line_number_;
  ReadReport* report_;
};

}  // namespace lodemark
