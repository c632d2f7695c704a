// lodemark map build, import, query, info and check.
#pragma once

#include <string>

#include "core/base/result.h"
#include "tools/mapping/built_map.h"

namespace CLI {
class App;
}

namespace lodemark {

void AddMapBuildCommand(CLI::App& map, int* exit_code);
void AddMapImportCommand(CLI::App& map, int* exit_code);
void AddMapQueryCommand(CLI::App& map, int* exit_code);
void AddMapInfoCommand(CLI::App& map, int* exit_code);
void AddMapCheckCommand(CLI::App& map, int* exit_code);

// What build and import have in common.
struct NewMapOptions {
  std::string out;
  std::string origin;  // "latitude,longitude,height"
  bool local = false;
  std::string grid;
  std::string datum = "WGS 84";
  double epoch_year = 0.0;
  std::string keep;  // "20%"
  std::string provenance;
  bool overwrite = false;
  bool json = false;
};

void AddNewMapOptions(CLI::App& command, NewMapOptions* options);

// The options in their own types.
Result<FrameOptions> FrameOptionsFrom(const NewMapOptions& options);
Result<PlaceOptions> PlaceOptionsFrom(const NewMapOptions& options);

// A progress bar for each stage of the work, one after another.
StageProgress StageBars();

// Keeps what --keep says, writes the map and prints what it holds: the exit code.
int FinishMap(const NewMapOptions& options, const std::string& how, BuiltMap built);

}  // namespace lodemark
