#include "tools/mapping/table_rows.h"

#include <utility>

#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

bool HoldsRow(std::string_view line) {
  const std::string_view text = TrimSpaces(line);
  return !text.empty() && text.front() != '#';
}

}  // namespace

Result<TableRows> TableRows::Open(const std::string& path, std::span<const ColumnName> names) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return Begin(std::move(lines).value(), names);
}

Result<TableRows> TableRows::FromMemory(std::string name, std::string_view text,
                                        std::span<const ColumnName> names) {
  return Begin(LineReader::FromMemory(std::move(name), text), names);
}

Result<TableRows> TableRows::Begin(LineReader lines, std::span<const ColumnName> names) {
  TableRows rows(std::move(lines));
  std::string_view line;
  while (rows.lines_.Next(&line)) {
    if (!HoldsRow(line)) continue;
    rows.columns_ = CsvColumns(line, names);
    return rows;
  }
  if (!rows.lines_.status().ok()) return rows.lines_.status().error();
  return Error{ErrorCode::kBadData, rows.name() + ": holds no header line"};
}

Status TableRows::Require(std::span<const int> fields) const {
  std::string missing;
  for (const int field : fields) {
    if (Has(field)) continue;
    missing += (missing.empty() ? "" : ", ") + std::string(columns_.NameOf(field));
  }
  if (missing.empty()) return {};
  return Error{ErrorCode::kBadData,
               name() + ":" + std::to_string(line_number()) + ": the header line lacks " + missing};
}

bool TableRows::Next() {
  if (!report_.problems.empty()) return false;
  std::string_view line;
  while (lines_.Next(&line)) {
    if (!HoldsRow(line)) continue;
    columns_.Split(line, false, &row_);
    if (row_.cell_count < columns_.column_count()) {
      report_.Skip(lines_.line_number(), 0,
                   "the row has " + std::to_string(row_.cell_count) + " of " +
                       std::to_string(columns_.column_count()) + " columns");
      return false;
    }
    ++rows_;
    return true;
  }
  return false;
}

CsvCells TableRows::Cells() { return {columns_, row_, lines_.line_number(), &report_}; }

std::string_view TableRows::Text(int field) {
  const std::string_view text = MaybeText(field);
  if (text.empty()) Cells().Skip(field);
  return text;
}

std::string_view TableRows::MaybeText(int field) const { return TrimSpaces(row_[field]); }

double TableRows::Number(int field, double least, double most) {
  return Cells().RequiredDouble(field, least, most).value_or(0.0);
}

std::int64_t TableRows::Integer(int field, std::int64_t least, std::int64_t most) {
  return Cells().RequiredInteger(field, least, most).value_or(0);
}

std::optional<double> TableRows::MaybeNumber(int field, double least, double most) {
  return Has(field) ? Cells().Double(field, least, most) : std::nullopt;
}

void TableRows::Refuse(int field, std::string_view why) {
  report_.Skip(lines_.line_number(), row_.ColumnOf(field), why);
}

Status TableRows::status() const {
  if (!report_.problems.empty()) {
    return Error{ErrorCode::kBadData, FormatProblem(name(), report_.problems.front())};
  }
  return lines_.status();
}

}  // namespace lodemark
