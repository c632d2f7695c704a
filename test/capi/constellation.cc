#include "test/capi/constellation.h"

#include <cmath>
#include <cstdio>
#include <cstring>

namespace lodemark::test {
namespace {

constexpr double kPi = 3.1415926535898;  // the value of IS-GPS-200
constexpr double kDegree = kPi / 180.0;
constexpr double kGravity_m3ps2 = 3.986005e14;
constexpr double kEarthRate_radps = 7.2921151467e-5;
constexpr double kSpeedOfLight_mps = 299792458.0;
constexpr double kRootOfRadius = 5153.65;
constexpr double kRadius_m = kRootOfRadius * kRootOfRadius;
constexpr double kInclination_rad = 55.0 * kDegree;
constexpr double kReferenceOfWeek_s = 302400.0;
constexpr int kWeek = 2318;
constexpr std::int64_t kWeek_ns = 604'800'000'000'000;

// Six planes of four satellites.
double NodeAtWeekStart(int satellite) { return 60.0 * kDegree * ((satellite - 1) / 4); }
double AnomalyAtReference(int satellite) {
  return kDegree * (90.0 * ((satellite - 1) % 4) + 15.0 * ((satellite - 1) / 4));
}

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%19.12E", value);
  return text;
}

std::string Row(const std::array<double, 4>& values) {
  std::string row = "    ";
  for (const double value : values) row += Number(value);
  return row + "\n";
}

std::string HeaderLine(const std::string& content, const std::string& label) {
  return content + std::string(60 - content.size(), ' ') + label + "\n";
}

double Distance(const Vector& a, const double b[3]) {
  return std::hypot(a.x - b[0], a.y - b[1], a.z - b[2]);
}

// The axes turn while the signal travels.
Vector Turned(const Vector& point, double seconds) {
  const double angle = kEarthRate_radps * seconds;
  return {point.x * std::cos(angle) + point.y * std::sin(angle),
          point.y * std::cos(angle) - point.x * std::sin(angle), point.z};
}

// Travel time of a signal that arrives at the point at the given true time.
double TravelTime(int satellite, double received_s, const double point[3]) {
  double travel_s = 0.07;
  for (int i = 0; i < 6; ++i) {
    const Vector sent_from = Constellation::SatelliteAt(satellite, received_s - travel_s);
    travel_s = Distance(Turned(sent_from, travel_s), point) / kSpeedOfLight_mps;
  }
  return travel_s;
}

}  // namespace

Vector Constellation::SatelliteAt(int satellite, double seconds_after_reference) {
  const double motion_radps = std::sqrt(kGravity_m3ps2 / kRadius_m) / kRadius_m;
  const double anomaly = AnomalyAtReference(satellite) + motion_radps * seconds_after_reference;
  const double node = NodeAtWeekStart(satellite) -
                      kEarthRate_radps * (kReferenceOfWeek_s + seconds_after_reference);
  const double along = kRadius_m * std::cos(anomaly);
  const double across = kRadius_m * std::sin(anomaly);
  const double level = across * std::cos(kInclination_rad);
  return {along * std::cos(node) - level * std::sin(node),
          along * std::sin(node) + level * std::cos(node), across * std::sin(kInclination_rad)};
}

std::string Constellation::NavigationFile() {
  std::string text =
      HeaderLine("     3.04           N: GNSS NAV DATA    G: GPS", "RINEX VERSION / TYPE") +
      HeaderLine("    18", "LEAP SECONDS") + HeaderLine("", "END OF HEADER");
  for (int satellite = 1; satellite <= kSatellites; ++satellite) {
    char first[32];
    std::snprintf(first, sizeof first, "G%02d 2024 06 12 12 00 00", satellite);
    text += first + Number(0.0) + Number(0.0) + Number(0.0) + "\n";
    text += Row({1.0, 0.0, 0.0, AnomalyAtReference(satellite)});
    text += Row({0.0, 0.0, 0.0, kRootOfRadius});
    text += Row({kReferenceOfWeek_s, 0.0, NodeAtWeekStart(satellite), 0.0});
    text += Row({kInclination_rad, 0.0, 0.0, 0.0});
    text += Row({0.0, 1.0, double{kWeek}, 0.0});
    text += Row({2.0, 0.0, 0.0, 1.0});
    text += Row({kReferenceOfWeek_s - 7200.0, 4.0, 0.0, 0.0});
  }
  return text;
}

StillPhone::StillPhone(const double geodetic[3], double clock_m) : clock_m_(clock_m) {
  std::memcpy(geodetic_, geodetic, sizeof geodetic_);
  lodemark_ecef_from_geodetic(geodetic_, ecef_m_);
}

void StillPhone::Measure(std::int64_t time_gps_ns) {
  clock = {};
  clock.struct_size = sizeof clock;
  clock.present = LODEMARK_CLOCK_HAS_FULL_BIAS | LODEMARK_CLOCK_HAS_BIAS |
                  LODEMARK_CLOCK_HAS_BIAS_UNCERTAINTY | LODEMARK_CLOCK_HAS_ELAPSED_REALTIME;
  clock.time_ns = 5'000'000'000 + (time_gps_ns - Constellation::kReference_gps_ns);
  clock.full_bias_ns = clock.time_ns - time_gps_ns;
  clock.bias_uncertainty_ns = 20.0;
  clock.elapsed_realtime_ns = clock.time_ns + 1'000'000;
  measurements.clear();
  pseudoranges_m.clear();

  const double clock_s = clock_m_ / kSpeedOfLight_mps;
  const double received_s =
      1e-9 * static_cast<double>(time_gps_ns - Constellation::kReference_gps_ns) - clock_s;
  for (int satellite = 1; satellite <= Constellation::kSatellites; ++satellite) {
    const double travel_s = TravelTime(satellite, received_s, ecef_m_);
    const Vector there = Constellation::SatelliteAt(satellite, received_s);
    const double there_in_ecef[3] = {there.x, there.y, there.z};
    double enu_m[3];
    lodemark_enu_from_ecef(geodetic_, there_in_ecef, enu_m);
    if (std::atan2(enu_m[2], std::hypot(enu_m[0], enu_m[1])) < 10.0 * kDegree) continue;

    lodemark_gnss_measurement measurement = {};
    measurement.struct_size = sizeof measurement;
    measurement.svid = satellite;
    measurement.constellation_type = 1;  // GPS
    measurement.state = 1 | 2 | 4 | 8;   // code lock to time of week decoded
    // Whole nanoseconds by the satellite's clock; the rest shifts the instant of measurement.
    const double since_sent_ns = 1e9 * (travel_s + clock_s);
    const double whole_ns = std::floor(since_sent_ns);
    measurement.received_sv_time_ns =
        (time_gps_ns - static_cast<std::int64_t>(whole_ns)) % kWeek_ns;
    measurement.time_offset_ns = since_sent_ns - whole_ns;
    measurement.received_sv_time_uncertainty_ns = 10;
    measurement.cn0_dbhz = 45.0;
    measurement.carrier_frequency_hz = 1575.42e6;
    const double later_s = TravelTime(satellite, received_s + 0.5, ecef_m_);
    const double earlier_s = TravelTime(satellite, received_s - 0.5, ecef_m_);
    measurement.pseudorange_rate_mps = kSpeedOfLight_mps * (later_s - earlier_s);
    measurement.pseudorange_rate_uncertainty_mps = 0.05;
    measurement.present =
        LODEMARK_MEASUREMENT_HAS_CN0 | LODEMARK_MEASUREMENT_HAS_CARRIER_FREQUENCY |
        LODEMARK_MEASUREMENT_HAS_RECEIVED_TIME_UNCERTAINTY | LODEMARK_MEASUREMENT_HAS_RANGE_RATE |
        LODEMARK_MEASUREMENT_HAS_RANGE_RATE_UNCERTAINTY;
    measurements.push_back(measurement);
    pseudoranges_m.push_back(kSpeedOfLight_mps * (travel_s + clock_s));
  }
}

}  // namespace lodemark::test
