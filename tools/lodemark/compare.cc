// lodemark compare: how far runs were from the truth, and whether they knew it.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/lodemark/command.h"
#include "tools/lodemark/compare_statistics.h"
#include "tools/lodemark/compare_table.h"
#include "tools/lodemark/run_errors.h"
#include "tools/lodemark/run_folder.h"
#include "tools/lodemark/subcommands.h"
#include "tools/lodemark/truth.h"

namespace lodemark {
namespace {

struct CompareOptions {
  std::vector<std::string> runs;
  std::string truth;
  std::optional<double> limit_p68_m;
  bool json = false;
};

nlohmann::ordered_json JsonOf(const Spread& spread) {
  if (spread.count == 0) return nullptr;
  return {{"count", spread.count}, {"mean", spread.mean}, {"rmse", spread.rmse},
          {"p50", spread.p50},     {"p68", spread.p68},   {"p95", spread.p95},
          {"max", spread.max}};
}

nlohmann::ordered_json JsonOf(const Share& share) {
  if (share.of == 0) return nullptr;
  return {{"count", share.count}, {"of", share.of}, {"share", share.value()}};
}

nlohmann::ordered_json JsonOf(const ComparedRun& run) {
  const ErrorStatistics& s = run.statistics;
  return {{"run", run.path},
          {"expected_epochs", s.expected_epochs},
          {"answered_epochs", s.answered_epochs},
          {"coverage", s.coverage()},
          {"epochs_without_truth", run.epochs_without_truth},
          {"rows_skipped", run.rows_skipped},
          {"horizontal_m", JsonOf(s.horizontal_m)},
          {"up_m", JsonOf(s.up_m)},
          {"three_d_m", JsonOf(s.three_d_m)},
          {"horizontal_velocity_mps", JsonOf(s.horizontal_velocity_mps)},
          {"up_velocity_mps", JsonOf(s.up_velocity_mps)},
          {"stated_accuracy_m", JsonOf(s.stated_accuracy_m)},
          {"within_accuracy", JsonOf(s.within_accuracy)},
          {"beyond_3_sigma", JsonOf(s.beyond_3_sigma)},
          {"beyond_protection_level", JsonOf(s.beyond_protection)},
          {"beyond_vertical_protection_level", JsonOf(s.beyond_vertical_protection)}};
}

std::string JsonText(const std::vector<ComparedRun>& runs, const CompareOptions& options,
                     bool limit_missed) {
  nlohmann::ordered_json json = {{"truth", options.truth}};
  if (options.limit_p68_m) {
    json["limit_p68_m"] = *options.limit_p68_m;
    json["limit_missed"] = limit_missed;
  }
  json["runs"] = nlohmann::ordered_json::array();
  for (const ComparedRun& run : runs) json["runs"].push_back(JsonOf(run));
  // Bytes of a path that are not UTF-8 are replaced rather than fatal.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<std::vector<ComparedRun>> CompareAll(const CompareOptions& options, const Truth& truth) {
  const std::vector<std::string> names = RunNames(options.runs);
  std::vector<ComparedRun> compared;
  for (std::size_t i = 0; i < options.runs.size(); ++i) {
    const Result<RunFolder> run = ReadRunFolder(options.runs[i]);
    if (!run) return run.error();
    const Result<RunErrors> errors = ErrorsAgainst(*run, truth);
    if (!errors) return errors.error();
    compared.push_back({names[i], run->path, errors->epochs_without_truth,
                        run->trajectory_report.rows_skipped,
                        StatisticsOf(errors->errors, errors->expected_epochs)});
  }
  return compared;
}

void PrintRemarks(const std::vector<ComparedRun>& runs, const Truth& truth) {
  if (truth.report.rows_skipped > 0) {
    PrintMessage(Counted(truth.report.rows_skipped, "malformed row") + " skipped, the first is " +
                 FormatProblem(truth.file, truth.report.problems.front()));
  }
  for (const ComparedRun& run : runs) {
    if (run.rows_skipped > 0) {
      PrintMessage(run.path + ": " + Counted(run.rows_skipped, "malformed row") +
                   " of trajectory.csv skipped");
    }
    if (run.epochs_without_truth > 0) {
      PrintMessage(run.path + ": " + Counted(run.epochs_without_truth, "epoch") +
                   (run.epochs_without_truth == 1 ? " without truth does not count"
                                                  : " without truth do not count"));
    }
  }
}

int RunCompare(const CompareOptions& options) {
  const Result<Truth> truth = ReadTruth(options.truth);
  if (!truth) return ReportError(truth.error());
  const Result<std::vector<ComparedRun>> runs = CompareAll(options, *truth);
  if (!runs) return ReportError(runs.error());

  bool silent = false;
  bool limit_missed = false;
  for (const ComparedRun& run : *runs) {
    const Spread& horizontal = run.statistics.horizontal_m;
    if (horizontal.count == 0) silent = true;
    if (options.limit_p68_m && !(horizontal.count > 0 && horizontal.p68 <= *options.limit_p68_m)) {
      limit_missed = true;
    }
  }
  if (options.json) {
    PrintResult(JsonText(*runs, options, limit_missed));
  } else {
    PrintResult(CompareTable(*runs).Text(StdoutIsTerminal()));
  }
  FlushResults();
  PrintRemarks(*runs, *truth);
  for (const ComparedRun& run : *runs) {
    const Spread& horizontal = run.statistics.horizontal_m;
    if (horizontal.count == 0) {
      PrintMessage(run.path + ": holds no estimate; see the status column of its trajectory.csv");
    } else if (options.limit_p68_m && horizontal.p68 > *options.limit_p68_m) {
      PrintMessage(run.path + Format(": 68 %% of the errors lie below %.2f m, the limit is %.2f m",
                                     horizontal.p68, *options.limit_p68_m));
    }
  }
  return silent || limit_missed ? kExitMissed : kExitGood;
}

}  // namespace

void AddCompareCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Score runs against the truth");
  command->add_option("RUN", options->runs, "Folders that 'lodemark replay' wrote")->required();
  command
      ->add_option("--truth", options->truth,
                   "truth.csv, one static point, or a recording folder that has one")
      ->required();
  command
      ->add_option("--limit-p68", options->limit_p68_m,
                   "Exit with 3 if the 68 % horizontal error in metres is above this")
      ->check(CLI::PositiveNumber);
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, exit_code] { *exit_code = RunCompare(*options); });
}

}  // namespace lodemark
