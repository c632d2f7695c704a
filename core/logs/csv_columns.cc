#include "core/logs/csv_columns.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

// Loggers write Float.MAX_VALUE (3.4e38) and Double.MAX_VALUE (1.8e308) where a chip has no value.
constexpr double kSentinel = 1e30;

// Enough of a malformed cell to recognise it in a message.
constexpr std::size_t kQuotedLength = 24;

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool SameName(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return Lower(x) == Lower(y); });
}

bool IsSentinel(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop == end && error == std::errc()) return !(std::abs(value) < kSentinel);
  return SameName(text, "null");
}

std::string Quoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text.substr(0, kQuotedLength)) quoted += c >= ' ' && c <= '~' ? c : '?';
  return quoted + (text.size() > kQuotedLength ? "...'" : "'");
}

std::optional<double> DoubleIn(std::string_view text, double least, double most) {
  if (text.empty()) return std::nullopt;
  const std::optional<double> value = ParseDouble(text);
  return value && *value >= least && *value <= most ? value : std::nullopt;
}

std::optional<std::int64_t> IntegerIn(std::string_view text, std::int64_t least,
                                      std::int64_t most) {
  if (text.empty()) return std::nullopt;
  const std::optional<std::int64_t> value = ParseIntegerLoosely(text);
  return value && *value >= least && *value <= most ? value : std::nullopt;
}

}  // namespace

std::int32_t CsvRow::ColumnOf(int field) const {
  const std::string_view cell = (*this)[field];
  return cell.data() == nullptr ? 0 : static_cast<std::int32_t>(cell.data() - line.data()) + 1;
}

CsvColumns::CsvColumns(std::string_view header, std::span<const ColumnName> names) : names_(names) {
  for (const ColumnName& name : names) field_count_ = std::max(field_count_, name.field + 1);
  field_of_column_.fill(kPassOver);
  while (column_count_ < kMostCsvColumns) {
    const std::size_t comma = header.find(',');
    const std::string_view name = TrimSpaces(header.substr(0, comma));
    const auto known = std::find_if(names.begin(), names.end(),
                                    [&](const ColumnName& n) { return SameName(n.name, name); });
    if (known != names.end()) {
      field_of_column_[static_cast<std::size_t>(column_count_)] =
          static_cast<std::uint8_t>(known->field);
    }
    ++column_count_;
    if (comma == std::string_view::npos) break;
    header.remove_prefix(comma + 1);
  }
}

bool CsvColumns::Has(int field) const {
  const auto end = field_of_column_.begin() + column_count_;
  return std::find(field_of_column_.begin(), end, field) != end;
}

void CsvColumns::Split(std::string_view line, bool may_be_cut, CsvRow* row) const {
  row->line = line;
  std::fill_n(row->cells.begin(), field_count_, std::string_view());
  const char* cell = line.data();
  const char* const end = cell + line.size();
  int column = 0;
  for (; column < column_count_; ++column) {
    const char* stop = cell;
    while (stop != end && *stop != ',') ++stop;
    const std::uint8_t field = field_of_column_[static_cast<std::size_t>(column)];
    std::string_view* last = nullptr;
    if (field != kPassOver && row->cells[field].empty()) {
      last = &row->cells[field];
      *last = std::string_view(cell, static_cast<std::size_t>(stop - cell));
    }
    if (stop == end) {
      row->cell_count = column + 1;
      if (last != nullptr && (may_be_cut || row->cell_count < column_count_)) {
        *last = std::string_view();
      }
      return;
    }
    cell = stop + 1;
  }
  row->cell_count = column;
}

std::string_view CsvColumns::NameOf(int field) const {
  const auto name = std::find_if(names_.begin(), names_.end(),
                                 [field](const ColumnName& n) { return n.field == field; });
  return name != names_.end() ? name->name : std::string_view();
}

std::optional<double> CsvCells::Double(int field, double least, double most) const {
  const std::optional<double> value = DoubleIn(row_[field], least, most);
  if (!value) Drop(field);
  return value;
}

std::optional<std::int64_t> CsvCells::Integer(int field, std::int64_t least,
                                              std::int64_t most) const {
  const std::optional<std::int64_t> value = IntegerIn(row_[field], least, most);
  if (!value) Drop(field);
  return value;
}

std::optional<double> CsvCells::RequiredDouble(int field, double least, double most) const {
  const std::optional<double> value = DoubleIn(row_[field], least, most);
  if (!value) Skip(field);
  return value;
}

std::optional<std::int64_t> CsvCells::RequiredInteger(int field, std::int64_t least,
                                                      std::int64_t most) const {
  const std::optional<std::int64_t> value = IntegerIn(row_[field], least, most);
  if (!value) Skip(field);
  return value;
}

bool CsvCells::IsNone(int field) const {
  const std::string_view text = TrimSpaces(row_[field]);
  return text.empty() || IsSentinel(text);
}

void CsvCells::Drop(int field) const {
  if (IsNone(field)) return;
  std::string message;
  if (report_->has_room()) {
    message = std::string(columns_.NameOf(field)) + " " + Quoted(TrimSpaces(row_[field])) +
              " is no plausible value";
  }
  report_->DropField(line_number_, row_.ColumnOf(field), message);
}

void CsvCells::Skip(int field) const {
  std::string message;
  if (report_->has_room()) {
    const std::string_view text = TrimSpaces(row_[field]);
    message = std::string(columns_.NameOf(field));
    if (!text.empty()) {
      message += " " + Quoted(text) + " is no plausible value";
    } else if (!columns_.Has(field)) {
      message += " has no column in the header";
    } else if (row_.cell_count < columns_.column_count()) {
      message += " is missing: the row has " + std::to_string(row_.cell_count) + " of " +
                 std::to_string(columns_.column_count()) + " columns";
    } else {
      message += " is missing";
    }
  }
  report_->Skip(line_number_, row_.ColumnOf(field), message);
}

}  // namespace lodemark
