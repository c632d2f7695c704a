// lodemark report: one HTML file that shows runs, with the truth where it is known.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "tools/lodemark/command.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/report_content.h"
#include "tools/lodemark/subcommands.h"
#include "tools/lodemark/truth.h"

namespace lodemark {
namespace {

struct ReportOptions {
  std::vector<std::string> runs;
  std::string out;
  std::string truth;
  std::string recording;
};

int RunReport(const ReportOptions& options) {
  std::optional<Truth> truth;
  if (!options.truth.empty()) {
    Result<Truth> read = ReadTruth(options.truth);
    if (!read) return ReportError(read.error());
    truth = std::move(read).value();
  }
  ProgressBar progress("Reading", StderrIsTerminal());
  const Result<ReportContent> content =
      GatherReport(options.runs, truth, options.recording, &progress);
  progress.Finish();
  if (!content) return ReportError(content.error());
  const std::string html = ReportHtml(content->report);
  const Status written = WriteFileWhole(options.out, html);
  if (!written.ok()) return ReportError(written.error());
  for (const std::string& remark : content->remarks) PrintMessage(remark);
  PrintResult(options.out + "  (" + GroupDigits(static_cast<std::int64_t>(html.size() / 1024)) +
              " KiB, open it in any browser)\n");
  if (!content->any_estimate) {
    PrintMessage("no run holds an estimate; see the status column of trajectory.csv");
    return kExitMissed;
  }
  return kExitGood;
}

}  // namespace

void AddReportCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "Draw runs on one self-contained HTML page");
  command->add_option("RUN", options->runs, "Folders that 'lodemark replay' wrote")->required();
  command->add_option("--out", options->out, "The page to write")->required();
  command->add_option("--truth", options->truth,
                      "truth.csv, one static point, or a recording folder that has one");
  command->add_option("--recording", options->recording,
                      "Where the photographs are, if the recording was moved since");
  command->callback([options, exit_code] { *exit_code = RunReport(*options); });
}

}  // namespace lodemark
