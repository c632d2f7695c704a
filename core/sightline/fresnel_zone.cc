#include "core/sightline/fresnel_zone.h"

#include <algorithm>
#include <cmath>

namespace lodemark {

double FirstFresnelRadius(double wavelength_m, double distance_m, double path_length_m) {
  // The share of the path that is left, 1 if it has no end.
  const double left = std::isinf(path_length_m) ? 1.0 : 1.0 - distance_m / path_length_m;
  return std::sqrt(std::max(0.0, wavelength_m * distance_m * left));
}

}  // namespace lodemark
