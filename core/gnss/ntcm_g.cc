// Equation numbers are those of the NTCM-G Ionospheric Model Description, issue 1.0.
#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/ionosphere.h"

namespace lodemark {
namespace {

constexpr double kEarthOverShell = 6371.0 / (6371.0 + 450.0);
constexpr double kPoleLatitude_rad = 79.74 * kRadiansPerDegree;
constexpr double kPoleLongitude_rad = -71.78 * kRadiansPerDegree;
constexpr double kDelayPerTecu = 40.3e16;  // metres times frequency squared

// Table 3: the coefficients of the model, k1 to k12.
constexpr double kK[13] = {0.0,      0.92519,  0.16951, 0.00443, 0.06626, 0.00899, 0.21289,
                           -0.15414, -0.38439, 1.14023, 1.20556, 1.41808, 0.13985};

double Square(double x) { return x * x; }

// Equation 2.
double EffectiveIonisation(const std::array<double, 3>& a) {
  const double square =
      a[0] * a[0] + 1633.33 * a[1] * a[1] + 4'802'000.0 * a[2] * a[2] + 3266.67 * a[0] * a[2];
  return std::sqrt(std::max(square, 0.0));
}

struct PiercePoint {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
};

// Equations 24 to 26.
PiercePoint PierceOf(const Geodetic& receiver, const LookAngles& satellite) {
  const double earth_angle_rad = kPi / 2.0 - satellite.elevation_rad -
                                 std::asin(kEarthOverShell * std::cos(satellite.elevation_rad));
  const double sin_angle = std::sin(earth_angle_rad);
  PiercePoint pierce;
  pierce.latitude_rad = std::asin(
      std::clamp(std::sin(receiver.latitude_rad) * std::cos(earth_angle_rad) +
                     std::cos(receiver.latitude_rad) * sin_angle * std::cos(satellite.azimuth_rad),
                 -1.0, 1.0));
  const double sin_step =
      sin_angle * std::sin(satellite.azimuth_rad) / std::max(std::cos(pierce.latitude_rad), 1e-9);
  pierce.longitude_rad = receiver.longitude_rad + std::asin(std::clamp(sin_step, -1.0, 1.0));
  return pierce;
}

// Equations 3 to 15, 27 to 31. TECu at the pierce point.
double VerticalContent(double ionisation, const PiercePoint& pierce, double utc_h,
                       double day_of_year) {
  const double local_h = utc_h + pierce.longitude_rad * kDegreesPerRadian / 15.0;
  const double diurnal = 2.0 * kPi * (local_h - 14.0) / 24.0;
  const double semidiurnal = 2.0 * kPi * local_h / 12.0;
  const double terdiurnal = 2.0 * kPi * local_h / 8.0;
  const double declination_rad =
      23.44 * kRadiansPerDegree * std::sin(0.9856 * (day_of_year - 80.7) * kRadiansPerDegree);
  const double cos_zenith = std::cos(pierce.latitude_rad - declination_rad);
  const double day_part = cos_zenith - 2.0 / kPi * pierce.latitude_rad * std::sin(declination_rad);
  const double f1 = cos_zenith + 0.4 +
                    day_part * (kK[1] * std::cos(diurnal) + kK[2] * std::cos(semidiurnal) +
                                kK[3] * std::sin(semidiurnal) + kK[4] * std::cos(terdiurnal) +
                                kK[5] * std::sin(terdiurnal));

  const double f2 = 1.0 + kK[6] * std::cos(2.0 * kPi * (day_of_year - 18.0) / 365.25) +
                    kK[7] * std::cos(4.0 * kPi * (day_of_year - 6.0) / 365.25);

  const double sin_geomagnetic = std::sin(pierce.latitude_rad) * std::sin(kPoleLatitude_rad) +
                                 std::cos(pierce.latitude_rad) * std::cos(kPoleLatitude_rad) *
                                     std::cos(pierce.longitude_rad - kPoleLongitude_rad);
  const double geomagnetic_rad = std::asin(std::clamp(sin_geomagnetic, -1.0, 1.0));
  const double f3 = 1.0 + kK[8] * std::cos(geomagnetic_rad);

  // The crests of the equatorial anomaly.
  const double geomagnetic_deg = geomagnetic_rad * kDegreesPerRadian;
  const double f4 = 1.0 + kK[9] * std::exp(-Square((geomagnetic_deg - 16.0) / 12.0) / 2.0) +
                    kK[10] * std::exp(-Square((geomagnetic_deg + 10.0) / 13.0) / 2.0);

  const double f5 = kK[11] + kK[12] * ionisation;
  return f1 * f2 * f3 * f4 * f5;
}

}  // namespace

double NtcmGDelay(const GalileoIonosphereParameters& parameters, const Geodetic& receiver,
                  const LookAngles& satellite, std::int64_t time_gps_ns, double frequency_hz) {
  const std::int64_t utc_ns = ScaleFromGps(time_gps_ns, TimeScale::kUtc);
  const double utc_h = 1e-9 * static_cast<double>(FloorModulo(utc_ns, kDay_ns)) / 3600.0;
  const CalendarTime calendar = CalendarFromNanoseconds(utc_ns);
  const std::optional<std::int64_t> new_year_ns =
      NanosecondsFromCalendar({calendar.year, 1, 1, 0, 0, 0.0});
  const double day_of_year =
      1.0 + std::floor(static_cast<double>(utc_ns - new_year_ns.value_or(utc_ns)) /
                       static_cast<double>(kDay_ns));

  LookAngles above = satellite;
  above.elevation_rad = std::max(above.elevation_rad, 0.0);
  const double content_tecu = VerticalContent(EffectiveIonisation(parameters.a),
                                              PierceOf(receiver, above), utc_h, day_of_year);
  // Equations 32 and 33.
  const double sin_zenith = kEarthOverShell * std::sin(0.9782 * (kPi / 2.0 - above.elevation_rad));
  const double slant = 1.0 / std::sqrt(1.0 - sin_zenith * sin_zenith);
  return std::max(content_tecu, 0.0) * slant * kDelayPerTecu / (frequency_hz * frequency_hz);
}

}  // namespace lodemark
