// What satellites broadcast about their orbits and clocks, the ionosphere and the time scales.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "core/geo/time.h"
#include "core/gnss/signal.h"

namespace lodemark {

// Message a set of parameters came in. QZSS and NavIC use the GPS-like kinds.
enum class MessageType : std::uint8_t {
  kLnav,         // GPS, QZSS, NavIC
  kCnav,         // GPS, QZSS (L2C, L5)
  kCnav2,        // GPS, QZSS (L1C)
  kInav,         // Galileo E1, E5b
  kFnav,         // Galileo E5a
  kD1,           // BeiDou MEO, IGSO
  kD2,           // BeiDou GEO
  kCnav1,        // BeiDou B1C
  kCnav2Beidou,  // BeiDou B2a
  kCnav3,        // BeiDou B2b
  kFdma,         // GLONASS
  kL1Nav,        // NavIC L1
  kSbas,
};

// Differential group delays in seconds, present where the message carries them. A signal's
// correction follows from these by the ICD's rule for that signal.
struct GroupDelays {
  std::optional<double> tgd_s;       // GPS, QZSS, NavIC: TGD
  std::optional<double> isc_l1ca_s;  // GPS, QZSS CNAV
  std::optional<double> isc_l2c_s;
  std::optional<double> isc_l5i5_s;
  std::optional<double> isc_l5q5_s;
  std::optional<double> isc_l1cd_s;
  std::optional<double> isc_l1cp_s;
  std::optional<double> bgd_e5a_e1_s;  // Galileo
  std::optional<double> bgd_e5b_e1_s;
  std::optional<double> tgd1_s;      // BeiDou B1I against B3I
  std::optional<double> tgd2_s;      // BeiDou B2I against B3I
  std::optional<double> tgd_b1cp_s;  // BeiDou CNAV
  std::optional<double> tgd_b2ap_s;
  std::optional<double> tgd_b2bi_s;
  std::optional<double> isc_b1cd_s;
  std::optional<double> isc_b2ad_s;
};

// Keplerian elements with harmonic corrections and a clock polynomial: GPS, Galileo, BeiDou, QZSS,
// NavIC. Angles in radians, lengths in metres, times as GPS time.
struct KeplerEphemeris {
  SatelliteId satellite;
  MessageType type = MessageType::kLnav;
  std::int64_t toe_gps_ns = 0;          // reference time of the orbit
  std::int64_t toc_gps_ns = 0;          // reference time of the clock
  std::int64_t transmitted_gps_ns = 0;  // when the message was sent; 0 if unknown
  std::int32_t issue_of_data = 0;       // IODE, IODnav, AODE
  std::int32_t issue_of_clock = 0;
  std::int32_t health = 0;      // as broadcast; see healthy
  bool healthy = true;          // the reader's verdict from the message's own bits
  double accuracy_m = 0.0;      // URA or SISA as a 1 sigma range, 0 if unknown
  double fit_interval_s = 0.0;  // 0: the system's usual
  double clock_bias_s = 0.0;
  double clock_drift_sps = 0.0;
  double clock_drift_rate_sps2 = 0.0;
  double semi_major_axis_m = 0.0;  // at toe
  double semi_major_axis_rate_mps = 0.0;
  double eccentricity = 0.0;
  double mean_anomaly_rad = 0.0;
  double mean_motion_difference_radps = 0.0;
  double mean_motion_difference_rate_radps2 = 0.0;
  double argument_of_perigee_rad = 0.0;
  double inclination_rad = 0.0;
  double inclination_rate_radps = 0.0;
  double ascending_node_rad = 0.0;  // longitude at the start of the week
  double ascending_node_rate_radps = 0.0;
  double cuc_rad = 0.0;
  double cus_rad = 0.0;
  double cic_rad = 0.0;
  double cis_rad = 0.0;
  double crc_m = 0.0;
  double crs_m = 0.0;
  GroupDelays group_delays;
};

// Position, velocity and acceleration at a reference time, to be integrated: GLONASS, SBAS.
// Earth-fixed, PZ-90.11 (GLONASS) or WGS 84.
struct StateEphemeris {
  SatelliteId satellite;
  MessageType type = MessageType::kFdma;
  std::int64_t toe_gps_ns = 0;
  std::int64_t transmitted_gps_ns = 0;  // 0 if unknown
  std::int8_t glonass_channel = kUnknownGlonassChannel;
  std::int32_t health = 0;
  bool healthy = true;
  double age_days = 0.0;
  double accuracy_m = 0.0;
  double clock_bias_s = 0.0;    // satellite clock minus system time (RINEX: -TauN)
  double frequency_bias = 0.0;  // relative, +GammaN
  double l2_delay_s = 0.0;      // L2 minus L1 (delta tau N), 0 if unknown
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_in_ecef = Eigen::Vector3d::Zero();  // sun and moon
};

struct KlobucharParameters {
  System system = System::kGps;
  std::array<double, 4> alpha = {};  // s, s/semicircle, ...
  std::array<double, 4> beta = {};
  std::int32_t region = 0;  // QZSS: 0 for its whole area, 1 for Japan only
};

// Galileo's effective ionisation coefficients, for NeQuick-G and NTCM-G.
struct GalileoIonosphereParameters {
  std::array<double, 3> a = {};  // sfu, sfu/deg, sfu/deg^2
  std::int32_t disturbance_flags = 0;
};

struct BdgimParameters {
  std::array<double, 9> alpha = {};  // TECu
};

struct IonosphereMessage {
  SatelliteId satellite;                // sender; number 0: the whole system
  std::int64_t transmitted_gps_ns = 0;  // 0 if unknown
  std::variant<KlobucharParameters, GalileoIonosphereParameters, BdgimParameters> model;
};

// A system's time against another: a0 + a1 (t - reference) + a2 (t - reference)^2.
struct TimeOffsetMessage {
  SatelliteId satellite;
  std::int64_t reference_gps_ns = 0;
  std::array<char, 4> label = {};  // the two scales, as RINEX 4 writes them: "GPUT", "GAGP"
  double a0_s = 0.0;
  double a1_sps = 0.0;
  double a2_sps2 = 0.0;
};

struct EarthOrientationMessage {
  SatelliteId satellite;
  std::int64_t reference_gps_ns = 0;
  std::array<double, 3> x_arcsec = {};  // value, per day, per day^2
  std::array<double, 3> y_arcsec = {};
  std::array<double, 3> dut1_s = {};
};

struct LeapSecondMessage {
  std::int32_t leap_seconds = 0;  // GPS minus UTC
};

using NavigationRecord =
    std::variant<KeplerEphemeris, StateEphemeris, IonosphereMessage, TimeOffsetMessage,
                 EarthOrientationMessage, LeapSecondMessage>;

}  // namespace lodemark
