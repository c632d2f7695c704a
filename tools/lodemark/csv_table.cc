#include "tools/lodemark/csv_table.h"

#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

void Split(std::string_view line, std::vector<std::string_view>* fields) {
  fields->clear();
  std::size_t start = 0;
  while (true) {
    const std::size_t comma = line.find(',', start);
    fields->push_back(TrimSpaces(line.substr(start, comma - start)));
    if (comma == std::string_view::npos) return;
    start = comma + 1;
  }
}

bool HoldsRow(std::string_view line) {
  const std::string_view text = TrimSpaces(line);
  return !text.empty() && text.front() != '#';
}

}  // namespace

Result<CsvTable> CsvTable::Open(const std::string& path,
                                std::initializer_list<std::string_view> required) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return From(std::move(lines).value(), required);
}

Result<CsvTable> CsvTable::From(LineReader lines,
                                std::initializer_list<std::string_view> required) {
  CsvTable table(std::move(lines));
  const std::string path = table.lines_.name();
  table.report_.file = path;
  std::string_view line;
  bool found = false;
  while (!found && table.lines_.Next(&line)) found = HoldsRow(line);
  if (!table.lines_.status().ok()) return table.lines_.status().error();
  if (!found) return Error{ErrorCode::kBadData, path + ": holds no header line"};
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  std::vector<std::string_view> names;
  Split(line, &names);
  table.names_.assign(names.begin(), names.end());
  for (const std::string_view name : required) {
    if (table.Column(name) < 0) {
      return Error{ErrorCode::kBadData, path + ":" + std::to_string(table.lines_.line_number()) +
                                            ": the header line has no column '" +
                                            std::string(name) + "'"};
    }
  }
  return table;
}

int CsvTable::Column(std::string_view name) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] == name) return static_cast<int>(i);
  }
  return -1;
}

bool CsvTable::Next() {
  while (lines_.Next(&line_)) {
    if (!HoldsRow(line_)) continue;
    Split(line_, &fields_);
    ++report_.rows_read;
    return true;
  }
  return false;
}

std::string_view CsvTable::Text(int column) const {
  if (column < 0 || static_cast<std::size_t>(column) >= fields_.size()) return {};
  return fields_[static_cast<std::size_t>(column)];
}

std::optional<double> CsvTable::Number(int column) const { return ParseDouble(Text(column)); }

std::optional<std::int64_t> CsvTable::Integer(int column) const {
  return ParseInteger(Text(column));
}

void CsvTable::Skip(int column, std::string_view message) {
  --report_.rows_read;
  std::int32_t character = 0;
  if (column >= 0 && static_cast<std::size_t>(column) < fields_.size()) {
    std::size_t start = 0;
    for (int i = 0; i < column; ++i) start = line_.find(',', start) + 1;
    character = static_cast<std::int32_t>(start) + 1;
  }
  report_.Skip(lines_.line_number(), character, message);
}

}  // namespace lodemark
