#include "core/logs/rinex_navigation_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/geo/time.h"
#include "core/logs/rinex_navigation.h"
#include "test/unit/logs/navigation_record_text.h"

namespace lodemark {
namespace {

using testing::HasSubstr;

std::vector<NavigationRecord> ReadBack(const std::string& text) {
  std::vector<NavigationRecord> records;
  LineReader lines = LineReader::FromMemory("written", text);
  ReadReport report;
  const Status status = ReadRinexNavigation(
      &lines, [&](const NavigationRecord& record) { records.push_back(record); }, &report);
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(report.rows_skipped, 0);
  EXPECT_EQ(report.rows_unknown, 0);
  return records;
}

NavigationRecord Through(const NavigationRecord& record) {
  const RinexNavigationFile file = WriteRinexNavigation(std::vector{record}, {});
  const std::vector<NavigationRecord> records = ReadBack(file.text);
  return records.empty() ? NavigationRecord() : records.back();
}

constexpr std::int64_t kSunday_ns = 2244 * 604'800'000'000'000;  // 2023-01-08 GPS time

KeplerEphemeris Orbit(SatelliteId satellite, MessageType type, double root_of_axis) {
  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = type;
  e.toe_gps_ns = kSunday_ns + 7'200'000'000'000;
  e.toc_gps_ns = kSunday_ns + 7'184'000'000'000;
  e.transmitted_gps_ns = kSunday_ns - 600'000'000'000;
  e.issue_of_data = 11;
  e.accuracy_m = 2.8;
  e.clock_bias_s = -1.23456789e-4;
  e.clock_drift_sps = 2e-12;
  e.semi_major_axis_m = root_of_axis * root_of_axis;
  e.eccentricity = 0.0123;
  e.mean_anomaly_rad = -3.1;
  e.mean_motion_difference_radps = 4.1e-9;
  e.argument_of_perigee_rad = 1.2;
  e.inclination_rad = 0.97;
  e.inclination_rate_radps = -2.3e-10;
  e.ascending_node_rad = 0.1;
  e.ascending_node_rate_radps = -8.1e-9;
  e.cuc_rad = 2.1e-6;
  e.cus_rad = 3.1e-6;
  e.cic_rad = 4.2e-8;
  e.cis_rad = -5.2e-8;
  e.crc_m = 250.5;
  e.crs_m = -12.5;
  return e;
}

TEST(RinexNavigationWriter, OrbitsOfEverySystemComeBackTheSame) {
  KeplerEphemeris gps = Orbit({System::kGps, 7}, MessageType::kLnav, 5153.7);
  gps.group_delays.tgd_s = -1.1e-8;
  gps.issue_of_clock = 267;
  gps.fit_interval_s = 4 * 3600;
  KeplerEphemeris qzss = Orbit({System::kQzss, 2}, MessageType::kLnav, 6493.4);
  qzss.issue_of_clock = 989;
  qzss.health = 1;
  KeplerEphemeris navic = Orbit({System::kNavic, 3}, MessageType::kLnav, 6493.4);
  navic.issue_of_clock = navic.issue_of_data;
  KeplerEphemeris inav = Orbit({System::kGalileo, 11}, MessageType::kInav, 5440.6);
  inav.issue_of_clock = inav.issue_of_data;
  inav.group_delays.bgd_e5a_e1_s = 2e-9;
  inav.group_delays.bgd_e5b_e1_s = 3e-9;
  KeplerEphemeris fnav = inav;
  fnav.type = MessageType::kFnav;
  fnav.group_delays.bgd_e5b_e1_s.reset();
  KeplerEphemeris merged = inav;
  merged.type = MessageType::kFnav;
  KeplerEphemeris d1 = Orbit({System::kBeidou, 19}, MessageType::kD1, 5282.6);
  d1.group_delays.tgd1_s = 5e-9;
  d1.group_delays.tgd2_s = -6e-9;
  d1.issue_of_clock = 3;
  d1.toe_gps_ns += 14'000'000'000;  // whole hours of BeiDou time
  KeplerEphemeris d2 = Orbit({System::kBeidou, 2}, MessageType::kD2, 6493.4);
  for (const KeplerEphemeris& e : {gps, qzss, navic, inav, fnav, merged, d1, d2}) {
    EXPECT_EQ(test::RecordText(Through(e)), test::RecordText(e));
  }
}

TEST(RinexNavigationWriter, UnknownTransmissionAndMissingPredictionComeBack) {
  KeplerEphemeris e = Orbit({System::kGalileo, 11}, MessageType::kInav, 5440.6);
  e.issue_of_clock = e.issue_of_data;
  e.transmitted_gps_ns = 0;
  e.accuracy_m = 0.0;
  e.healthy = false;
  EXPECT_EQ(test::RecordText(Through(e)), test::RecordText(e));
}

StateEphemeris Glonass() {
  StateEphemeris e;
  e.satellite = {System::kGlonass, 9};
  e.toe_gps_ns = kSunday_ns + 2'718'000'000'000;  // 00:45 UTC
  e.transmitted_gps_ns = kSunday_ns + 918'000'000'000;
  e.glonass_channel = -7;
  e.age_days = 1;
  e.clock_bias_s = -2.5e-5;
  e.frequency_bias = 9e-13;
  e.position_in_ecef = {14000.5e3, -20000e3, 7000e3};
  e.velocity_in_ecef = {-500, 600, 3400};
  e.acceleration_in_ecef = {1000 * -1e-9, 1000 * 2e-9, 0};  // as read from kilometres
  return e;
}

TEST(RinexNavigationWriter, GlonassAndSbasComeBackTheSame) {
  const StateEphemeris glonass = Glonass();
  EXPECT_EQ(test::RecordText(Through(glonass)), test::RecordText(glonass));
  StateEphemeris sbas = Glonass();
  sbas.satellite = {System::kSbas, 36};
  sbas.type = MessageType::kSbas;
  sbas.glonass_channel = kUnknownGlonassChannel;
  sbas.age_days = 0;
  sbas.accuracy_m = 4;
  sbas.position_in_ecef = {40000e3, 12000e3, 0};
  sbas.toe_gps_ns = kSunday_ns + 7'200'000'000'000;
  EXPECT_EQ(test::RecordText(Through(sbas)), test::RecordText(sbas));
}

TEST(RinexNavigationWriter, GlonassUnhealthyByItsThirdStringStaysUnhealthy) {
  StateEphemeris glonass = Glonass();
  glonass.healthy = false;
  EXPECT_FALSE(std::get<StateEphemeris>(Through(glonass)).healthy);
}

TEST(RinexNavigationWriter, HeaderParametersComeBackTheSame) {
  KlobucharParameters beidou;
  beidou.system = System::kBeidou;
  beidou.alpha = {9.3132e-9, 8.9407e-8, -1.0133e-6, 2.0862e-6};
  beidou.beta = {1.2493e5, -6.8813e5, 6.8813e6, -7.4056e6};
  GalileoIonosphereParameters galileo;
  galileo.a = {142.5, -0.46484, -6.4392e-3};
  TimeOffsetMessage gps_utc;
  gps_utc.satellite = {System::kGps, 0};
  gps_utc.label = {'G', 'P', 'U', 'T'};
  gps_utc.reference_gps_ns = kSunday_ns + 61'440'000'000'000;
  gps_utc.a0_s = -9.3132257462e-10;
  gps_utc.a1_sps = -7.993605777e-15;
  TimeOffsetMessage beidou_utc = gps_utc;
  beidou_utc.satellite = {System::kBeidou, 0};
  beidou_utc.label = {'B', 'D', 'U', 'T'};
  const std::vector<NavigationRecord> records = {
      IonosphereMessage{{System::kBeidou, 0}, 0, beidou},
      IonosphereMessage{{System::kGalileo, 0}, 0, galileo}, beidou_utc, gps_utc,
      LeapSecondMessage{18}};
  const RinexNavigationFile file = WriteRinexNavigation(records, {});
  EXPECT_EQ(file.records_written, 5);
  const std::vector<NavigationRecord> back = ReadBack(file.text);
  ASSERT_EQ(back.size(), records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(test::RecordText(back[i]), test::RecordText(records[i]));
  }
}

TEST(RinexNavigationWriter, KeepsTheLastOfEachHeaderParameter) {
  const std::vector<NavigationRecord> records = {LeapSecondMessage{17}, LeapSecondMessage{18}};
  const auto back = ReadBack(WriteRinexNavigation(records, {}).text);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(std::get<LeapSecondMessage>(back[0]).leap_seconds, 18);
}

TEST(RinexNavigationWriter, CountsWhatVersion304CannotHold) {
  const std::vector<NavigationRecord> records = {
      Orbit({System::kGps, 7}, MessageType::kCnav, 5153.7),
      Orbit({System::kBeidou, 19}, MessageType::kCnav1, 5282.6),
      IonosphereMessage{{System::kBeidou, 0}, 0, BdgimParameters{}}, EarthOrientationMessage{}};
  const RinexNavigationFile file = WriteRinexNavigation(records, {});
  EXPECT_EQ(file.records_written, 0);
  EXPECT_EQ(file.records_left_out, 4);
}

TEST(RinexNavigationWriter, EveryLineHasItsColumns) {
  const KeplerEphemeris gps = Orbit({System::kGps, 7}, MessageType::kLnav, 5153.7);
  RinexNavigationWriterOptions options;
  options.program = "a name longer than twenty";
  options.date = "20230108 000000 UTC";
  const std::string text =
      WriteRinexNavigation(std::vector<NavigationRecord>{gps, LeapSecondMessage{18}}, options).text;
  EXPECT_THAT(text, HasSubstr("     3.04           N: GNSS NAV DATA    G: GPS              "
                              "RINEX VERSION / TYPE\n"));
  EXPECT_THAT(text, HasSubstr("a name longer than t                    20230108 000000 UTC "
                              "PGM / RUN BY / DATE\n"));
  EXPECT_THAT(text, HasSubstr("    18                                                      "
                              "LEAP SECONDS\n"));
  EXPECT_THAT(text, HasSubstr("\nG07 2023 01 08 01 59 44-1.234567890000D-04 2.000000000000D-12"
                              " 0.000000000000D+00\n"));
  EXPECT_THAT(text, HasSubstr("\n     7.200000000000D+03 4.200000000000D-08"));
}

}  // namespace
}  // namespace lodemark
