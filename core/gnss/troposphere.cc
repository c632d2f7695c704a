#include "core/gnss/troposphere.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"

namespace lodemark {
namespace {

constexpr double kDaysPerYear = 365.25;

// Heights a receiver can have; the models' formulas end not far beyond.
constexpr double kLowest_m = -1'000.0;
constexpr double kHighest_m = 15'000.0;

// What is left of the zenith delay: 5 mm of pressure, and of the wet part a third, which is 4 cm
// as DO-229D's 12 cm bound on the whole (J.2.4) at three sigma.
constexpr double kHydrostaticSigma_m = 0.010;
constexpr double kWetShare = 0.33;
constexpr double kLeastWetSigma_m = 0.020;

double DayOfYear(std::int64_t time_gps_ns) {
  const CalendarTime calendar = CalendarFromNanoseconds(std::max<std::int64_t>(time_gps_ns, 0));
  const std::optional<std::int64_t> new_year_ns =
      NanosecondsFromCalendar({calendar.year, 1, 1, 0, 0, 0.0});
  return 1.0 +
         1e-9 * static_cast<double>(time_gps_ns - new_year_ns.value_or(time_gps_ns)) / 86'400.0;
}

// Position in tables for latitudes 15, 30, 45, 60, 75 degrees, held outside.
struct TablePlace {
  std::size_t row = 0;
  double fraction = 0.0;

  double Of(const std::array<double, 5>& column) const {
    return column[row] + fraction * (column[row + 1] - column[row]);
  }
};

TablePlace PlaceInTable(double latitude_rad) {
  const double steps =
      std::clamp((std::abs(latitude_rad) * kDegreesPerRadian - 15.0) / 15.0, 0.0, 4.0);
  const double row = std::min(std::floor(steps), 3.0);
  return {static_cast<std::size_t>(row), steps - row};
}

// Cosine of the season: 1 in midwinter, on day 28 in the north and day 211 in the south.
double Winter(double latitude_rad, double day_of_year, double southern_day) {
  const double midwinter = latitude_rad >= 0.0 ? 28.0 : southern_day;
  return std::cos(2.0 * kPi * (day_of_year - midwinter) / kDaysPerYear);
}

// RTCA DO-229D tables A-2: average, and seasonal variation.
struct Climate {
  std::array<double, 5> average;
  std::array<double, 5> variation;

  double At(const TablePlace& place, double winter) const {
    return place.Of(average) - place.Of(variation) * winter;
  }
};

constexpr Climate kPressure_hpa = {{1013.25, 1017.25, 1015.75, 1011.75, 1013.00},
                                   {0.0, -3.75, -2.25, -1.75, -0.50}};
constexpr Climate kTemperature_k = {{299.65, 294.15, 283.15, 272.15, 263.65},
                                    {0.0, 7.0, 11.0, 15.0, 14.5}};
constexpr Climate kVapourPressure_hpa = {{26.31, 21.79, 11.66, 6.78, 4.11},
                                         {0.0, 8.85, 7.24, 5.36, 3.39}};
constexpr Climate kLapseRate_kpm = {{6.30e-3, 6.05e-3, 5.58e-3, 5.39e-3, 4.53e-3},
                                    {0.0, 0.25e-3, 0.32e-3, 0.81e-3, 0.62e-3}};
constexpr Climate kVapourLapse = {{2.77, 3.15, 2.57, 1.81, 1.55}, {0.0, 0.33, 0.46, 0.74, 0.30}};

// Niell (1996), tables 3 and 4.
constexpr Climate kNiellA = {{1.2769934e-3, 1.2683230e-3, 1.2465397e-3, 1.2196049e-3, 1.2045996e-3},
                             {0.0, 1.2709626e-5, 2.6523662e-5, 3.4000452e-5, 4.1202191e-5}};
constexpr Climate kNiellB = {{2.9153695e-3, 2.9152299e-3, 2.9288445e-3, 2.9022565e-3, 2.9024912e-3},
                             {0.0, 2.1414979e-5, 3.0160779e-5, 7.2562722e-5, 11.723375e-5}};
constexpr Climate kNiellC = {{62.610505e-3, 62.837393e-3, 63.721774e-3, 63.824265e-3, 64.258455e-3},
                             {0.0, 9.0128400e-5, 4.3497037e-5, 84.795348e-5, 170.37206e-5}};
constexpr std::array<double, 5> kNiellWetA = {5.8021897e-4, 5.6794847e-4, 5.8118019e-4,
                                              5.9727542e-4, 6.1641693e-4};
constexpr std::array<double, 5> kNiellWetB = {1.4275268e-3, 1.5138625e-3, 1.4572752e-3,
                                              1.5007428e-3, 1.7599082e-3};
constexpr std::array<double, 5> kNiellWetC = {4.3472961e-2, 4.6729510e-2, 4.3908931e-2,
                                              4.4626982e-2, 5.4736038e-2};

}  // namespace

Meteorology ClimatologicalMeteorology(const Geodetic& place, std::int64_t time_gps_ns) {
  constexpr double kGravity_mps2 = 9.80665;
  constexpr double kDryAirConstant = 287.054;  // J / (kg K)
  const TablePlace row = PlaceInTable(place.latitude_rad);
  const double winter = Winter(place.latitude_rad, DayOfYear(time_gps_ns), 211.0);
  const double height_m = std::clamp(place.height_m, kLowest_m, kHighest_m);

  const double lapse_kpm = kLapseRate_kpm.At(row, winter);
  const double sea_temperature_k = kTemperature_k.At(row, winter);
  const double ratio = 1.0 - lapse_kpm * height_m / sea_temperature_k;
  const double exponent = kGravity_mps2 / (kDryAirConstant * lapse_kpm);
  Meteorology weather;
  weather.temperature_k = sea_temperature_k * ratio;
  weather.pressure_hpa = kPressure_hpa.At(row, winter) * std::pow(ratio, exponent);
  weather.vapour_pressure_hpa = kVapourPressure_hpa.At(row, winter) *
                                std::pow(ratio, exponent * (kVapourLapse.At(row, winter) + 1.0));
  return weather;
}

Meteorology StandardMeteorology(double height_m, double relative_humidity) {
  const double height = std::clamp(height_m, kLowest_m, kHighest_m);
  Meteorology weather;
  weather.temperature_k = 288.15 - 6.5e-3 * height;
  weather.pressure_hpa = 1013.25 * std::pow(1.0 - 2.2557e-5 * height, 5.2568);
  // Saturation pressure over water, Magnus's formula as fitted by Bolton (1980).
  const double celsius = weather.temperature_k - 273.15;
  weather.vapour_pressure_hpa =
      relative_humidity * 6.112 * std::exp(17.67 * celsius / (celsius + 243.5));
  return weather;
}

ZenithDelay SaastamoinenZenithDelay(const Meteorology& weather, const Geodetic& place) {
  const double gravity =
      1.0 - 0.00266 * std::cos(2.0 * place.latitude_rad) - 0.28e-6 * place.height_m;
  return {0.0022768 * weather.pressure_hpa / gravity,
          0.0022768 * (1255.0 / weather.temperature_k + 0.05) * weather.vapour_pressure_hpa};
}

ZenithDelay HopfieldZenithDelay(const Meteorology& weather) {
  // Each layer's refractivity falls as the fourth power of the height left to its top, so its
  // integral is a fifth of surface value times thickness.
  const double dry_top_m = 40'136.0 + 148.72 * (weather.temperature_k - 273.16);
  constexpr double kWetTop_m = 11'000.0;
  const double dry_refractivity = 77.64 * weather.pressure_hpa / weather.temperature_k;
  const double wet_refractivity = weather.vapour_pressure_hpa / weather.temperature_k *
                                  (-12.96 + 371'800.0 / weather.temperature_k);
  return {1e-6 * dry_refractivity * dry_top_m / 5.0, 1e-6 * wet_refractivity * kWetTop_m / 5.0};
}

double SaastamoinenSlantDelay(const Meteorology& weather, double height_m, double elevation_rad) {
  // Saastamoinen (1973), the correction B in hPa by height in km.
  constexpr std::array<double, 9> kHeights_km = {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0};
  constexpr std::array<double, 9> kB_hpa = {1.156, 1.079, 1.006, 0.938, 0.874,
                                            0.813, 0.757, 0.654, 0.563};
  const double height_km = std::clamp(1e-3 * height_m, kHeights_km.front(), kHeights_km.back());
  std::size_t row = 0;
  while (row + 2 < kHeights_km.size() && height_km > kHeights_km[row + 1]) ++row;
  const double fraction =
      (height_km - kHeights_km[row]) / (kHeights_km[row + 1] - kHeights_km[row]);
  const double b_hpa = kB_hpa[row] + fraction * (kB_hpa[row + 1] - kB_hpa[row]);

  const double zenith_rad = kPi / 2.0 - std::max(elevation_rad, 3.0 * kRadiansPerDegree);
  const double tangent = std::tan(zenith_rad);
  return 0.002277 / std::cos(zenith_rad) *
         (weather.pressure_hpa +
          (1255.0 / weather.temperature_k + 0.05) * weather.vapour_pressure_hpa -
          b_hpa * tangent * tangent);
}

NiellMapping::NiellMapping(const Geodetic& place, std::int64_t time_gps_ns)
    : height_km_(1e-3 * std::clamp(place.height_m, kLowest_m, kHighest_m)) {
  const TablePlace row = PlaceInTable(place.latitude_rad);
  const double winter =
      Winter(place.latitude_rad, DayOfYear(time_gps_ns), 28.0 + kDaysPerYear / 2.0);
  hydrostatic_ = {kNiellA.At(row, winter), kNiellB.At(row, winter), kNiellC.At(row, winter)};
  wet_ = {row.Of(kNiellWetA), row.Of(kNiellWetB), row.Of(kNiellWetC)};
}

// Marini's continued fraction, 1 at the zenith.
double NiellMapping::Map(const Fraction& f, double s) {
  return (1.0 + f.a / (1.0 + f.b / (1.0 + f.c))) / (s + f.a / (s + f.b / (s + f.c)));
}

MappingFactors NiellMapping::At(double elevation_rad) const {
  constexpr Fraction kHeight = {2.53e-5, 5.49e-3, 1.14e-3};
  const double s = std::sin(std::max(elevation_rad, 2.0 * kRadiansPerDegree));
  return {Map(hydrostatic_, s) + height_km_ * (1.0 / s - Map(kHeight, s)), Map(wet_, s)};
}

Troposphere::Troposphere(const Geodetic& place, std::int64_t time_gps_ns)
    : zenith_(SaastamoinenZenithDelay(ClimatologicalMeteorology(place, time_gps_ns), place)),
      mapping_(place, time_gps_ns) {}

double Troposphere::Delay(double elevation_rad, double* sigma_m) const {
  const MappingFactors mapping = mapping_.At(elevation_rad);
  if (sigma_m != nullptr) {
    *sigma_m = mapping.hydrostatic * kHydrostaticSigma_m +
               mapping.wet * std::max(kWetShare * zenith_.wet_m, kLeastWetSigma_m);
  }
  return mapping.hydrostatic * zenith_.hydrostatic_m + mapping.wet * zenith_.wet_m;
}

double TroposphereDelay(const Geodetic& place, double elevation_rad, std::int64_t time_gps_ns,
                        double* sigma_m) {
  return Troposphere(place, time_gps_ns).Delay(elevation_rad, sigma_m);
}

}  // namespace lodemark
