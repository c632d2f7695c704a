// A navigation record as text, every field to its last bit but for those of time offsets, of which
// RINEX 3 keeps ten digits and RINEX 2 more. Two records are the same if their texts are.
#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include "core/gnss/ephemeris.h"

namespace lodemark::test {

class FieldText {
 public:
  void Add(const char* name, double value) {
    char text[64];
    std::snprintf(text, sizeof text, " %s=%a", name, value + 0.0);  // no negative zero
    text_ += text;
  }
  void Add(const char* name, const std::optional<double>& value) {
    if (value.value_or(0.0) != 0.0) Add(name, *value);  // absent and zero are written alike
  }
  void AddTime(const char* name, std::int64_t time_ns) {
    text_ += " " + std::string(name) + "=" + std::to_string(time_ns);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

inline std::string RecordText(const KeplerEphemeris& e) {
  FieldText t;
  t.Add("type", static_cast<int>(e.type));
  t.AddTime("toe", e.toe_gps_ns);
  t.AddTime("toc", e.toc_gps_ns);
  t.AddTime("sent", e.transmitted_gps_ns);
  t.Add("iod", e.issue_of_data);
  t.Add("iodc", e.issue_of_clock);
  t.Add("health", e.health);
  t.Add("healthy", e.healthy ? 1 : 0);
  t.Add("accuracy", e.accuracy_m);
  t.Add("fit", e.fit_interval_s);
  t.Add("af0", e.clock_bias_s);
  t.Add("af1", e.clock_drift_sps);
  t.Add("af2", e.clock_drift_rate_sps2);
  t.Add("a", e.semi_major_axis_m);
  t.Add("adot", e.semi_major_axis_rate_mps);
  t.Add("e", e.eccentricity);
  t.Add("m0", e.mean_anomaly_rad);
  t.Add("dn", e.mean_motion_difference_radps);
  t.Add("dndot", e.mean_motion_difference_rate_radps2);
  t.Add("w", e.argument_of_perigee_rad);
  t.Add("i", e.inclination_rad);
  t.Add("idot", e.inclination_rate_radps);
  t.Add("node", e.ascending_node_rad);
  t.Add("nodedot", e.ascending_node_rate_radps);
  t.Add("cuc", e.cuc_rad);
  t.Add("cus", e.cus_rad);
  t.Add("cic", e.cic_rad);
  t.Add("cis", e.cis_rad);
  t.Add("crc", e.crc_m);
  t.Add("crs", e.crs_m);
  t.Add("tgd", e.group_delays.tgd_s);
  t.Add("bgd5a", e.group_delays.bgd_e5a_e1_s);
  t.Add("bgd5b", e.group_delays.bgd_e5b_e1_s);
  t.Add("tgd1", e.group_delays.tgd1_s);
  t.Add("tgd2", e.group_delays.tgd2_s);
  return SatelliteName(e.satellite) + t.text();
}

inline std::string RecordText(const StateEphemeris& e) {
  FieldText t;
  t.Add("type", static_cast<int>(e.type));
  t.AddTime("toe", e.toe_gps_ns);
  t.AddTime("sent", e.transmitted_gps_ns);
  t.Add("channel", e.glonass_channel);
  t.Add("health", e.health);
  t.Add("healthy", e.healthy ? 1 : 0);
  t.Add("age", e.age_days);
  t.Add("accuracy", e.accuracy_m);
  t.Add("bias", e.clock_bias_s);
  t.Add("gamma", e.frequency_bias);
  for (int axis = 0; axis < 3; ++axis) {
    t.Add("x", e.position_in_ecef[axis]);
    t.Add("v", e.velocity_in_ecef[axis]);
    t.Add("a", e.acceleration_in_ecef[axis]);
  }
  return SatelliteName(e.satellite) + t.text();
}

inline std::string RecordText(const IonosphereMessage& message) {
  FieldText t;
  if (const auto* k = std::get_if<KlobucharParameters>(&message.model)) {
    for (const double value : k->alpha) t.Add("alpha", value);
    for (const double value : k->beta) t.Add("beta", value);
  } else if (const auto* g = std::get_if<GalileoIonosphereParameters>(&message.model)) {
    for (const double value : g->a) t.Add("a", value);
  }
  return std::string("ION ") + SystemLetter(message.satellite.system) + t.text();
}

inline std::string RecordText(const TimeOffsetMessage& message) {
  FieldText t;
  t.AddTime("at", message.reference_gps_ns);
  char text[64];
  std::snprintf(text, sizeof text, " a0=%.8e a1=%.8e", message.a0_s, message.a1_sps);
  return std::string("STO ") + std::string(message.label.data(), 4) + t.text() + text;
}

inline std::string RecordText(const EarthOrientationMessage&) { return "EOP"; }

inline std::string RecordText(const LeapSecondMessage& message) {
  return "LEAP " + std::to_string(message.leap_seconds);
}

inline std::string RecordText(const NavigationRecord& record) {
  return std::visit([](const auto& item) { return RecordText(item); }, record);
}

}  // namespace lodemark::test
