// A table for the terminal: labels on the left, one column of values per run.
#pragma once

#include <string>
#include <vector>

namespace lodemark {

class TextTable {
 public:
  explicit TextTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  void AddSection(std::string title);
  // As many values as there are columns; an empty one is printed as a dash.
  void AddRow(std::string label, std::vector<std::string> values, std::string unit = "");

  struct Row {
    bool section = false;
    std::string label;
    std::vector<std::string> values;
    std::string unit;
  };
  const std::vector<Row>& rows() const { return rows_; }

  // decorate: bold headings by terminal escapes.
  std::string Text(bool decorate) const;

 private:
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

// Width on a terminal of UTF-8 text, one cell per code point.
std::size_t DisplayWidth(const std::string& text);

// The text without control characters, so that a file's name or content cannot move the cursor.
std::string Printable(std::string_view text);

}  // namespace lodemark
