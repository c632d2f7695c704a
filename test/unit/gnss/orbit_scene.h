// Broadcast sets that tests start from: the size and shape of real ones, with invented values.
#pragma once

#include <cstdint>

#include "core/base/units.h"
#include "core/gnss/ephemeris.h"

namespace lodemark {

inline constexpr std::int64_t kSceneToe_ns = 2'300 * kWeek_ns + 295'200 * kSecond_ns;

// A pure Kepler orbit: no corrections, no rates.
inline KeplerEphemeris PlainSet(SatelliteId satellite, MessageType type) {
  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = type;
  e.toe_gps_ns = kSceneToe_ns;
  e.toc_gps_ns = kSceneToe_ns;
  e.transmitted_gps_ns = kSceneToe_ns - 7'200 * kSecond_ns;
  e.issue_of_data = 17;
  e.issue_of_clock = 17;
  const bool high = satellite.system == System::kQzss || satellite.system == System::kNavic ||
                    (satellite.system == System::kBeidou && satellite.number <= 10);
  e.semi_major_axis_m = high                                   ? 42.164e6
                        : satellite.system == System::kGalileo ? 29.6e6
                        : satellite.system == System::kBeidou  ? 27.906e6
                                                               : 26.5604e6;
  e.eccentricity = 0.012;
  e.mean_anomaly_rad = 0.7;
  e.argument_of_perigee_rad = -1.1;
  e.inclination_rad = 0.96;
  e.ascending_node_rad = 2.3;
  return e;
}

// The same with corrections, rates and a clock.
inline KeplerEphemeris FullSet(SatelliteId satellite, MessageType type) {
  KeplerEphemeris e = PlainSet(satellite, type);
  e.mean_motion_difference_radps = 4.1e-9;
  e.inclination_rate_radps = 2.3e-10;
  e.ascending_node_rate_radps = -8.2e-9;
  e.cuc_rad = 2.6e-6;
  e.cus_rad = 7.9e-6;
  e.cic_rad = 9.7e-8;
  e.cis_rad = -2.8e-7;
  e.crc_m = 262.0;
  e.crs_m = -87.0;
  e.clock_bias_s = 2.3e-4;
  e.clock_drift_sps = -4.8e-12;
  e.clock_drift_rate_sps2 = 1.1e-17;
  if (type != MessageType::kLnav && type != MessageType::kInav && type != MessageType::kFnav &&
      type != MessageType::kD1 && type != MessageType::kD2) {
    e.semi_major_axis_rate_mps = -0.011;
    e.mean_motion_difference_rate_radps2 = 3.0e-14;
  }
  return e;
}

inline StateEphemeris GlonassSet(int slot) {
  StateEphemeris e;
  e.satellite = {System::kGlonass, static_cast<std::uint8_t>(slot)};
  e.toe_gps_ns = kSceneToe_ns;
  e.transmitted_gps_ns = kSceneToe_ns - 900 * kSecond_ns;
  e.glonass_channel = -4;
  e.clock_bias_s = -2.3e-5;
  e.frequency_bias = 9.1e-13;
  e.l2_delay_s = 3.7e-9;
  e.position_in_ecef = {19'149'780.2, 16'776'976.8, 709'889.0};
  e.velocity_in_ecef = {186.57, -69.78, -3'582.94};
  e.acceleration_in_ecef = {1.9e-6, -9.3e-7, 0.0};
  return e;
}

}  // namespace lodemark
