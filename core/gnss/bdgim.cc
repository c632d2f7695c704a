// Equations and tables are those of BDS-SIS-ICD-B1C 1.0 section 7.8.
#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/pierce_point.h"

namespace lodemark {
namespace {

constexpr double kEarthOverShell = 6378.0 / (6378.0 + 400.0);
constexpr double kPoleLatitude_rad = 80.27 * kRadiansPerDegree;
constexpr double kPoleLongitude_rad = -72.58 * kRadiansPerDegree;
constexpr double kDelayPerTecu = 40.3e16;  // metres times frequency squared
constexpr std::int64_t kSlot_ns = 7200 * kSecond_ns;
constexpr double kModifiedJulianDayOf1980 = 44'244.0;  // 1980-01-06

// Periods of the prediction in days, and the amplitudes of its 17 coefficients in TECu: the mean,
// then cosine and sine of each period (tables 7-10 and 7-11). Degree and order of the rows: 3/0,
// 3/1, 3/-1, 3/2, 3/-2, 3/3, 3/-3, 4/0, 4/1, 4/-1, 4/2, 4/-2, 5/0, 5/1, 5/-1, 5/2, 5/-2.
constexpr std::array<double, 12> kPeriods_days = {
    1.0, 0.5, 0.33, 14.6, 27.0, 121.6, 182.51, 365.25, 4028.71, 2014.35, 1342.90, 1007.18};
constexpr double kAmplitudes_tecu[17][25] = {
    {-0.61, -0.51, 0.23, -0.06, 0.02,  0.01, 0.00,  -0.01, 0.00,  0.00, 0.01,  -0.19, -0.09,
     -0.18, 0.15,  1.09, 0.50,  -0.34, 0.00, -0.13, 0.05,  -0.06, 0.03, -0.03, 0.04},
    {-1.31, -0.43, -0.20, -0.05, -0.08, -0.03, -0.02, 0.00, -0.02, 0.00,  0.00, -0.02, 0.07,
     0.06,  -0.31, -0.14, -0.08, -0.09, -0.11, 0.07,  0.03, 0.13,  -0.02, 0.08, -0.02},
    {-2.00, 0.34, -0.31, 0.06,  -0.06, 0.01,  -0.03, 0.01, 0.01,  0.03, 0.00,  0.12, 0.03,
     -0.55, 0.13, -0.21, -0.38, -1.22, -0.22, -0.37, 0.07, -0.07, 0.04, -0.01, -0.04},
    {-0.03, -0.01, 0.16, 0.17, -0.11, -0.01, -0.05, 0.00, 0.00, 0.01,  0.01, -0.10, 0.06,
     -0.02, 0.05,  0.52, 0.36, 0.05,  0.01,  0.05,  0.02, 0.03, -0.01, 0.04, 0.00},
    {0.15, 0.17,  -0.03, 0.15, 0.15, 0.05, -0.01, 0.01,  -0.01, 0.02,  0.00, 0.06, 0.09,
     0.09, -0.09, 0.27,  0.14, 0.15, 0.02, 0.06,  -0.01, 0.02,  -0.03, 0.01, -0.01},
    {-0.48, 0.02,  0.02, 0.00, -0.14, -0.03, -0.07, 0.00, 0.01,  0.01, 0.00,  0.00, 0.01,
     -0.08, -0.03, 0.00, 0.04, -0.29, -0.03, -0.11, 0.03, -0.05, 0.02, -0.02, 0.00},
    {-0.40, -0.06, 0.04, 0.11, 0.01,  0.05,  -0.03, -0.01, 0.00,  0.00, 0.00,  -0.02, 0.02,
     0.00,  0.06,  0.11, 0.00, -0.17, -0.01, -0.07, 0.02,  -0.05, 0.01, -0.02, 0.01},
    {2.28, 0.30,  0.18, -0.05, 0.01, -0.03, -0.01, -0.01, -0.02, -0.02, 0.00,  -0.08, 0.00,
     0.86, -0.36, 0.17, 0.25,  1.58, 0.49,  0.46,  -0.04, 0.01,  0.04,  -0.04, 0.07},
    {-0.16, 0.44, 0.34, -0.16, 0.04,  -0.01, 0.02, 0.00,  0.00, 0.00, 0.00, -0.02, -0.04,
     -0.18, 0.08, 0.23, 0.17,  -0.06, -0.03, 0.00, -0.01, 0.00, 0.00, 0.00, 0.00},
    {-0.21, -0.28, 0.45, 0.02, -0.14, 0.00,  -0.01, 0.00,  0.00, 0.00, 0.00, -0.07, -0.02,
     -0.05, 0.05,  0.35, 0.27, -0.15, -0.02, -0.04, -0.01, 0.00, 0.00, 0.00, 0.00},
    {-0.10, -0.31, 0.19,  0.11,  -0.05, -0.08, 0.03, 0.00, 0.00, 0.00, 0.00, 0.01, -0.01,
     -0.07, 0.06,  -0.05, -0.03, 0.00,  0.01,  0.01, 0.02, 0.00, 0.00, 0.00, 0.00},
    {-0.13, -0.17, -0.25, 0.04,  0.08, -0.04, -0.10, 0.00, 0.00, 0.00, 0.00, 0.03, 0.01,
     0.04,  -0.02, 0.02,  -0.03, 0.13, 0.02,  0.07,  0.03, 0.00, 0.00, 0.00, 0.00},
    {0.21, 0.04,  -0.12, 0.12,  0.08, 0.00, 0.01, 0.00, 0.00, 0.00, 0.00, 0.15, -0.10,
     0.14, -0.05, -0.60, -0.32, 0.28, 0.04, 0.09, 0.02, 0.00, 0.00, 0.00, 0.00},
    {0.68,  0.39, 0.18, 0.07,  -0.01, -0.02, 0.05,  0.00,  0.00, 0.00, 0.00, 0.06, 0.00,
     -0.03, 0.06, 0.02, -0.10, -0.08, -0.04, -0.05, -0.04, 0.00, 0.00, 0.00, 0.00},
    {1.06, -0.12, 0.40, 0.02, 0.01, -0.03, -0.01, 0.00,  0.00, 0.00, 0.00, -0.05, -0.01,
     0.37, -0.20, 0.01, 0.20, 0.62, 0.16,  0.15,  -0.04, 0.00, 0.00, 0.00, 0.00},
    {0.00,  0.12, -0.09, -0.14, 0.11,  0.00,  0.04,  0.00,  0.00, 0.00, 0.00, -0.03, 0.02,
     -0.11, 0.04, 0.27,  0.10,  -0.01, -0.02, -0.01, -0.01, 0.00, 0.00, 0.00, 0.00},
    {-0.12, 0.00, 0.21, -0.14, -0.12, -0.03, 0.00, 0.00, 0.00, 0.00, 0.00, -0.10, 0.05,
     -0.12, 0.07, 0.32, 0.30,  -0.04, -0.01, 0.01, 0.00, 0.00, 0.00, 0.00, 0.00},
};

// Spherical harmonics up to degree 5, normalised, of a point in the geomagnetic frame that turns
// with the sun, given by the sine of its latitude and cosine and sine of its longitude. Only the
// degrees and orders that the model uses.
struct Harmonics {
  std::array<double, 9> broadcast = {};   // 0/0, 1/0, 1/1, 1/-1, 2/0, 2/1, 2/-1, 2/2, 2/-2
  std::array<double, 17> predicted = {};  // as kAmplitudes_tecu
};

Harmonics HarmonicsAt(double sin_latitude, double cos1, double sin1) {
  const double s = sin_latitude;
  const double s2 = s * s;
  const double c = std::sqrt(std::max(1.0 - s2, 0.0));
  const double cos2 = cos1 * cos1 - sin1 * sin1;
  const double sin2 = 2.0 * cos1 * sin1;
  const double cos3 = cos2 * cos1 - sin2 * sin1;
  const double sin3 = sin2 * cos1 + cos2 * sin1;

  // Legendre functions times sqrt((n - m)! (2n + 1) (2 - delta) / (n + m)!).
  const double p10 = std::sqrt(3.0) * s;
  const double p11 = std::sqrt(3.0) * c;
  const double p20 = std::sqrt(5.0) / 2.0 * (3.0 * s2 - 1.0);
  const double p21 = std::sqrt(15.0) * s * c;
  const double p22 = std::sqrt(15.0) / 2.0 * c * c;
  const double p30 = std::sqrt(7.0) / 2.0 * s * (5.0 * s2 - 3.0);
  const double p31 = std::sqrt(42.0) / 4.0 * c * (5.0 * s2 - 1.0);
  const double p32 = std::sqrt(105.0) / 2.0 * s * c * c;
  const double p33 = std::sqrt(70.0) / 4.0 * c * c * c;
  const double p40 = 3.0 / 8.0 * (s2 * (35.0 * s2 - 30.0) + 3.0);
  const double p41 = 3.0 * std::sqrt(10.0) / 4.0 * s * c * (7.0 * s2 - 3.0);
  const double p42 = 3.0 * std::sqrt(5.0) / 4.0 * c * c * (7.0 * s2 - 1.0);
  const double p50 = std::sqrt(11.0) / 8.0 * s * (s2 * (63.0 * s2 - 70.0) + 15.0);
  const double p51 = std::sqrt(165.0) / 8.0 * c * (s2 * (21.0 * s2 - 14.0) + 1.0);
  const double p52 = std::sqrt(1155.0) / 4.0 * s * c * c * (3.0 * s2 - 1.0);

  return {
      {1.0, p10, p11 * cos1, p11 * sin1, p20, p21 * cos1, p21 * sin1, p22 * cos2, p22 * sin2},
      {p30, p31 * cos1, p31 * sin1, p32 * cos2, p32 * sin2, p33 * cos3, p33 * sin3, p40, p41 * cos1,
       p41 * sin1, p42 * cos2, p42 * sin2, p50, p51 * cos1, p51 * sin1, p52 * cos2, p52 * sin2}};
}

}  // namespace

std::int64_t BdgimSlot(std::int64_t time_gps_ns) {
  const std::int64_t time_bdt_ns = ScaleFromGps(time_gps_ns, TimeScale::kBeidou);
  return (time_bdt_ns - FloorModulo(time_bdt_ns, kSlot_ns)) / kSlot_ns;
}

BdgimPrediction PredictBdgim(std::int64_t time_gps_ns) {
  BdgimPrediction prediction;
  prediction.slot = BdgimSlot(time_gps_ns);
  // The middle of the slot, an odd hour.
  const double day = kModifiedJulianDayOf1980 + (static_cast<double>(prediction.slot) + 0.5) / 12.0;
  std::array<double, 25> waves = {1.0};
  for (std::size_t k = 0; k < kPeriods_days.size(); ++k) {
    const double phase_rad = 2.0 * kPi * day / kPeriods_days[k];
    waves[2 * k + 1] = std::cos(phase_rad);
    waves[2 * k + 2] = std::sin(phase_rad);
  }
  for (std::size_t j = 0; j < prediction.beta.size(); ++j) {
    for (std::size_t k = 0; k < waves.size(); ++k) {
      prediction.beta[j] += kAmplitudes_tecu[j][k] * waves[k];
    }
  }
  return prediction;
}

double BdgimDelay(const BdgimParameters& parameters, const BdgimPrediction& prediction,
                  const Geodetic& receiver, const LookAngles& satellite, std::int64_t time_gps_ns,
                  double frequency_hz) {
  const PiercePoint pierce =
      PierceThinShell(receiver, satellite, kEarthOverShell, BeyondPole::kThere);

  // Latitude and longitude in the geomagnetic frame. The longitude's cosine and sine stand over a
  // common factor, the cosines of the pole's latitude and the point's.
  const double sin_pole = std::sin(kPoleLatitude_rad);
  const double cos_pole = std::cos(kPoleLatitude_rad);
  const double cos_pole_longitude = std::cos(kPoleLongitude_rad);
  const double sin_pole_longitude = std::sin(kPoleLongitude_rad);
  const Eigen::Vector3d& d = pierce.direction;
  const double sin_geomagnetic = std::clamp(
      cos_pole * (d.x() * cos_pole_longitude + d.y() * sin_pole_longitude) + sin_pole * d.z(), -1.0,
      1.0);
  const double east = cos_pole * (d.y() * cos_pole_longitude - d.x() * sin_pole_longitude);
  const double north = sin_pole * sin_geomagnetic - d.z();
  const double factor = std::max(std::sqrt(east * east + north * north), 1e-12);

  // Less the longitude of the mean sun in that frame.
  const std::int64_t time_bdt_ns = ScaleFromGps(time_gps_ns, TimeScale::kBeidou);
  const double day_fraction =
      static_cast<double>(FloorModulo(time_bdt_ns, kDay_ns)) / static_cast<double>(kDay_ns);
  const double sun_rad = kPi * (1.0 - 2.0 * day_fraction) - kPoleLongitude_rad;
  const double sun_east = std::sin(sun_rad);
  const double sun_north = sin_pole * std::cos(sun_rad);
  const double both = factor * std::sqrt(sun_east * sun_east + sun_north * sun_north);
  const Harmonics harmonics =
      HarmonicsAt(sin_geomagnetic, (north * sun_north + east * sun_east) / both,
                  (east * sun_north - north * sun_east) / both);

  double content_tecu = 0.0;
  for (std::size_t i = 0; i < harmonics.broadcast.size(); ++i) {
    content_tecu += parameters.alpha[i] * harmonics.broadcast[i];
  }
  for (std::size_t j = 0; j < harmonics.predicted.size(); ++j) {
    content_tecu += prediction.beta[j] * harmonics.predicted[j];
  }
  // The mapping function of 7.8.2: that of a single layer. The program which the model's authors
  // published takes 0.9782 times the zenith angle instead, 1 % less at 45 degrees of elevation.
  const double slant = 1.0 / std::sqrt(1.0 - pierce.sin_zenith * pierce.sin_zenith);
  return std::max(content_tecu, 0.0) * slant * kDelayPerTecu / (frequency_hz * frequency_hz);
}

}  // namespace lodemark
