#include "tools/lodemark/report_table.h"

#include <algorithm>
#include <iterator>

#include "tools/lodemark/command.h"

namespace lodemark {

TextTable UncheckedTable(const std::vector<RunFolder>& runs,
                         const std::vector<std::string>& names) {
  TextTable table(names);
  std::vector<std::string> expected, answered, coverage, accuracy;
  for (const RunFolder& run : runs) {
    std::vector<double> stated_m;
    std::int64_t count = 0;
    for (const TrajectoryPoint& epoch : run.epochs) {
      if (!epoch.has_position()) continue;
      ++count;
      if (epoch.accuracy_m) stated_m.push_back(*epoch.accuracy_m);
    }
    std::sort(stated_m.begin(), stated_m.end());
    expected.push_back(GroupDigits(static_cast<std::int64_t>(run.epochs.size())));
    answered.push_back(GroupDigits(count));
    coverage.push_back(Format(
        "%.1f", 100.0 * static_cast<double>(count) / static_cast<double>(run.epochs.size())));
    accuracy.push_back(stated_m.empty() ? "" : MetresText(SortedQuantile(stated_m, 0.5)));
  }
  table.AddSection("Coverage");
  table.AddRow("epochs expected", expected);
  table.AddRow("epochs answered", answered);
  table.AddRow("coverage", coverage, "%");
  table.AddSection("Stated accuracy");
  table.AddRow("median", accuracy, "m");
  return table;
}

TextTable CommonEpochsTable(const std::vector<RunErrors>& runs,
                            const std::vector<std::string>& names) {
  TextTable table(names);
  if (runs.size() < 2) return table;
  const auto times_of = [](const RunErrors& run) {
    std::vector<std::int64_t> times_gps_ns;
    for (const EpochError& error : run.errors) times_gps_ns.push_back(error.time_gps_ns);
    std::sort(times_gps_ns.begin(), times_gps_ns.end());
    return times_gps_ns;
  };
  std::vector<std::int64_t> common = times_of(runs.front());
  std::size_t most = common.size();
  for (const RunErrors& run : runs) {
    const std::vector<std::int64_t> times = times_of(run);
    most = std::max(most, times.size());
    std::vector<std::int64_t> both;
    std::set_intersection(common.begin(), common.end(), times.begin(), times.end(),
                          std::back_inserter(both));
    common = std::move(both);
  }
  // Where all answered everywhere, the rest of the table says it already.
  if (common.empty() || common.size() == most) return table;
  std::vector<std::string> p68, rmse, three_d;
  for (const RunErrors& run : runs) {
    std::vector<EpochError> errors;
    for (const EpochError& error : run.errors) {
      if (std::binary_search(common.begin(), common.end(), error.time_gps_ns)) {
        errors.push_back(error);
      }
    }
    const ErrorStatistics statistics =
        StatisticsOf(errors, static_cast<std::int64_t>(common.size()));
    p68.push_back(MetresText(statistics.horizontal_m.p68));
    rmse.push_back(MetresText(statistics.horizontal_m.rmse));
    const Spread& spread = statistics.three_d_m;
    three_d.push_back(spread.count > 0 ? MetresText(spread.rmse) : "");
  }
  table.AddSection("At the " + Counted(static_cast<std::int64_t>(common.size()), "epoch") +
                   " that all answered");
  table.AddRow("horizontal, 68 % below", p68, "m");
  table.AddRow("horizontal, RMSE", rmse, "m");
  table.AddRow("3D, RMSE", three_d, "m");
  return table;
}

void AddFigures(const std::vector<ComparedRun>& compared, const TextTable& table, Report* report) {
  const bool several = compared.size() > 1;
  for (std::size_t place = 0; place < compared.size(); ++place) {
    const ComparedRun& run = compared[place];
    const ErrorStatistics& s = run.statistics;
    if (s.horizontal_m.count > 0) {
      report->figures.push_back(
          {several ? run.name : "68 % of errors below", MetresText(s.horizontal_m.p68), "m",
           several ? "for 68 % of epochs, " + MetresText(s.horizontal_m.p95) + " m for 95 %"
                   : "horizontal",
           several ? std::optional<std::size_t>(place) : std::nullopt});
      if (!several) {
        report->figures.push_back(
            {"95 % of errors below", MetresText(s.horizontal_m.p95), "m", "horizontal"});
      }
    }
    if (several && s.horizontal_m.count > 0) continue;
    report->figures.push_back(
        {several ? run.name + ": coverage" : "Coverage", Format("%.1f", 100.0 * s.coverage()), "%",
         GroupDigits(s.answered_epochs) + " of " + Counted(s.expected_epochs, "epoch")});
    if (s.within_accuracy.of > 0) {
      report->figures.push_back({"Within stated accuracy",
                                 Format("%.0f", 100.0 * s.within_accuracy.value()), "%",
                                 "68 % is honest"});
    }
  }
  if (!compared.empty()) return;
  for (const char* label : {"coverage", "median"}) {
    for (const TextTable::Row& row : table.rows()) {
      if (row.label != label || row.values.front().empty()) continue;
      const bool coverage = row.label == "coverage";
      report->figures.push_back({coverage ? "Coverage" : "Stated accuracy", row.values.front(),
                                 row.unit, coverage ? "" : "median, no truth to check it"});
    }
  }
}

}  // namespace lodemark
