// Equation numbers are those of the NTCM-G Ionospheric Model Description, issue 1.0.
#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/pierce_point.h"

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

// Equations 3 to 15, 27 to 31. TECu at the pierce point.
double VerticalContent(double ionisation, const Eigen::Vector3d& pierce, double utc_h,
                       const NtcmGSeason& season) {
  const double sin_latitude = std::clamp(pierce.z(), -1.0, 1.0);
  const double cos_latitude = std::max(std::hypot(pierce.x(), pierce.y()), 1e-12);

  // The angle of local time from midnight, and twice and three times that.
  const double utc_rad = 2.0 * kPi * utc_h / 24.0;
  const double cos_utc = std::cos(utc_rad);
  const double sin_utc = std::sin(utc_rad);
  const double cos1 = (pierce.x() * cos_utc - pierce.y() * sin_utc) / cos_latitude;
  const double sin1 = (pierce.y() * cos_utc + pierce.x() * sin_utc) / cos_latitude;
  const double cos2 = cos1 * cos1 - sin1 * sin1;
  const double sin2 = 2.0 * cos1 * sin1;
  const double cos3 = cos2 * cos1 - sin2 * sin1;
  const double sin3 = sin2 * cos1 + cos2 * sin1;
  const double peak_rad = 2.0 * kPi * 14.0 / 24.0;
  const double diurnal = cos1 * std::cos(peak_rad) + sin1 * std::sin(peak_rad);

  const double cos_zenith =
      cos_latitude * season.cos_declination + sin_latitude * season.sin_declination;
  const double day_part = cos_zenith - 2.0 / kPi * std::asin(sin_latitude) * season.sin_declination;
  const double f1 =
      cos_zenith + 0.4 +
      day_part * (kK[1] * diurnal + kK[2] * cos2 + kK[3] * sin2 + kK[4] * cos3 + kK[5] * sin3);

  const double sin_geomagnetic =
      std::clamp(sin_latitude * std::sin(kPoleLatitude_rad) +
                     std::cos(kPoleLatitude_rad) * (pierce.x() * std::cos(kPoleLongitude_rad) +
                                                    pierce.y() * std::sin(kPoleLongitude_rad)),
                 -1.0, 1.0);
  const double f3 = 1.0 + kK[8] * std::sqrt(1.0 - sin_geomagnetic * sin_geomagnetic);

  // The crests of the equatorial anomaly.
  const double geomagnetic_deg = std::asin(sin_geomagnetic) * kDegreesPerRadian;
  const double f4 = 1.0 + kK[9] * std::exp(-Square((geomagnetic_deg - 16.0) / 12.0) / 2.0) +
                    kK[10] * std::exp(-Square((geomagnetic_deg + 10.0) / 13.0) / 2.0);

  const double f5 = kK[11] + kK[12] * ionisation;
  return f1 * season.factor * f3 * f4 * f5;
}

}  // namespace

// Equations 8 to 10 and 28.
NtcmGSeason SeasonOfNtcmG(std::int64_t time_gps_ns) {
  const std::int64_t utc_ns = ScaleFromGps(time_gps_ns, TimeScale::kUtc);
  const CalendarTime calendar = CalendarFromNanoseconds(std::max<std::int64_t>(utc_ns, 0));
  const std::optional<std::int64_t> new_year_ns =
      NanosecondsFromCalendar({calendar.year, 1, 1, 0, 0, 0.0});
  NtcmGSeason season;
  season.day = (utc_ns - FloorModulo(utc_ns, kDay_ns)) / kDay_ns;
  const double day_of_year =
      1.0 + static_cast<double>(season.day - new_year_ns.value_or(utc_ns) / kDay_ns);
  const double declination_rad =
      23.44 * kRadiansPerDegree * std::sin(0.9856 * (day_of_year - 80.7) * kRadiansPerDegree);
  season.cos_declination = std::cos(declination_rad);
  season.sin_declination = std::sin(declination_rad);
  season.factor = 1.0 + kK[6] * std::cos(2.0 * kPi * (day_of_year - 18.0) / 365.25) +
                  kK[7] * std::cos(4.0 * kPi * (day_of_year - 6.0) / 365.25);
  return season;
}

double NtcmGDelay(const GalileoIonosphereParameters& parameters, const NtcmGSeason& season,
                  const Geodetic& receiver, const LookAngles& satellite, std::int64_t time_gps_ns,
                  double frequency_hz) {
  const std::int64_t utc_ns = ScaleFromGps(time_gps_ns, TimeScale::kUtc);
  const double utc_h = 1e-9 * static_cast<double>(FloorModulo(utc_ns, kDay_ns)) / 3600.0;
  // Equations 24 to 26, the last with an arcsine.
  const PiercePoint pierce =
      PierceThinShell(receiver, satellite, kEarthOverShell, BeyondPole::kMirrored);
  const double content_tecu =
      VerticalContent(EffectiveIonisation(parameters.a), pierce.direction, utc_h, season);
  // Equations 32 and 33.
  const double sin_zenith =
      kEarthOverShell * std::sin(0.9782 * (kPi / 2.0 - std::max(satellite.elevation_rad, 0.0)));
  const double slant = 1.0 / std::sqrt(1.0 - sin_zenith * sin_zenith);
  return std::max(content_tecu, 0.0) * slant * kDelayPerTecu / (frequency_hz * frequency_hz);
}

}  // namespace lodemark
