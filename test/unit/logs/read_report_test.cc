#include "core/logs/read_report.h"

#include <gtest/gtest.h>

namespace lodemark {
namespace {

TEST(ReadReport, NamesFileLineAndColumnAsFarAsKnown) {
  EXPECT_EQ(FormatProblem("log.txt", {17, 42, "no number"}), "log.txt:17:42: no number");
  EXPECT_EQ(FormatProblem("log.txt", {17, 0, "too short"}), "log.txt:17: too short");
  EXPECT_EQ(FormatProblem("log.txt", {0, 0, "no Raw row"}), "log.txt: no Raw row");
}

TEST(ReadReport, CountsAllSkippedRowsButKeepsTheFirstReasons) {
  ReadReport report;
  for (int i = 1; i <= 1000; ++i) report.Skip(i, 0, "bad");
  EXPECT_EQ(report.rows_skipped, 1000);
  ASSERT_EQ(report.problems.size(), ReadReport::kKeptProblems);
  EXPECT_EQ(report.problems.front().line, 1);
}

}  // namespace
}  // namespace lodemark
