#include "core/gnss/broadcast_rules.h"

#include <array>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

// Written so that a NaN is outside.
bool Within(double value, double limit) { return std::abs(value) <= limit; }
bool Between(double value, double low, double high) { return value >= low && value <= high; }

bool PlausibleSemiMajorAxis(System system, double axis_m) {
  constexpr double kMegametre_m = 1e6;
  const double axis_Mm = axis_m / kMegametre_m;
  switch (system) {
    case System::kGps:
      return Between(axis_Mm, 25.0, 28.5);
    case System::kGalileo:  // E14 and E18 were left at 27.98
      return Between(axis_Mm, 27.0, 31.0);
    case System::kBeidou:  // medium orbits, or geosynchronous
      return Between(axis_Mm, 26.5, 29.5) || Between(axis_Mm, 40.5, 44.0);
    case System::kQzss:
    case System::kNavic:
      return Between(axis_Mm, 40.5, 44.0);
    case System::kGlonass:
    case System::kSbas:
      break;
  }
  return false;
}

// Galileo's E14 and E18 have 0.16, QZSS 0.075; the others stay below 0.03.
double LargestEccentricity(System system) {
  return system == System::kGalileo || system == System::kQzss ? 0.5 : 0.1;
}

}  // namespace

bool IsHealthy(System system, MessageType type, std::int32_t health) {
  switch (type) {
    case MessageType::kLnav:
      // IS-QZSS-PNT, subframe 1: from the highest bit L1 as a whole, L1C/A, L2C, L5, L1C, L1C/B. A
      // satellite sends one of L1C/A and L1C/B and flags the other.
      if (system == System::kQzss) return (health & 0x20) == 0 && (health & 0x11) != 0x11;
      // NavIC SIS ICD 1.1, 6.2.1.5: bit 1 L5, bit 0 S; phones receive L5.
      if (system == System::kNavic) return (health & 0x2) == 0;
      // IS-GPS-200N 20.3.3.3.1.4: all six bits.
      return health == 0;
    case MessageType::kCnav:
      // IS-GPS-200N 30.3.3.1.1.2: L1, L2, L5 from the highest bit. L5 has been flagged since 2010,
      // for want of a declaration rather than for its orbit.
      return (health & 0x6) == 0;
    case MessageType::kCnav2:
      return health == 0;
    case MessageType::kInav:
      // RINEX: E1-B data validity in bit 0, signal health in bits 1 and 2.
      return (health & 0x007) == 0;
    case MessageType::kFnav:
      // E5a in bits 3 to 5.
      return (health & 0x038) == 0;
    case MessageType::kSbas:
      // Bit 0: ranging off; bit 5: user range accuracy index 15.
      return (health & 0x21) == 0;
    case MessageType::kD1:
    case MessageType::kD2:
    case MessageType::kCnav1:
    case MessageType::kCnav2Beidou:
    case MessageType::kCnav3:
    case MessageType::kFdma:
    case MessageType::kL1Nav:
      break;
  }
  return health == 0;
}

std::optional<double> UserRangeAccuracy(int index) {
  if (index <= -16 || index >= 15) return std::nullopt;
  // The ICD rounds three of the nominal values.
  if (index == 1) return 2.8;
  if (index == 3) return 5.7;
  if (index == 5) return 11.3;
  return index <= 6 ? std::exp2(1.0 + index / 2.0) : std::exp2(index - 2.0);
}

std::optional<double> GalileoSignalAccuracy(int index) {
  if (index < 0 || index > 125) return std::nullopt;
  if (index < 50) return 0.01 * index;
  if (index < 75) return 0.5 + 0.02 * (index - 50);
  if (index < 100) return 1.0 + 0.04 * (index - 75);
  return 2.0 + 0.16 * (index - 100);
}

std::optional<double> GlonassAccuracy(int index) {
  constexpr std::array<double, 15> kAccuracy_m = {1,  2,  2.5, 4,  5,   7,   10, 12,
                                                  14, 16, 32,  64, 128, 256, 512};
  if (index < 0 || index >= static_cast<int>(kAccuracy_m.size())) return std::nullopt;
  return kAccuracy_m[static_cast<std::size_t>(index)];
}

bool IsBeidouGeostationary(SatelliteId satellite) {
  return satellite.system == System::kBeidou && (satellite.number <= 5 || satellite.number >= 59);
}

double GpsFitInterval(bool flag, int issue_of_clock) {
  constexpr double kHour_s = 3600.0;
  if (!flag) return 4 * kHour_s;
  if (issue_of_clock >= 240 && issue_of_clock <= 247) return 8 * kHour_s;
  if ((issue_of_clock >= 248 && issue_of_clock <= 255) || issue_of_clock == 496) {
    return 14 * kHour_s;
  }
  if ((issue_of_clock >= 497 && issue_of_clock <= 503) ||
      (issue_of_clock >= 1021 && issue_of_clock <= 1023)) {
    return 26 * kHour_s;
  }
  if (issue_of_clock >= 504 && issue_of_clock <= 510) return 50 * kHour_s;
  if (issue_of_clock == 511 || (issue_of_clock >= 752 && issue_of_clock <= 756)) {
    return 74 * kHour_s;
  }
  if (issue_of_clock == 757) return 98 * kHour_s;
  return 6 * kHour_s;
}

// The limits leave room around what the ICDs' field widths can hold.
std::string_view ImplausibleElement(const KeplerEphemeris& e) {
  if (!Within(e.clock_bias_s, 0.1)) return "clock bias";
  if (!Within(e.clock_drift_sps, 1e-5)) return "clock drift";
  if (!Within(e.clock_drift_rate_sps2, 1e-9)) return "clock drift rate";
  if (!PlausibleSemiMajorAxis(e.satellite.system, e.semi_major_axis_m)) return "semi-major axis";
  if (!Within(e.semi_major_axis_rate_mps, 100.0)) return "semi-major axis rate";
  if (!Between(e.eccentricity, 0.0, LargestEccentricity(e.satellite.system))) return "eccentricity";
  if (!Within(e.mean_anomaly_rad, 2 * kPi)) return "mean anomaly";
  if (!Within(e.mean_motion_difference_radps, 1e-6)) return "mean motion difference";
  if (!Within(e.mean_motion_difference_rate_radps2, 1e-10)) return "mean motion difference rate";
  if (!Within(e.argument_of_perigee_rad, 2 * kPi)) return "argument of perigee";
  if (!Between(e.inclination_rad, -0.2, kPi)) return "inclination";
  if (!Within(e.inclination_rate_radps, 1e-6)) return "inclination rate";
  if (!Within(e.ascending_node_rad, 2 * kPi)) return "ascending node";
  if (!Within(e.ascending_node_rate_radps, 1e-6)) return "ascending node rate";
  if (!Within(e.cuc_rad, 1e-3)) return "cuc";
  if (!Within(e.cus_rad, 1e-3)) return "cus";
  if (!Within(e.cic_rad, 1e-3)) return "cic";
  if (!Within(e.cis_rad, 1e-3)) return "cis";
  if (!Within(e.crc_m, 4e4)) return "crc";
  if (!Within(e.crs_m, 4e4)) return "crs";
  // Both are renewed together; a day apart they belong to different sets.
  if (e.toe_gps_ns - e.toc_gps_ns > kDay_ns || e.toc_gps_ns - e.toe_gps_ns > kDay_ns) {
    return "time of ephemeris";
  }
  return {};
}

std::string_view ImplausibleElement(const StateEphemeris& e) {
  const bool glonass = e.satellite.system == System::kGlonass;
  if (!Within(e.clock_bias_s, 0.1)) return "clock bias";
  if (!Within(e.frequency_bias, 1e-5)) return "frequency bias";
  if (!Between(e.position_in_ecef.norm(), glonass ? 20e6 : 40e6, glonass ? 30e6 : 45e6)) {
    return "position";
  }
  if (!(e.velocity_in_ecef.norm() <= 6e3)) return "velocity";
  if (!(e.acceleration_in_ecef.norm() <= 0.1)) return "acceleration";
  return {};
}

}  // namespace lodemark
