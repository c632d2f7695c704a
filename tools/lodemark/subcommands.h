// The subcommands. Each Add function declares its options and, when the user chose it, runs the
// command and leaves the exit code behind.
#pragma once

namespace CLI {
class App;
}

namespace lodemark {

void AddCalibrateCommand(CLI::App& app, int* exit_code);
void AddCompareCommand(CLI::App& app, int* exit_code);
void AddLogCommand(CLI::App& app, int* exit_code);
void AddMapCommand(CLI::App& app, int* exit_code);
void AddReplayCommand(CLI::App& app, int* exit_code);
void AddReportCommand(CLI::App& app, int* exit_code);
void AddResectCommand(CLI::App& app, int* exit_code);
void AddSimulateCommand(CLI::App& app, int* exit_code);
void AddSkyCommand(CLI::App& app, int* exit_code);

}  // namespace lodemark
