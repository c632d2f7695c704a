// What the command line says of a camera before its photograph is looked at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "lodemark/lodemark.h"

namespace CLI {
class App;
}

namespace lodemark {

struct ViewOptions {
  std::vector<double> near_geodetic;  // latitude, longitude in degrees, height in metres
  double near_sigma_m = 10.0;
  std::vector<double> up_in_camera;
  double up_sigma_deg = 1.0;
  std::optional<double> heading_deg;
  double heading_sigma_deg = 20.0;
};

// --near LAT,LON,HEIGHT --near-sigma M --up X,Y,Z --up-sigma DEG --heading DEG --heading-sigma DEG
void AddViewOptions(CLI::App& command, ViewOptions* options);

// The prior they make; nothing if none was given.
Result<std::optional<lodemark_view_prior>> PriorFrom(const ViewOptions& options);

}  // namespace lodemark
