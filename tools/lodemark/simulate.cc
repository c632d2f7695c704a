// lodemark simulate: makes a recording of a phone that was never there, with its truth.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/lodemark/command.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/subcommands.h"
#include "tools/simulator/photo_files.h"
#include "tools/simulator/recording.h"
#include "tools/simulator/scenario.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestScenario_bytes = 1 << 20;

struct SimulateOptions {
  std::string scenario;
  std::string preset;
  std::string out;
  std::optional<std::uint64_t> seed;
};

// A folder that is missing, empty, or holds an earlier simulation may be written to. Anything else
// may be somebody's only copy.
Status CheckFolder(const std::string& path) {
  std::error_code failure;
  if (!fs::exists(path, failure)) return {};
  if (!fs::is_directory(path, failure)) {
    return Error{ErrorCode::kIo, path + ": is a file; name a folder for the recording"};
  }
  const bool empty = fs::is_empty(path, failure);
  if (failure) return Error{ErrorCode::kIo, path + ": " + failure.message()};
  if (empty) return {};
  const Result<std::string> manifest =
      ReadFileWhole((fs::path(path) / "manifest.json").string(), kLargestScenario_bytes);
  if (manifest) {
    const nlohmann::json json = nlohmann::json::parse(*manifest, nullptr, false);
    if (json.is_object() && json.value("simulated", nlohmann::json(false)) == true) return {};
  }
  return Error{ErrorCode::kIo,
               path + ": holds files that are no simulation; name a new or empty folder"};
}

Result<Scenario> ScenarioOf(const SimulateOptions& options) {
  Result<Scenario> scenario = Error{};
  if (!options.preset.empty()) {
    scenario = PresetScenario(options.preset);
  } else {
    const Result<std::string> text = ReadFileWhole(options.scenario, kLargestScenario_bytes);
    if (!text) return text.error();
    scenario = ScenarioFromJson(options.scenario, *text);
  }
  if (scenario && options.seed) scenario->seed = *options.seed;
  return scenario;
}

int RunSimulate(const SimulateOptions& options) {
  if (options.scenario.empty() == options.preset.empty()) {
    PrintMessage("name either a SCENARIO.json or --preset static|walk");
    return kExitUsage;
  }
  const Result<Scenario> scenario = ScenarioOf(options);
  if (!scenario) return ReportError(scenario.error());
  const Status folder = CheckFolder(options.out);
  if (!folder.ok()) return ReportError(folder.error());

  ProgressBar progress("Simulating", StderrIsTerminal());
  RecordingFiles files = MakeRecording(*scenario, [&](double share) { progress.Update(share); });
  progress.Finish();
  if (!scenario->photography.groups.empty()) {
    ProgressBar photos_progress("Photographing", StderrIsTerminal());
    Result<RecordingFiles> photos =
        MakePhotos(*scenario, [&](double share) { photos_progress.Update(share); });
    photos_progress.Finish();
    if (!photos) {
      return ReportError({photos.error().code, options.scenario + ": " + photos.error().message});
    }
    files.merge(std::move(photos).value());
  }

  std::error_code failure;
  fs::create_directories(options.out, failure);
  if (failure) return ReportError({ErrorCode::kIo, options.out + ": " + failure.message()});
  std::size_t bytes = 0;
  for (const auto& [name, content] : files) {
    const fs::path path = fs::path(options.out) / name;
    fs::create_directories(path.parent_path(), failure);
    if (failure) {
      return ReportError({ErrorCode::kIo, path.parent_path().string() + ": " + failure.message()});
    }
    const Status written = WriteFileWhole(path.string(), content);
    if (!written.ok()) return ReportError(written.error());
    bytes += content.size();
  }
  PrintResult(options.out + Format("  (%d epochs, %zu files, ", scenario->epochs, files.size()) +
              GroupDigits(static_cast<std::int64_t>(bytes / 1024)) + " KiB)\n");
  return kExitGood;
}

}  // namespace

void AddSimulateCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command =
      app.add_subcommand("simulate", "Make a recording, labelled simulated, with its truth");
  command->add_option("SCENARIO", options->scenario, "Scenario as JSON (docs/formats.md)");
  command->add_option("--preset", options->preset, "A ready scenario: static or walk");
  command->add_option("--out", options->out, "Folder for the recording")->required();
  command->add_option("--seed", options->seed, "In place of the scenario's own");
  command->callback([options, exit_code] { *exit_code = RunSimulate(*options); });
}

}  // namespace lodemark
