// lodemark log: what files hold, whether they are sound, and the same in RINEX 3.04.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/lodemark/command.h"
#include "tools/lodemark/log_commands.h"
#include "tools/lodemark/log_survey.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/subcommands.h"
#include "tools/lodemark/text_table.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// A folder stands for those of its files that are of a known kind.
Result<std::vector<std::string>> ExpandFolders(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> inside;
    for (fs::directory_iterator entry(path, failure), end; !failure && entry != end;
         entry.increment(failure)) {
      std::error_code ignored;
      if (!entry->is_regular_file(ignored)) continue;
      const Result<FileKind> kind = SniffFile(entry->path().string());
      if (kind && *kind != FileKind::kUnknown) inside.push_back(entry->path().string());
    }
    if (failure) return Error{ErrorCode::kIo, path + ": " + failure.message()};
    if (inside.empty()) {
      return Error{ErrorCode::kBadData, path + ": is a folder without any GNSS file in it"};
    }
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

std::string SpanText(const LogSurvey& survey) {
  if (!survey.first_gps_ns) return "no time";
  std::string text = CalendarText(*survey.first_gps_ns);
  if (*survey.last_gps_ns != *survey.first_gps_ns) {
    text += " to " + CalendarText(*survey.last_gps_ns);
  }
  text += " GPS time";
  if (survey.epochs > 0) {
    text += ", " + Counted(survey.epochs, "epoch");
  }
  if (survey.usual_interval_s > 0.0) text += Format(" every %.3g s", survey.usual_interval_s);
  return text;
}

std::string CountsText(const std::map<std::string, std::int64_t>& counts) {
  std::string text;
  for (const auto& [name, count] : counts) {
    text += (text.empty() ? "" : ", ") + GroupDigits(count) + " " + Printable(name);
  }
  return text;
}

std::string InfoText(const LogSurvey& survey, bool decorate) {
  std::string text =
      decorate ? "\033[1m" + Printable(survey.file) + "\033[0m\n" : Printable(survey.file) + "\n";
  text += "  " + Printable(survey.description) + "\n  " + SpanText(survey) + "\n";
  if (!survey.rows.empty()) text += "  rows: " + CountsText(survey.rows) + "\n";
  if (!survey.raw_outcomes.empty()) {
    text += "  raw measurements: " + CountsText(survey.raw_outcomes) + "\n";
  }
  if (survey.report.rows_skipped > 0) {
    text += "  malformed: " + Counted(survey.report.rows_skipped, "row") +
            ", see 'lodemark log check'\n";
  }
  for (const auto& [system, satellites] : survey.satellites) {
    text += "  " + std::string(1, SystemLetter(system)) + ": " + std::to_string(satellites.size()) +
            " satellites\n";
  }
  if (!survey.signals.empty()) {
    TextTable table({"satellites", "observed", "per epoch", "code", "phase", "C/N0"});
    for (const auto& [name, signal] : survey.signals) {
      const double observations = static_cast<double>(signal.observations);
      table.AddRow(
          SignalName(name.first, name.second),
          {std::to_string(signal.satellites.size()), GroupDigits(signal.observations),
           Format("%.1f",
                  observations / static_cast<double>(std::max<std::int64_t>(1, survey.epochs))),
           Format("%.0f %%", 100.0 * static_cast<double>(signal.with_code) / observations),
           Format("%.0f %%", 100.0 * static_cast<double>(signal.with_phase) / observations),
           signal.with_cn0 > 0
               ? Format("%.1f", signal.cn0_sum_dbhz / static_cast<double>(signal.with_cn0))
               : ""});
    }
    text += table.Text(decorate);
  }
  for (const std::string& fault : survey.faults) text += "  " + fault + "\n";
  return text;
}

ordered_json JsonOf(const LogSurvey& survey) {
  ordered_json json = {{"file", survey.file},
                       {"kind", RoleOf(survey.kind)},
                       {"description", survey.description},
                       {"epochs", survey.epochs}};
  if (survey.first_gps_ns) {
    json["first_gps_ns"] = *survey.first_gps_ns;
    json["last_gps_ns"] = *survey.last_gps_ns;
  }
  json["usual_interval_s"] = survey.usual_interval_s;
  json["rows"] = survey.rows;
  if (!survey.raw_outcomes.empty()) json["raw_measurements"] = survey.raw_outcomes;
  ordered_json signals = ordered_json::array();
  for (const auto& [name, signal] : survey.signals) {
    signals.push_back({{"system", std::string(1, SystemLetter(name.first))},
                       {"signal", std::string{name.second.band, name.second.attribute}},
                       {"satellites", signal.satellites.size()},
                       {"observations", signal.observations},
                       {"with_code", signal.with_code},
                       {"with_phase", signal.with_phase}});
  }
  json["signals"] = signals;
  for (const auto& [system, satellites] : survey.satellites) {
    json["satellites"][std::string(1, SystemLetter(system))] = satellites.size();
  }
  json["rows_skipped"] = survey.report.rows_skipped;
  json["rows_unknown"] = survey.report.rows_unknown;
  json["values_dropped"] = survey.report.values_dropped;
  json["backward_steps"] = survey.backward_steps;
  json["repeated_times"] = survey.repeated_times;
  json["problems"] = ordered_json::array();
  for (const ReadProblem& problem : survey.report.problems) {
    json["problems"].push_back(
        {{"line", problem.line}, {"column", problem.column}, {"message", problem.message}});
  }
  json["faults"] = survey.faults;
  return json;
}

std::string CheckText(const LogSurvey& survey) {
  std::string text;
  for (const ReadProblem& problem : survey.report.problems) {
    text += Printable(FormatProblem(survey.file, problem)) + "\n";
  }
  const std::int64_t met = survey.report.rows_skipped + survey.report.values_dropped;
  const auto kept = static_cast<std::int64_t>(survey.report.problems.size());
  if (met > kept) text += survey.file + ": and " + GroupDigits(met - kept) + " more\n";
  for (const std::string& fault : survey.faults) text += survey.file + ": " + fault + "\n";
  if (survey.backward_steps > 0) {
    text += survey.file + ": time runs backwards " + Counted(survey.backward_steps, "time") + "\n";
  }
  if (survey.repeated_times > 0) {
    text += survey.file + ": " + Counted(survey.repeated_times, "epoch") +
            " with the time of the one before\n";
  }
  if (survey.report.rows_unknown > 0) {
    text += survey.file + ": " + Counted(survey.report.rows_unknown, "row") +
            " of a kind we do not know passed over\n";
  }
  return text;
}

bool IsMalformed(const LogSurvey& survey) {
  return survey.report.rows_skipped > 0 || !survey.faults.empty();
}

std::string VerdictText(const LogSurvey& survey) {
  std::string text = survey.file + ": ";
  if (!survey.faults.empty()) {
    text += "of no use";
  } else if (survey.report.rows_skipped > 0) {
    text += "malformed: " + GroupDigits(survey.report.rows_skipped) + " of " +
            Counted(survey.report.rows_skipped + survey.report.rows_read, "row") +
            " skipped, the rest is usable";
  } else {
    text += "good: " + Counted(survey.report.rows_read, "row") + " read";
    if (survey.report.values_dropped > 0) {
      text += ", " + Counted(survey.report.values_dropped, "implausible value") + " left out";
    }
  }
  return text + "\n";
}

// Runs the survey over all files; every file that cannot be read is named, and the others still
// get their answer.
template <typename Function>
int ForEachFile(const LogOptions& options, Function report) {
  const Result<std::vector<std::string>> files = ExpandFolders(options.files);
  if (!files) return ReportError(files.error());
  int exit_code = kExitGood;
  ordered_json list = ordered_json::array();
  for (const std::string& file : *files) {
    ProgressBar progress("Reading", StderrIsTerminal());
    const Result<LogSurvey> survey =
        SurveyFile(file, [&](double share) { progress.Update(share); });
    progress.Finish();
    if (!survey) {
      exit_code = std::max(exit_code, ReportError(survey.error()));
      if (options.json) list.push_back({{"file", file}, {"error", survey.error().message}});
      continue;
    }
    if (options.json) list.push_back(JsonOf(*survey));
    exit_code = std::max(exit_code, report(*survey));
  }
  if (options.json) {
    PrintResult(list.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  }
  return exit_code;
}

}  // namespace

int RunLogInfo(const LogOptions& options) {
  return ForEachFile(options, [&](const LogSurvey& survey) -> int {
    if (!options.json) PrintResult(InfoText(survey, StdoutIsTerminal()));
    return survey.faults.empty() ? kExitGood : kExitInput;
  });
}

int RunLogCheck(const LogOptions& options) {
  return ForEachFile(options, [&](const LogSurvey& survey) -> int {
    if (!options.json) PrintResult(CheckText(survey) + VerdictText(survey));
    return IsMalformed(survey) ? kExitInput : kExitGood;
  });
}

void AddLogCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<LogOptions>();
  CLI::App* command = app.add_subcommand("log", "Look into, check and convert GNSS files");
  command->require_subcommand(1);
  const auto add = [&](const char* name, const char* what, int (*run)(const LogOptions&)) {
    CLI::App* one = command->add_subcommand(name, what);
    one->add_option("FILE", options->files, "Files, plain or gzip")->required();
    one->callback([options, exit_code, run] { *exit_code = run(*options); });
    return one;
  };
  for (CLI::App* one :
       {add("info", "What files hold: span, rows, signals", RunLogInfo),
        add("check", "Where files are malformed; exits with 2 if one is", RunLogCheck)}) {
    one->add_flag("--json", options->json, "Print JSON");
  }
  add("convert", "The same observations and ephemerides as RINEX 3.04", RunLogConvert)
      ->add_option("--out", options->out, "Folder to write to")
      ->required();
}

}  // namespace lodemark
