#include "tools/lodemark/text_table.h"

#include <algorithm>

namespace lodemark {
namespace {

constexpr const char* kBold = "\033[1m";
constexpr const char* kFaint = "\033[2m";
constexpr const char* kPlain = "\033[0m";

std::string PadLeft(const std::string& text, std::size_t width) {
  const std::size_t own = DisplayWidth(text);
  return own < width ? std::string(width - own, ' ') + text : text;
}

std::string PadRight(const std::string& text, std::size_t width) {
  const std::size_t own = DisplayWidth(text);
  return own < width ? text + std::string(width - own, ' ') : text;
}

}  // namespace

std::size_t DisplayWidth(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
  }));
}

std::string Printable(std::string_view text) {
  std::string clean(text);
  for (char& c : clean) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (byte < 0x20u || byte == 0x7Fu) c = '?';
  }
  return clean;
}

void TextTable::AddSection(std::string title) { rows_.push_back({true, std::move(title), {}, {}}); }

void TextTable::AddRow(std::string label, std::vector<std::string> values, std::string unit) {
  rows_.push_back({false, std::move(label), std::move(values), std::move(unit)});
}

std::string TextTable::Text(bool decorate) const {
  std::size_t label_width = 0;
  std::vector<std::size_t> widths;
  for (const std::string& column : columns_) {
    widths.push_back(std::max<std::size_t>(DisplayWidth(column), 8));
  }
  for (const Row& row : rows_) {
    label_width = std::max(label_width, DisplayWidth(row.label) + (row.section ? 0 : 2));
    for (std::size_t i = 0; i < row.values.size() && i < widths.size(); ++i) {
      widths[i] = std::max(widths[i], DisplayWidth(row.values[i]));
    }
  }
  const std::string bold = decorate ? kBold : "";
  const std::string faint = decorate ? kFaint : "";
  const std::string plain = decorate ? kPlain : "";

  std::string text = std::string(label_width, ' ');
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    text += "   " + bold + PadLeft(columns_[i], widths[i]) + plain;
  }
  text += '\n';
  for (const Row& row : rows_) {
    if (row.section) {
      text += '\n' + bold + row.label + plain + '\n';
      continue;
    }
    text += "  " + PadRight(row.label, label_width - 2);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const bool known = i < row.values.size() && !row.values[i].empty();
      text += "   " + PadLeft(known ? row.values[i] : "–", widths[i]);
    }
    if (!row.unit.empty()) text += " " + faint + row.unit + plain;
    text += '\n';
  }
  return text;
}

}  // namespace lodemark
