// Rows of a comma-separated file, whose columns are found by the names in its header line.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

class CsvTable {
 public:
  // Fails if the file cannot be read or a required column is missing; then the message lists it.
  static Result<CsvTable> Open(const std::string& path,
                               std::initializer_list<std::string_view> required);
  static Result<CsvTable> From(LineReader lines, std::initializer_list<std::string_view> required);

  // Place of a column for the calls below; -1 if the file has none of that name.
  int Column(std::string_view name) const;

  // The next row that is neither empty nor a comment ('#'). False at the end or after a read error.
  bool Next();

  // Of the current row. A missing column or field is empty.
  std::string_view Text(int column) const;
  std::optional<double> Number(int column) const;
  std::optional<std::int64_t> Integer(int column) const;

  // Counts the current row as malformed.
  void Skip(int column, std::string_view message);

  const ReadReport& report() const { return report_; }
  const Status& status() const { return lines_.status(); }
  double progress() const { return lines_.progress(); }

 private:
  explicit CsvTable(LineReader lines) : lines_(std::move(lines)) {}

  LineReader lines_;
  std::vector<std::string> names_;
  std::string_view line_;
  std::vector<std::string_view> fields_;
  ReadReport report_;
};

}  // namespace lodemark
