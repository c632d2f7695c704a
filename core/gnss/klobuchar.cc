#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/ionosphere.h"

namespace lodemark {
namespace {

constexpr double kGpsL1_hz = 1575.42e6;
constexpr double kBeidouB1I_hz = 1561.098e6;
constexpr double kNavicL5_hz = 1176.45e6;
constexpr double kDay_s = 86'400.0;
constexpr double kLocalNoonShift_s = 50'400.0;  // the delay peaks at 14 h
constexpr double kNightDelay_s = 5e-9;

double Polynomial(const std::array<double, 4>& coefficients, double x) {
  return coefficients[0] + x * (coefficients[1] + x * (coefficients[2] + x * coefficients[3]));
}

double SecondsOfLocalDay(double longitude_semicircles, double time_of_day_s) {
  const double local_s = 43'200.0 * longitude_semicircles + time_of_day_s;
  return local_s - kDay_s * std::floor(local_s / kDay_s);
}

// The carrier that the coefficients are for; NavIC's: IRNSS SIS ICD 1.1 appendix H.
double ReferenceFrequency(System system) {
  if (system == System::kBeidou) return kBeidouB1I_hz;
  return system == System::kNavic ? kNavicL5_hz : kGpsL1_hz;
}

double TimeOfDay(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(FloorModulo(time_ns, kDay_ns));
}

// Angles in semicircles, as the document has them.
double GpsDelaySeconds(const KlobucharParameters& parameters, const Geodetic& receiver,
                       const LookAngles& satellite, std::int64_t time_gps_ns) {
  const double elevation = std::max(satellite.elevation_rad, 0.0) / kPi;
  const double earth_angle = 0.0137 / (elevation + 0.11) - 0.022;
  const double pierce_latitude = std::clamp(
      receiver.latitude_rad / kPi + earth_angle * std::cos(satellite.azimuth_rad), -0.416, 0.416);
  const double pierce_longitude =
      receiver.longitude_rad / kPi +
      earth_angle * std::sin(satellite.azimuth_rad) / std::cos(pierce_latitude * kPi);
  const double geomagnetic_latitude =
      pierce_latitude + 0.064 * std::cos((pierce_longitude - 1.617) * kPi);
  const double local_s = SecondsOfLocalDay(pierce_longitude, TimeOfDay(time_gps_ns));

  const double amplitude_s = std::max(Polynomial(parameters.alpha, geomagnetic_latitude), 0.0);
  const double period_s = std::max(Polynomial(parameters.beta, geomagnetic_latitude), 72'000.0);
  const double x = 2.0 * kPi * (local_s - kLocalNoonShift_s) / period_s;
  const double slant = 1.0 + 16.0 * std::pow(0.53 - elevation, 3);
  if (std::abs(x) >= 1.57) return slant * kNightDelay_s;
  const double x2 = x * x;
  return slant * (kNightDelay_s + amplitude_s * (1.0 - x2 / 2.0 + x2 * x2 / 24.0));
}

double BeidouDelaySeconds(const KlobucharParameters& parameters, const Geodetic& receiver,
                          const LookAngles& satellite, std::int64_t time_gps_ns) {
  constexpr double kEarthOverShell = 6378.0 / (6378.0 + 375.0);
  const double elevation_rad = std::max(satellite.elevation_rad, 0.0);
  const double sin_zenith_at_shell = kEarthOverShell * std::cos(elevation_rad);
  const double earth_angle_rad = kPi / 2.0 - elevation_rad - std::asin(sin_zenith_at_shell);
  const double sin_pierce_latitude =
      std::sin(receiver.latitude_rad) * std::cos(earth_angle_rad) +
      std::cos(receiver.latitude_rad) * std::sin(earth_angle_rad) * std::cos(satellite.azimuth_rad);
  const double pierce_latitude_rad = std::asin(std::clamp(sin_pierce_latitude, -1.0, 1.0));
  const double sin_longitude_step = std::sin(earth_angle_rad) * std::sin(satellite.azimuth_rad) /
                                    std::max(std::cos(pierce_latitude_rad), 1e-9);
  const double pierce_longitude_rad =
      receiver.longitude_rad + std::asin(std::clamp(sin_longitude_step, -1.0, 1.0));
  const double local_s = SecondsOfLocalDay(
      pierce_longitude_rad / kPi, TimeOfDay(ScaleFromGps(time_gps_ns, TimeScale::kBeidou)));

  const double latitude = std::abs(pierce_latitude_rad / kPi);
  const double amplitude_s = std::max(Polynomial(parameters.alpha, latitude), 0.0);
  const double period_s = std::clamp(Polynomial(parameters.beta, latitude), 72'000.0, 172'800.0);
  double vertical_s = kNightDelay_s;
  if (std::abs(local_s - kLocalNoonShift_s) < period_s / 4.0) {
    vertical_s += amplitude_s * std::cos(2.0 * kPi * (local_s - kLocalNoonShift_s) / period_s);
  }
  return vertical_s / std::sqrt(1.0 - sin_zenith_at_shell * sin_zenith_at_shell);
}

}  // namespace

double KlobucharDelay(const KlobucharParameters& parameters, const Geodetic& receiver,
                      const LookAngles& satellite, std::int64_t time_gps_ns, double frequency_hz) {
  const bool beidou = parameters.system == System::kBeidou;
  const double delay_s = beidou ? BeidouDelaySeconds(parameters, receiver, satellite, time_gps_ns)
                                : GpsDelaySeconds(parameters, receiver, satellite, time_gps_ns);
  const double ratio = ReferenceFrequency(parameters.system) / frequency_hz;
  return kSpeedOfLight_mps * delay_s * ratio * ratio;
}

}  // namespace lodemark
