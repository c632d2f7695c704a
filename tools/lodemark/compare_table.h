// The results table of compared runs, for the terminal and for the report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/lodemark/compare_statistics.h"
#include "tools/lodemark/text_table.h"

namespace lodemark {

struct ComparedRun {
  std::string name;
  std::string path;
  std::int64_t epochs_without_truth = 0;
  std::int64_t rows_skipped = 0;
  ErrorStatistics statistics;
};

TextTable CompareTable(const std::vector<ComparedRun>& runs);

// "12.34", or "12345" from a kilometre on.
std::string MetresText(double value);

}  // namespace lodemark
