// Tropospheric delay from standard models.
#pragma once

#include <cstdint>

#include "core/geo/geodetic.h"

namespace lodemark {

// Weather at the antenna.
struct Meteorology {
  double pressure_hpa = 1013.25;
  double temperature_k = 288.15;
  double vapour_pressure_hpa = 8.5;
};

// Latitude- and season-dependent averages of RTCA DO-229 (UNB3), reduced to the height.
Meteorology ClimatologicalMeteorology(const Geodetic& place, std::int64_t time_gps_ns);

// ISO standard atmosphere at the height with the given relative humidity (0..1).
Meteorology StandardMeteorology(double height_m, double relative_humidity);

struct ZenithDelay {
  double hydrostatic_m = 0.0;
  double wet_m = 0.0;
};

ZenithDelay SaastamoinenZenithDelay(const Meteorology& weather, const Geodetic& place);
ZenithDelay HopfieldZenithDelay(const Meteorology& weather, const Geodetic& place);

struct MappingFactors {
  double hydrostatic = 1.0;
  double wet = 1.0;
};

// Niell's mapping functions (1996), height correction included. Elevation above -5 degrees is
// accepted; below 2 degrees the value at 2 degrees is returned.
MappingFactors NiellMapping(const Geodetic& place, double elevation_rad, std::int64_t time_gps_ns);

// Slant delay in metres: Saastamoinen zenith delays of the climatological weather, Niell mapping.
// sigma_m, if not null, receives the 1 sigma of what the model leaves.
double TroposphereDelay(const Geodetic& place, double elevation_rad, std::int64_t time_gps_ns,
                        double* sigma_m);

}  // namespace lodemark
