// lodemark map import: a feature map from a COLMAP model.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "core/base/units.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/map_commands.h"
#include "tools/mapping/colmap_map.h"

namespace lodemark {
namespace {

struct MapImportOptions {
  NewMapOptions map;
  ColmapMapInput input;
  double least_parallax_deg = 1.5;
};

int RunMapImport(const MapImportOptions& options) {
  ColmapMapInput input = options.input;
  const Result<FrameOptions> frame = FrameOptionsFrom(options.map);
  if (!frame) return ReportError(frame.error());
  input.frame = *frame;
  const Result<PlaceOptions> places = PlaceOptionsFrom(options.map);
  if (!places) return ReportError(places.error());
  input.places = *places;
  input.labels = {options.map.datum, options.map.epoch_year};
  input.triangulation.least_parallax_rad = options.least_parallax_deg * kRadiansPerDegree;
  if (input.database.empty()) {
    input.database = (std::filesystem::path(input.model) / "database.db").string();
  }
  Result<BuiltMap> built = ImportColmap(input, StageBars());
  if (!built) return ReportError(built.error());
  const std::string how = "lodemark " + VersionText() + " map import of COLMAP's " + input.model;
  return FinishMap(options.map, how, std::move(built).value());
}

}  // namespace

void AddMapImportCommand(CLI::App& map, int* exit_code) {
  const auto options = std::make_shared<MapImportOptions>();
  ColmapMapInput& input = options->input;
  CLI::App* command = map.add_subcommand("import", "Make a map of a COLMAP model");
  command->add_option("COLMAP_DIR", input.model, "Folder of the model, text or binary")->required();
  command->add_option("--database", input.database,
                      "database.db with the descriptors; default: in the folder");
  AddNewMapOptions(*command, &options->map);
  command->add_option("--gcp", input.control_points,
                      "csv: point and its place; also image,x_px,y_px unless --marks");
  command->add_option("--marks", input.marks, "csv: image,point,x_px,y_px");
  command->add_option("--image-gps", input.image_gps,
                      "Folder of the photographs, whose EXIF says where they were taken");
  command->add_option("--camera-positions", input.camera_positions,
                      "csv: name and the place of each camera on the earth");
  const auto sigma = [&](const char* name, double* value, const char* what) {
    command->add_option(name, *value, what)->check(CLI::PositiveNumber)->capture_default_str();
  };
  sigma("--gcp-sigma", &input.sigmas.survey_m, "Of ground control points that say none, in m");
  sigma("--mark-sigma", &input.sigmas.mark_px, "Of marks that say none, in pixels");
  sigma("--camera-sigma", &input.sigmas.camera_m, "Of camera positions that say none, in m");
  sigma("--gps-sigma", &input.sigmas.gps_horizontal_m, "Of EXIF positions east and north, in m");
  sigma("--gps-sigma-up", &input.sigmas.gps_vertical_m, "Of EXIF altitudes, in m");
  command
      ->add_option("--least-parallax", options->least_parallax_deg,
                   "Widest angle between a landmark's rays, in degrees")
      ->check(CLI::Range(0.1, 90.0))
      ->capture_default_str();
  command->callback([options, exit_code] { *exit_code = RunMapImport(*options); });
}

}  // namespace lodemark
