// The lodemark command: picks the subcommand, and turns whatever happens into an exit code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "tools/lodemark/command.h"
#include "tools/lodemark/subcommands.h"

namespace lodemark {
namespace {

// Says what is wrong with the command line and where to read more.
int RefuseUsage(CLI::App& app, const CLI::ParseError& error, const std::string& command) {
  const bool known =
      !app.get_subcommands([&](CLI::App* one) { return one->get_name() == command; }).empty();
  if (known || command.empty() || command.front() == '-') {
    PrintMessage(error.what());
  } else {
    PrintMessage("'" + command + "' is no command of lodemark");
  }
  PrintMessage(known ? "see 'lodemark " + command + " --help'" : "see 'lodemark --help'");
  return kExitUsage;
}

int Run(int argument_count, char** arguments) {
  CLI::App app{"Lodemark: where a phone is, from its own logs.", "lodemark"};
  app.set_version_flag("--version", "lodemark " + VersionText());
  app.require_subcommand(1);

  int exit_code = kExitGood;
  AddCalibrateCommand(app, &exit_code);
  AddCompareCommand(app, &exit_code);
  AddLogCommand(app, &exit_code);
  AddMapCommand(app, &exit_code);
  AddReplayCommand(app, &exit_code);
  AddReportCommand(app, &exit_code);
  AddResectCommand(app, &exit_code);
  AddSimulateCommand(app, &exit_code);
  AddSkyCommand(app, &exit_code);

  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return RefuseUsage(app, error, argument_count > 1 ? arguments[1] : "");
  }
  if (!FlushResults()) {
    PrintMessage("standard output could not be written completely");
    return kExitInput;
  }
  return exit_code;
}

}  // namespace
}  // namespace lodemark

int main(int argument_count, char** arguments) {
  try {
    return lodemark::Run(argument_count, arguments);
  } catch (const std::bad_alloc&) {
    lodemark::PrintMessage("out of memory; give it fewer or smaller files");
    return lodemark::kExitInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lodemark: this is a bug in lodemark, please report it: %s\n",
                 error.what());
  } catch (...) {
    std::fprintf(stderr, "lodemark: this is a bug in lodemark, please report it\n");
  }
  return lodemark::kExitBug;
}
