// Folds satellites.csv into what the report draws: per signal, a fixed number of slices of time.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/lodemark/run_folder.h"
#include "tools/report/report.h"

namespace lodemark {

class ReportSignals {
 public:
  // Divides [first, last] into slices. Memory grows with signals times slices, not with rows.
  ReportSignals(std::int64_t first_gps_ns, std::int64_t last_gps_ns, std::size_t slices);

  void Add(const RunSignal& row);

  // Sorted by system, number and signal.
  std::vector<ReportSignal> Finish() const;

  // Rows of more signals than any receiver has, which were left out.
  std::int64_t rows_left_out() const { return rows_left_out_; }

 private:
  struct Mean {
    double sum = 0.0;
    int count = 0;
    void Add(double value) {
      sum += value;
      ++count;
    }
  };
  struct Track {
    ReportSignal signal;
    // Epochs per slice and state.
    std::vector<std::array<std::int32_t, kReportSignalStates>> states;
    std::vector<Mean> cn0;
    Mean all_cn0;
    double squared_residuals_m2 = 0.0;
    std::int64_t residuals = 0;
    std::map<std::string, std::int64_t, std::less<>> reasons;
  };

  std::int64_t first_gps_ns_;
  double span_ns_;
  std::size_t slices_;
  std::map<std::pair<std::string, std::string>, Track> tracks_;
  std::string satellite_;  // kept to look up without allocating
  std::string signal_;
  std::int64_t rows_left_out_ = 0;
};

}  // namespace lodemark
