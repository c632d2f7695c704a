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

// Latitude- and season-dependent averages of RTCA DO-229D A.4.2.4 (UNB3), reduced to the height.
// The model's heights are above sea level; the height above the ellipsoid that is used instead
// makes at most 1 % of pressure.
Meteorology ClimatologicalMeteorology(const Geodetic& place, std::int64_t time_gps_ns);

// ISO standard atmosphere at the height with the given relative humidity (0..1).
Meteorology StandardMeteorology(double height_m, double relative_humidity);

struct ZenithDelay {
  double hydrostatic_m = 0.0;
  double wet_m = 0.0;
};

// Saastamoinen (1972) with the gravity of Davis et al. (1985).
ZenithDelay SaastamoinenZenithDelay(const Meteorology& weather, const Geodetic& place);
// Hopfield (1969): two quartic layers above the antenna.
ZenithDelay HopfieldZenithDelay(const Meteorology& weather);

struct MappingFactors {
  double hydrostatic = 1.0;
  double wet = 1.0;
};

// Slant delay by Saastamoinen's own closed form, with the B of his table and without the small
// term for the bent ray: (P + (1255 / T + 0.05) e - B tan^2 z) 0.002277 / cos z. Elevations below
// 3 degrees count as 3 degrees.
double SaastamoinenSlantDelay(const Meteorology& weather, double height_m, double elevation_rad);

// Niell's mapping functions (1996) at a place and time, height correction included. What depends
// on the place is computed once, so that a satellite costs two fractions.
class NiellMapping {
 public:
  NiellMapping() = default;
  NiellMapping(const Geodetic& place, std::int64_t time_gps_ns);

  // Below 2 degrees the value at 2 degrees is returned.
  MappingFactors At(double elevation_rad) const;

 private:
  struct Fraction {
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
  };
  static double Map(const Fraction& fraction, double sin_elevation);

  Fraction hydrostatic_;
  Fraction wet_;
  double height_km_ = 0.0;
};

// Everything about the troposphere above one place at one time: Saastamoinen zenith delays of the
// climatological weather, Niell mapping. Make one per epoch and ask it for every satellite.
class Troposphere {
 public:
  Troposphere() = default;
  Troposphere(const Geodetic& place, std::int64_t time_gps_ns);

  const ZenithDelay& zenith() const { return zenith_; }
  MappingFactors Mapping(double elevation_rad) const { return mapping_.At(elevation_rad); }

  // Slant delay in metres. sigma_m, if not null, receives the 1 sigma of what the model leaves.
  double Delay(double elevation_rad, double* sigma_m) const;

 private:
  ZenithDelay zenith_;
  NiellMapping mapping_;
};

// The same for a single satellite.
double TroposphereDelay(const Geodetic& place, double elevation_rad, std::int64_t time_gps_ns,
                        double* sigma_m);

}  // namespace lodemark
