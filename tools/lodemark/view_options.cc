#include "tools/lodemark/view_options.h"

#include <CLI/CLI.hpp>
#include <cstring>

namespace lodemark {

void AddViewOptions(CLI::App& command, ViewOptions* options) {
  command
      .add_option(
          "--near", options->near_geodetic,
          "Where the camera is, as satellites say: LATITUDE,LONGITUDE,HEIGHT in degrees and "
          "metres")
      ->delimiter(',')
      ->expected(3);
  command
      .add_option("--near-sigma", options->near_sigma_m,
                  "Standard deviation of --near in metres, on each axis")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--up", options->up_in_camera,
                  "Up as the accelerometer feels it, in camera axes (x right, y down, z forward): "
                  "X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  command.add_option("--up-sigma", options->up_sigma_deg, "Standard deviation of --up in degrees")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--heading", options->heading_deg,
                     "Where the camera looks, in degrees clockwise from north; needs --near");
  command
      .add_option("--heading-sigma", options->heading_sigma_deg,
                  "Standard deviation of --heading in degrees")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

Result<std::optional<lodemark_view_prior>> PriorFrom(const ViewOptions& options) {
  lodemark_view_prior prior = {};
  prior.struct_size = sizeof prior;
  if (!options.near_geodetic.empty()) {
    prior.present |= LODEMARK_VIEW_HAS_POSITION;
    if (lodemark_ecef_from_geodetic(options.near_geodetic.data(), prior.position_in_ecef_m) !=
        LODEMARK_OK) {
      return Error{ErrorCode::kInvalidArgument, std::string("--near: ") + lodemark_last_error()};
    }
    for (const int i : {0, 4, 8}) {
      prior.position_covariance_enu_m2[i] = options.near_sigma_m * options.near_sigma_m;
    }
  }
  if (!options.up_in_camera.empty()) {
    prior.present |= LODEMARK_VIEW_HAS_GRAVITY;
    std::memcpy(prior.up_in_camera, options.up_in_camera.data(), sizeof prior.up_in_camera);
    prior.up_sigma_deg = options.up_sigma_deg;
  }
  if (options.heading_deg) {
    if (options.near_geodetic.empty()) {
      return Error{ErrorCode::kInvalidArgument, "--heading needs --near"};
    }
    prior.present |= LODEMARK_VIEW_HAS_HEADING;
    prior.heading_deg = *options.heading_deg;
    prior.heading_sigma_deg = options.heading_sigma_deg;
  }
  if (prior.present == 0) return std::optional<lodemark_view_prior>();
  return std::optional<lodemark_view_prior>(prior);
}

}  // namespace lodemark
