#include "core/logs/read_report.h"

namespace lodemark {

std::string FormatProblem(const std::string& file, const ReadProblem& problem) {
  std::string text = file;
  if (problem.line > 0) text += ":" + std::to_string(problem.line);
  if (problem.line > 0 && problem.column > 0) text += ":" + std::to_string(problem.column);
  return text + ": " + problem.message;
}

void ReadReport::Skip(std::int64_t line, std::int32_t column, std::string_view message) {
  ++rows_skipped;
  if (has_room()) problems.push_back({line, column, std::string(message)});
}

void ReadReport::DropField(std::int64_t line, std::int32_t column, std::string_view message) {
  ++values_dropped;
  if (has_room()) problems.push_back({line, column, std::string(message)});
}

}  // namespace lodemark
