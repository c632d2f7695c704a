#include "tools/lodemark/report_signals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lodemark {
namespace {

RunSignal Row(std::int64_t time_ns, bool used, std::string_view reason) {
  RunSignal row;
  row.time_gps_ns = time_ns;
  row.satellite = "G07";
  row.signal = "1C";
  row.used = used;
  row.reason = reason;
  return row;
}

TEST(ReportSignals, CountsWhatBecameOfASignal) {
  ReportSignals signals(0, 9, 2);
  signals.Add(Row(0, true, "used"));
  signals.Add(Row(1, true, "down_weighted"));
  signals.Add(Row(2, true, "used"));
  signals.Add(Row(7, false, "outlier"));
  signals.Add(Row(8, false, "low_elevation"));
  signals.Add(Row(9, false, "low_elevation"));
  const std::vector<ReportSignal> drawn = signals.Finish();
  ASSERT_EQ(drawn.size(), 1u);
  EXPECT_EQ(drawn[0].seen, 6);
  EXPECT_EQ(drawn[0].used, 3);
  EXPECT_EQ(drawn[0].down_weighted, 1);
  EXPECT_EQ(drawn[0].rejected, 1);
  EXPECT_EQ(drawn[0].main_reason, "low_elevation");
  EXPECT_EQ(drawn[0].states[0], ReportSignalState::kUsed);
  EXPECT_EQ(drawn[0].states[1], ReportSignalState::kUnusable);
}

TEST(ReportSignals, SummarisesStrengthAndResiduals) {
  ReportSignals signals(0, 9, 1);
  RunSignal row = Row(0, true, "used");
  row.cn0_dbhz = 40.0;
  row.residual_m = 3.0;
  signals.Add(row);
  row.cn0_dbhz = 44.0;
  row.residual_m = -4.0;
  signals.Add(row);
  const std::vector<ReportSignal> drawn = signals.Finish();
  EXPECT_DOUBLE_EQ(*drawn[0].mean_cn0_dbhz, 42.0);
  EXPECT_DOUBLE_EQ(*drawn[0].rms_residual_m, std::sqrt(12.5));
}

TEST(ReportSignals, StaysSmallWhateverTheFileNames) {
  ReportSignals signals(0, 9, 4);
  for (int i = 0; i < 5000; ++i) {
    const std::string name = "X" + std::to_string(i);
    RunSignal row = Row(1, true, "used");
    row.satellite = name;
    signals.Add(row);
  }
  EXPECT_LE(signals.Finish().size(), 1000u);
  EXPECT_EQ(signals.rows_left_out(), 4000);
}

TEST(ReportSignals, IgnoresRowsOutsideTheSpan) {
  ReportSignals signals(100, 200, 4);
  signals.Add(Row(99, true, "used"));
  signals.Add(Row(201, true, "used"));
  EXPECT_TRUE(signals.Finish().empty());
}

}  // namespace
}  // namespace lodemark
