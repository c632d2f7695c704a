// lodemark map: feature maps made, looked into and checked.
#include <CLI/CLI.hpp>

#include "tools/lodemark/map_commands.h"
#include "tools/lodemark/subcommands.h"

namespace lodemark {

void AddMapCommand(CLI::App& app, int* exit_code) {
  CLI::App* command = app.add_subcommand("map", "Make, look into and check feature maps");
  command->require_subcommand(1);
  AddMapBuildCommand(*command, exit_code);
  AddMapImportCommand(*command, exit_code);
  AddMapQueryCommand(*command, exit_code);
  AddMapInfoCommand(*command, exit_code);
  AddMapCheckCommand(*command, exit_code);
}

}  // namespace lodemark
