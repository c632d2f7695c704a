// What a reader met in a file: rows taken, rows skipped, and the first reasons with their place.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lodemark {

struct ReadProblem {
  std::int64_t line = 0;
  std::int32_t column = 0;  // from 1; 0 if the whole row is meant
  std::string message;
};

// "log.txt:17:42: svid '900' is not a satellite number"
std::string FormatProblem(const std::string& file, const ReadProblem& problem);

struct ReadReport {
  static constexpr std::size_t kKeptProblems = 20;

  std::string file;
  std::int64_t rows_read = 0;         // rows or records that were taken
  std::int64_t rows_skipped = 0;      // malformed ones
  std::int64_t rows_unknown = 0;      // of a kind this reader does not know
  std::int64_t values_dropped = 0;    // implausible ones inside rows that were taken
  std::vector<ReadProblem> problems;  // the first kKeptProblems

  // Counts a skipped row and keeps the reason while there is room.
  void Skip(std::int64_t line, std::int32_t column, std::string_view message);
  // The same for a value whose row was taken without it.
  void DropField(std::int64_t line, std::int32_t column, std::string_view message);
  // Whether a further reason is kept at all.
  bool has_room() const { return problems.size() < kKeptProblems; }
};

}  // namespace lodemark
