#include "core/logs/rinex_navigation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "test/unit/logs/rinex_text.h"

namespace lodemark {
namespace {

using test::Header;
using test::HeaderLine;
using test::NumberLine;
using test::RecordText;
using testing::HasSubstr;

struct Content {
  Status status;
  std::vector<NavigationRecord> records;
  ReadReport report;

  template <typename T>
  std::vector<T> All() const {
    std::vector<T> found;
    for (const NavigationRecord& record : records) {
      if (const T* item = std::get_if<T>(&record)) found.push_back(*item);
    }
    return found;
  }
};

Content Read(const std::string& text) {
  Content content;
  LineReader lines = LineReader::FromMemory("test.nav", text);
  content.status = ReadRinexNavigation(
      &lines, [&](const NavigationRecord& record) { content.records.push_back(record); },
      &content.report);
  return content;
}

std::int64_t At(int year, int month, int day, int hour, int minute, double second,
                TimeScale scale = TimeScale::kGps) {
  return GpsFromScale(*NanosecondsFromCalendar({year, month, day, hour, minute, second}), scale);
}

// Line by line, in the order of RINEX; every value differs from every other. Sunday 2023-01-08.
std::vector<double> LnavNumbers() {
  return {1e-4,    2e-12,  3e-18,             // clock
          11,      12.5,   4.1e-9,  0.5,      // IODE, crs, delta n, M0
          2.1e-6,  0.0123, 3.1e-6,  5153.7,   // cuc, e, cus, root of axis
          7200,    4.2e-8, 1.1,     5.2e-8,   // toe, cic, node, cis
          0.97,    250.5,  -1.2,    -8.1e-9,  // inclination, crc, perigee, node rate
          2.3e-10, 1,      2244,    0,        // inclination rate, codes, week
          2.8,     0,      -1.1e-8, 523,      // accuracy, health, delay, IODC
          6600,    4};                        // sent, fit
}

constexpr std::size_t kRootOfAxis = 10;
constexpr std::size_t kTimeOfEphemeris = 11;
constexpr std::size_t kWeek = 21;
constexpr std::size_t kAccuracy = 23;
constexpr std::size_t kHealth = 24;
constexpr std::size_t kSent = 27;

const std::string kGpsFile = Header("3.04", "N: GNSS NAV DATA    G: GPS");
const std::string kMixedFile = Header("3.04", "N: GNSS NAV DATA    M: MIXED");
const std::string kGpsEpoch = "G07 2023 01 08 02 00 00";

TEST(RinexNavigation, ReadsEveryFieldOfGpsLnav) {
  const Content content = Read(kGpsFile + RecordText(kGpsEpoch, 4, LnavNumbers()));
  ASSERT_TRUE(content.status.ok());
  EXPECT_EQ(content.report.rows_read, 1);
  EXPECT_EQ(content.report.rows_skipped, 0);
  ASSERT_EQ(content.records.size(), 1u);
  const auto& e = std::get<KeplerEphemeris>(content.records[0]);
  EXPECT_EQ(e.satellite, (SatelliteId{System::kGps, 7}));
  EXPECT_EQ(e.type, MessageType::kLnav);
  EXPECT_EQ(e.toc_gps_ns, At(2023, 1, 8, 2, 0, 0));
  EXPECT_EQ(e.toe_gps_ns, At(2023, 1, 8, 2, 0, 0));
  EXPECT_EQ(e.transmitted_gps_ns, At(2023, 1, 8, 1, 50, 0));
  EXPECT_EQ(e.issue_of_data, 11);
  EXPECT_EQ(e.issue_of_clock, 523);
  EXPECT_TRUE(e.healthy);
  EXPECT_EQ(e.accuracy_m, 2.8);
  EXPECT_EQ(e.fit_interval_s, 4 * 3600.0);
  EXPECT_EQ(e.clock_bias_s, 1e-4);
  EXPECT_EQ(e.clock_drift_sps, 2e-12);
  EXPECT_EQ(e.clock_drift_rate_sps2, 3e-18);
  EXPECT_DOUBLE_EQ(e.semi_major_axis_m, 5153.7 * 5153.7);
  EXPECT_EQ(e.eccentricity, 0.0123);
  EXPECT_EQ(e.mean_anomaly_rad, 0.5);
  EXPECT_EQ(e.mean_motion_difference_radps, 4.1e-9);
  EXPECT_EQ(e.argument_of_perigee_rad, -1.2);
  EXPECT_EQ(e.inclination_rad, 0.97);
  EXPECT_EQ(e.inclination_rate_radps, 2.3e-10);
  EXPECT_EQ(e.ascending_node_rad, 1.1);
  EXPECT_EQ(e.ascending_node_rate_radps, -8.1e-9);
  EXPECT_EQ(e.cuc_rad, 2.1e-6);
  EXPECT_EQ(e.cus_rad, 3.1e-6);
  EXPECT_EQ(e.cic_rad, 4.2e-8);
  EXPECT_EQ(e.cis_rad, 5.2e-8);
  EXPECT_EQ(e.crc_m, 250.5);
  EXPECT_EQ(e.crs_m, 12.5);
  EXPECT_EQ(e.group_delays.tgd_s, -1.1e-8);
}

TEST(RinexNavigation, Version2SaysTheSameInNarrowerColumnsAndDExponents) {
  std::string old_record = RecordText(" 7 23  1  8  2  0  0.0", 3, LnavNumbers());
  std::replace(old_record.begin(), old_record.end(), 'E', 'D');
  const Content old_file = Read(Header("2.11", "N: GPS NAV DATA") + old_record);
  const Content new_file = Read(kGpsFile + RecordText(kGpsEpoch, 4, LnavNumbers()));
  ASSERT_EQ(old_file.records.size(), 1u);
  const auto& a = std::get<KeplerEphemeris>(old_file.records[0]);
  const auto& b = std::get<KeplerEphemeris>(new_file.records[0]);
  EXPECT_EQ(a.satellite, b.satellite);
  EXPECT_EQ(a.toc_gps_ns, b.toc_gps_ns);
  EXPECT_EQ(a.toe_gps_ns, b.toe_gps_ns);
  EXPECT_EQ(a.transmitted_gps_ns, b.transmitted_gps_ns);
  EXPECT_EQ(a.mean_anomaly_rad, b.mean_anomaly_rad);
  EXPECT_EQ(a.inclination_rate_radps, b.inclination_rate_radps);
  EXPECT_EQ(a.issue_of_clock, b.issue_of_clock);
}

TEST(RinexNavigation, Version2CountsYearsFrom1980) {
  auto numbers = LnavNumbers();
  numbers[kTimeOfEphemeris] = 0;  // 1999-08-22 was a Sunday
  const Content content =
      Read(Header("2", "NAVIGATION DATA") + RecordText(" 7 99  8 22  0  0  0.0", 3, numbers));
  ASSERT_EQ(content.records.size(), 1u);
  EXPECT_EQ(std::get<KeplerEphemeris>(content.records[0]).toe_gps_ns, At(1999, 8, 22, 0, 0, 0));
}

TEST(RinexNavigation, FindsTheWeekOfEphemerisAndTransmissionByNearness) {
  auto numbers = LnavNumbers();
  numbers[kTimeOfEphemeris] = 0;
  numbers[kSent] = 604'200;  // ten minutes before, still in the week that ended
  numbers[kWeek] = 196;      // 2244 counted modulo 1024
  const Content content = Read(kGpsFile + RecordText("G07 2023 01 07 23 59 44", 4, numbers));
  ASSERT_EQ(content.records.size(), 1u);
  const auto& e = std::get<KeplerEphemeris>(content.records[0]);
  EXPECT_EQ(e.toe_gps_ns, At(2023, 1, 8, 0, 0, 0));
  EXPECT_EQ(e.toc_gps_ns, At(2023, 1, 7, 23, 59, 44));
  EXPECT_EQ(e.transmitted_gps_ns, At(2023, 1, 7, 23, 50, 0));
}

TEST(RinexNavigation, TransmissionTimeMayBeNegativeOrUnknown) {
  auto numbers = LnavNumbers();
  numbers[kSent] = -600;
  const Content negative = Read(kGpsFile + RecordText(kGpsEpoch, 4, numbers));
  numbers[kSent] = 0.9999e9;
  const Content unknown = Read(kGpsFile + RecordText(kGpsEpoch, 4, numbers));
  ASSERT_EQ(negative.records.size() + unknown.records.size(), 2u);
  EXPECT_EQ(std::get<KeplerEphemeris>(negative.records[0]).transmitted_gps_ns,
            At(2023, 1, 7, 23, 50, 0));
  EXPECT_EQ(std::get<KeplerEphemeris>(unknown.records[0]).transmitted_gps_ns, 0);
}

TEST(RinexNavigation, BeidouCountsInItsOwnTimeAndSendsD2FromAbove) {
  auto numbers = LnavNumbers();
  numbers[kRootOfAxis] = 6493.4;
  const Content content = Read(kMixedFile + RecordText("C05 2023 01 08 02 00 00", 4, numbers) +
                               RecordText("C06 2023 01 08 02 00 00", 4, numbers) +
                               RecordText("C59 2023 01 08 02 00 00", 4, numbers));
  const auto all = content.All<KeplerEphemeris>();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].toe_gps_ns, At(2023, 1, 8, 2, 0, 14));
  EXPECT_EQ(all[0].toc_gps_ns, At(2023, 1, 8, 2, 0, 14));
  EXPECT_EQ(all[0].transmitted_gps_ns, At(2023, 1, 8, 1, 50, 14));
  EXPECT_EQ(all[0].type, MessageType::kD2);
  EXPECT_EQ(all[1].type, MessageType::kD1);
  EXPECT_EQ(all[2].type, MessageType::kD2);
  EXPECT_EQ(all[1].group_delays.tgd1_s, -1.1e-8);
  EXPECT_FALSE(all[1].group_delays.tgd_s.has_value());
  EXPECT_EQ(all[1].issue_of_clock, 4);  // AODC takes the place of GPS's fit interval
}

// Data sources and health of RINEX 3.04 table A8.
KeplerEphemeris Galileo(int sources, int health, double accuracy_m) {
  auto numbers = LnavNumbers();
  numbers[kRootOfAxis] = 5440.6;
  numbers[20] = sources;
  numbers[kAccuracy] = accuracy_m;
  numbers[kHealth] = health;
  numbers[26] = 3e-9;  // E5b group delay
  const Content content = Read(kMixedFile + RecordText("E11 2023 01 08 02 00 00", 4, numbers));
  return std::get<KeplerEphemeris>(content.records.at(0));
}

TEST(RinexNavigation, GalileoDataSourcesTellTheMessage) {
  EXPECT_EQ(Galileo(513, 0, 3.12).type, MessageType::kInav);
  EXPECT_EQ(Galileo(516, 0, 3.12).type, MessageType::kInav);
  EXPECT_EQ(Galileo(517, 0, 3.12).type, MessageType::kInav);
  EXPECT_EQ(Galileo(258, 0, 3.12).type, MessageType::kFnav);
  EXPECT_EQ(Galileo(2, 0, 3.12).type, MessageType::kFnav);
  EXPECT_EQ(Galileo(0, 0, 3.12).type, MessageType::kInav);
  EXPECT_EQ(Galileo(517, 0, 3.12).group_delays.bgd_e5b_e1_s, 3e-9);
  EXPECT_FALSE(Galileo(258, 0, 3.12).group_delays.bgd_e5b_e1_s.has_value());
}

TEST(RinexNavigation, GalileoHealthIsThatOfTheMessagesOwnSignal) {
  constexpr int kE1Data = 1, kE1Health = 2, kE5aData = 8, kE5aHealth = 16, kE5bHealth = 128;
  EXPECT_FALSE(Galileo(517, kE1Data, 3.12).healthy);
  EXPECT_FALSE(Galileo(517, kE1Health, 3.12).healthy);
  EXPECT_TRUE(Galileo(517, kE5aHealth | kE5bHealth, 3.12).healthy);
  EXPECT_FALSE(Galileo(258, kE5aHealth, 3.12).healthy);
  EXPECT_FALSE(Galileo(258, kE5aData, 3.12).healthy);
  EXPECT_TRUE(Galileo(258, kE1Health, 3.12).healthy);
}

TEST(RinexNavigation, GalileoWithoutAccuracyPredictionIsUnhealthy) {
  EXPECT_TRUE(Galileo(517, 0, 3.12).healthy);
  EXPECT_FALSE(Galileo(517, 0, -1.0).healthy);
  EXPECT_EQ(Galileo(517, 0, -1.0).accuracy_m, 0.0);
}

TEST(RinexNavigation, HealthFollowsEachSystemsOwnBits) {
  const auto healthy = [](const std::string& name, double root, int health) {
    auto numbers = LnavNumbers();
    numbers[kRootOfAxis] = root;
    numbers[kHealth] = health;
    const Content content =
        Read(kMixedFile + RecordText(name + " 2023 01 08 02 00 00", 4, numbers));
    return std::get<KeplerEphemeris>(content.records.at(0)).healthy;
  };
  EXPECT_FALSE(healthy("G07", 5153.7, 1));
  EXPECT_FALSE(healthy("G07", 5153.7, 63));
  EXPECT_FALSE(healthy("C06", 6493.4, 1));
  EXPECT_TRUE(healthy("J02", 6493.4, 1));    // L1C/B is not sent
  EXPECT_FALSE(healthy("J02", 6493.4, 32));  // L1
  EXPECT_TRUE(healthy("I02", 6493.4, 1));    // S band
  EXPECT_FALSE(healthy("I02", 6493.4, 2));   // L5
}

std::vector<double> GlonassNumbers() {
  return {-2.5e-5, 9e-13, 2700,       // -TauN, GammaN, message frame time
          14000.5, -0.5,  -1e-9, 0,   // x, vx, ax, Bn
          -20000,  0.6,   2e-9,  -7,  // y, vy, ay, channel
          7000,    3.4,   0,     1};  // z, vz, az, age
}

TEST(RinexNavigation, ReadsGlonassInMetresAndGpsTime) {
  const Content content =
      Read(kMixedFile + RecordText("R09 2017 10 05 00 45 00", 4, GlonassNumbers()));
  ASSERT_EQ(content.records.size(), 1u);
  const auto& e = std::get<StateEphemeris>(content.records[0]);
  EXPECT_EQ(e.satellite, (SatelliteId{System::kGlonass, 9}));
  EXPECT_EQ(e.toe_gps_ns, At(2017, 10, 5, 0, 45, 18));          // 18 leap seconds
  EXPECT_EQ(e.transmitted_gps_ns, At(2017, 10, 5, 0, 45, 18));  // 2700 s into the UTC day
  EXPECT_EQ(e.clock_bias_s, -2.5e-5);
  EXPECT_EQ(e.frequency_bias, 9e-13);
  EXPECT_EQ(e.glonass_channel, -7);
  EXPECT_EQ(e.age_days, 1.0);
  EXPECT_TRUE(e.healthy);
  EXPECT_TRUE(e.position_in_ecef.isApprox(Eigen::Vector3d(14000.5e3, -20000e3, 7000e3), 1e-15));
  EXPECT_TRUE(e.velocity_in_ecef.isApprox(Eigen::Vector3d(-500, 600, 3400), 1e-15));
  EXPECT_TRUE(e.acceleration_in_ecef.isApprox(Eigen::Vector3d(-1e-6, 2e-6, 0), 1e-15));
}

TEST(RinexNavigation, GlonassFrameTimeCountsFromTheDayInVersion2AndTheWeekIn3) {
  const Content day = Read(Header("2.01", "GLONASS NAV DATA") +
                           RecordText(" 9 17 10  5  0 45  0.0", 3, GlonassNumbers()));
  auto numbers = GlonassNumbers();
  numbers[2] = 4 * 86'400 + 2700;  // Thursday
  const Content week = Read(kMixedFile + RecordText("R09 2017 10 05 00 45 00", 4, numbers));
  ASSERT_EQ(day.records.size() + week.records.size(), 2u);
  EXPECT_EQ(std::get<StateEphemeris>(day.records[0]).transmitted_gps_ns,
            At(2017, 10, 5, 0, 45, 18));
  EXPECT_EQ(std::get<StateEphemeris>(week.records[0]).transmitted_gps_ns,
            At(2017, 10, 5, 0, 45, 18));
}

TEST(RinexNavigation, GlonassFifthLineGivesAccuracyDelayAndHealth) {
  auto numbers = GlonassNumbers();
  numbers.insert(numbers.end(), {179, 8.4e-9, 2, 3});  // flags 3: almanac health, which is good
  const auto read = [&] {
    const Content content = Read(Header("3.05", "N: GNSS NAV DATA    M: MIXED") +
                                 RecordText("R09 2017 10 05 00 45 00", 4, numbers));
    return std::get<StateEphemeris>(content.records.at(0));
  };
  EXPECT_TRUE(read().healthy);
  EXPECT_EQ(read().accuracy_m, 2.5);
  EXPECT_EQ(read().l2_delay_s, 8.4e-9);
  numbers.back() = 4;  // l(3)
  EXPECT_FALSE(read().healthy);
  numbers[16] = numbers[17] = numbers[18] = 0.999999999999e9;
  EXPECT_TRUE(read().healthy);
  EXPECT_EQ(read().accuracy_m, 0.0);
  EXPECT_EQ(read().l2_delay_s, 0.0);
}

TEST(RinexNavigation, ReadsSbasAndItsMonitoring) {
  std::vector<double> numbers = {1e-9, 0, 7000, 40000, 0, 0, 0, 12000, 0, 0, 4, 10, 0, 0, 21};
  const auto read = [&] {
    const Content content = Read(kMixedFile + RecordText("S36 2023 01 08 02 00 00", 4, numbers));
    return std::get<StateEphemeris>(content.records.at(0));
  };
  EXPECT_EQ(read().satellite, (SatelliteId{System::kSbas, 36}));
  EXPECT_EQ(read().toe_gps_ns, At(2023, 1, 8, 2, 0, 0));
  EXPECT_EQ(read().transmitted_gps_ns, At(2023, 1, 8, 1, 56, 40));
  EXPECT_TRUE(read().healthy);
  numbers[10] = 32'767;
  EXPECT_FALSE(read().healthy);
}

TEST(RinexNavigation, ReadsGpsCnav) {
  const std::vector<double> numbers = {
      1e-4,     2e-12,           3e-18,  0.01,   12.5, 4.1e-9, 0.5,  2.1e-6, 0.0123,
      3.1e-6,   5153.7,          7200,   4.2e-8, 1.1,  5.2e-8, 0.97, 250.5,  -1.2,
      -8.1e-9,  2.3e-10,         -1e-13, -4,     1,    2,      1,    4.6e-9, 7,
      -3.4e-10, -4096 * 0x1p-35, 7.1e-9, 7.2e-9, 6,    2244};
  const Content content = Read(Header("4.00", "NAVIGATION DATA     M") + "> EPH G07 CNAV\n" +
                               RecordText(kGpsEpoch, 4, numbers));
  ASSERT_EQ(content.records.size(), 1u);
  const auto& e = std::get<KeplerEphemeris>(content.records[0]);
  EXPECT_EQ(e.type, MessageType::kCnav);
  EXPECT_EQ(e.toe_gps_ns, e.toc_gps_ns);
  EXPECT_EQ(e.semi_major_axis_rate_mps, 0.01);
  EXPECT_EQ(e.mean_motion_difference_rate_radps2, -1e-13);
  EXPECT_TRUE(e.healthy);                   // only L5 is flagged
  EXPECT_NEAR(e.accuracy_m, 4.031, 0.001);  // index 2: 4 m, index -4: 0.5 m
  EXPECT_EQ(e.group_delays.tgd_s, 4.6e-9);
  EXPECT_EQ(e.group_delays.isc_l1ca_s, -3.4e-10);
  EXPECT_FALSE(e.group_delays.isc_l2c_s.has_value());  // "not available"
  EXPECT_EQ(e.group_delays.isc_l5i5_s, 7.1e-9);
  EXPECT_EQ(e.group_delays.isc_l5q5_s, 7.2e-9);
  EXPECT_EQ(e.transmitted_gps_ns, At(2023, 1, 8, 0, 0, 6));
}

TEST(RinexNavigation, ReadsBeidouCnavAndItsIntegrity) {
  std::vector<double> numbers = {1e-4,   2e-12,  3e-18,   -2e-3,    12.5,   4.1e-9, 0.5,     2.1e-6,
                                 0.0012, 3.1e-6, 5282.6,  7200,     4.2e-8, 1.1,    5.2e-8,  0.97,
                                 250.5,  -1.2,   -8.1e-9, 2.3e-10,  3e-14,  3,      6600,    0,
                                 -4,     -1,     -1,      -8.7e-10, 0,      9.4e-9, -5.8e-9, 1,
                                 0,      0,      33,      6600,     0,      0,      34};
  const auto read = [&] {
    const Content content = Read(Header("4.00", "NAVIGATION DATA     M") + "> EPH C19 CNV1\n" +
                                 RecordText("C19 2023 01 08 02 00 00", 4, numbers));
    return std::get<KeplerEphemeris>(content.records.at(0));
  };
  const KeplerEphemeris e = read();
  EXPECT_EQ(e.type, MessageType::kCnav1);
  EXPECT_EQ(e.toe_gps_ns, At(2023, 1, 8, 2, 0, 14));
  EXPECT_EQ(e.transmitted_gps_ns, At(2023, 1, 8, 1, 50, 14));
  EXPECT_EQ(e.issue_of_clock, 33);
  EXPECT_EQ(e.issue_of_data, 34);
  EXPECT_EQ(e.group_delays.isc_b1cd_s, -8.7e-10);
  EXPECT_EQ(e.group_delays.tgd_b1cp_s, 9.4e-9);
  EXPECT_EQ(e.group_delays.tgd_b2ap_s, -5.8e-9);
  EXPECT_TRUE(e.healthy);
  numbers[32] = 1;  // health
  EXPECT_FALSE(read().healthy);
  numbers[32] = 0;
  numbers[33] = 4;  // data integrity
  EXPECT_FALSE(read().healthy);
}

TEST(RinexNavigation, ReadsTheSystemRecordsOfVersion4) {
  const Content content = Read(
      Header("4.00", "NAVIGATION DATA     M") + "> STO E   IFNV\n" +
      "    2023 01 08 00 00 00 GAGP\n" + NumberLine("    ", {45100, 1e-8, 1.8e-14, 0}) +
      "> EOP G27 CNVX\n" + NumberLine("    2023 01 08 16 51 12", {-0.04, 4e-5, 1e-9}) +
      NumberLine("    " + std::string(19, ' '), {0.35, 2e-3, 0}) +
      NumberLine("    ", {4392, -0.02, -1.4e-4, 0}) + "> ION G12 LNAV\n" +
      RecordText("    2023 01 08 00 08 54", 4,
                 {3e-8, 7e-9, -1e-7, -2e-7, 1.3e5, 2e4, -2.6e5, 1.4e5}) +
      "> ION J02 CNVX\n" +
      RecordText("    2023 01 08 00 08 54", 4,
                 {3e-8, 7e-9, -1e-7, -2e-7, 1.3e5, 2e4, -2.6e5, 1.4e5, 1}) +
      "> ION E02 IFNV\n" + RecordText("    2023 01 08 00 11 25", 4, {160.75, 0.37, 0.009, 5}) +
      "> ION C30 CNVX\n" +
      RecordText("    2023 01 08 00 00 00", 4, {35.5, 2, 12, 13.375, -17.25, 1.125, 1, 3, 0.375}));
  EXPECT_EQ(content.report.rows_read, 6);
  EXPECT_EQ(content.report.rows_skipped, 0);
  ASSERT_EQ(content.records.size(), 6u);
  const auto& offset = std::get<TimeOffsetMessage>(content.records[0]);
  EXPECT_EQ(std::string(offset.label.data(), 4), "GAGP");
  EXPECT_EQ(offset.satellite, (SatelliteId{System::kGalileo, 0}));
  EXPECT_EQ(offset.reference_gps_ns, At(2023, 1, 8, 0, 0, 0));
  EXPECT_EQ(offset.a0_s, 1e-8);
  EXPECT_EQ(offset.a1_sps, 1.8e-14);
  const auto& orientation = std::get<EarthOrientationMessage>(content.records[1]);
  EXPECT_EQ(orientation.x_arcsec[1], 4e-5);
  EXPECT_EQ(orientation.y_arcsec[0], 0.35);
  EXPECT_EQ(orientation.dut1_s[0], -0.02);
  const auto& gps = std::get<IonosphereMessage>(content.records[2]);
  EXPECT_EQ(gps.transmitted_gps_ns, At(2023, 1, 8, 0, 8, 54));
  EXPECT_EQ(std::get<KlobucharParameters>(gps.model).alpha[3], -2e-7);
  EXPECT_EQ(std::get<KlobucharParameters>(gps.model).beta[0], 1.3e5);
  EXPECT_EQ(std::get<KlobucharParameters>(gps.model).beta[3], 1.4e5);
  const auto& qzss = std::get<IonosphereMessage>(content.records[3]);
  EXPECT_EQ(std::get<KlobucharParameters>(qzss.model).region, 1);
  const auto& galileo = std::get<IonosphereMessage>(content.records[4]);
  EXPECT_EQ(std::get<GalileoIonosphereParameters>(galileo.model).a[2], 0.009);
  EXPECT_EQ(std::get<GalileoIonosphereParameters>(galileo.model).disturbance_flags, 5);
  const auto& beidou = std::get<IonosphereMessage>(content.records[5]);
  EXPECT_EQ(beidou.transmitted_gps_ns, At(2023, 1, 8, 0, 0, 14));
  EXPECT_EQ(std::get<BdgimParameters>(beidou.model).alpha[3], 13.375);
  EXPECT_EQ(std::get<BdgimParameters>(beidou.model).alpha[8], 0.375);
}

TEST(RinexNavigation, CountsMessagesItDoesNotKnow) {
  const Content content =
      Read(Header("4.01", "NAVIGATION DATA     M") + "> EPH R09 L1OC\n" +
           RecordText("R09 2017 10 05 00 45 00", 4, GlonassNumbers()) + "> EPH I02 L1NV\n" +
           RecordText("I02 2023 01 08 02 00 00", 4, LnavNumbers()) + "> XYZ G02 LNAV\n\n" +
           "> EPH G07 LNAV\n" + RecordText(kGpsEpoch, 4, LnavNumbers()));
  EXPECT_EQ(content.report.rows_unknown, 3);
  EXPECT_EQ(content.report.rows_read, 1);
  EXPECT_EQ(content.report.rows_skipped, 0);
}

TEST(RinexNavigation, HeaderOfVersion2GivesIonosphereTimeAndLeapSeconds) {
  const Content content =
      Read(Header("2.11", "N: GPS NAV DATA",
                  HeaderLine("    1.1180D-08  1.4900D-08 -5.9600D-08 -5.9500D-08", "ION ALPHA") +
                      HeaderLine("    8.8060D+04  1.6380D+04 -1.9660D+05 -1.3110D+05", "ION BETA") +
                      HeaderLine("   -2.793967723850D-09-5.329070518200D-15    61440     1316",
                                 "DELTA-UTC: A0,A1,T,W") +
                      HeaderLine("    13", "LEAP SECONDS")));
  ASSERT_EQ(content.records.size(), 3u);
  const auto& ionosphere = std::get<IonosphereMessage>(content.records[0]);
  EXPECT_EQ(std::get<KlobucharParameters>(ionosphere.model).alpha[3], -5.95e-8);
  EXPECT_EQ(std::get<KlobucharParameters>(ionosphere.model).beta[0], 88060.0);
  const auto& offset = std::get<TimeOffsetMessage>(content.records[1]);
  EXPECT_EQ(std::string(offset.label.data(), 4), "GPUT");
  EXPECT_EQ(offset.a0_s, -2.79396772385e-9);
  EXPECT_EQ(offset.a1_sps, -5.3290705182e-15);
  EXPECT_EQ(offset.reference_gps_ns, At(2005, 3, 27, 17, 4, 0));
  EXPECT_EQ(std::get<LeapSecondMessage>(content.records[2]).leap_seconds, 13);
}

TEST(RinexNavigation, HeaderOfVersion3GivesEverySystemsParameters) {
  const Content content = Read(Header(
      "3.04", "N: GNSS NAV DATA    M: MIXED",
      HeaderLine("GAL    1.4250D+02 -4.6484D-01 -6.4392D-03  0.0000D+00 J 01", "IONOSPHERIC CORR") +
          HeaderLine("BDSA   9.3132D-09  8.9407D-08 -1.0133D-06  2.0862D-06", "IONOSPHERIC CORR") +
          HeaderLine("IRNA   4.5635D-08  3.1292D-07 -8.9407D-07 -7.5102D-06", "IONOSPHERIC CORR") +
          HeaderLine("IRNB   1.4131D+05 -1.3107D+05 -8.3231D+06  8.3231D+06", "IONOSPHERIC CORR") +
          HeaderLine("BDSB   1.2493D+05 -6.8813D+05  6.8813D+06 -7.4056D+06", "IONOSPHERIC CORR") +
          HeaderLine("BDUT  1.0244548321D-08-2.042810365D-14  86386  888", "TIME SYSTEM CORR") +
          HeaderLine("IRUT  5.5879354477D-09 0.000000000D+00  86400 1220", "TIME SYSTEM CORR")));
  ASSERT_EQ(content.records.size(), 5u);
  const auto& galileo = std::get<IonosphereMessage>(content.records[0]);
  EXPECT_EQ(std::get<GalileoIonosphereParameters>(galileo.model).a[1], -0.46484);
  const auto& navic = std::get<IonosphereMessage>(content.records[1]);
  EXPECT_EQ(navic.satellite.system, System::kNavic);
  EXPECT_EQ(std::get<KlobucharParameters>(navic.model).alpha[1], 3.1292e-7);
  const auto& beidou = std::get<IonosphereMessage>(content.records[2]);
  EXPECT_EQ(std::get<KlobucharParameters>(beidou.model).system, System::kBeidou);
  EXPECT_EQ(std::get<KlobucharParameters>(beidou.model).beta[3], -7.4056e6);
  // Both refer to 2023-01-09 00:00:00 GPS time, one counted from 2006, one from 1999.
  EXPECT_EQ(std::get<TimeOffsetMessage>(content.records[3]).reference_gps_ns,
            At(2023, 1, 9, 0, 0, 0));
  EXPECT_EQ(std::get<TimeOffsetMessage>(content.records[4]).reference_gps_ns,
            At(2023, 1, 9, 0, 0, 0));
}

TEST(RinexNavigation, LeapSecondsOfBeidouCountFromGpsToo) {
  const auto leap = [](const std::string& type, const std::string& line) {
    const Content content = Read(Header("3.04", type, HeaderLine(line, "LEAP SECONDS")));
    return std::get<LeapSecondMessage>(content.records.at(0)).leap_seconds;
  };
  EXPECT_EQ(leap("N: GNSS NAV DATA    M: MIXED", "    18    18  1929     7"), 18);
  EXPECT_EQ(leap("N: GNSS NAV DATA    C: BDS", "     4     4   573     6"), 18);
  EXPECT_EQ(leap("N: GNSS NAV DATA    M: MIXED", "     4     4   573     6BDS"), 18);
  EXPECT_EQ(leap("N: GNSS NAV DATA    C: BDS", "    18"), 18);
}

TEST(RinexNavigation, BlankAndMissingTrailingFieldsAreZero) {
  auto numbers = LnavNumbers();
  numbers.resize(kSent);  // no last line
  std::string text = RecordText(kGpsEpoch, 4, numbers);
  text.erase(text.size() - 1 - 19, 19);  // nor the issue of clock
  const Content content = Read(kGpsFile + text);
  ASSERT_EQ(content.records.size(), 1u);
  EXPECT_EQ(content.report.rows_skipped, 0);
  EXPECT_EQ(std::get<KeplerEphemeris>(content.records[0]).issue_of_clock, 0);
  EXPECT_EQ(std::get<KeplerEphemeris>(content.records[0]).transmitted_gps_ns, 0);
}

TEST(RinexNavigation, SkipsImpossibleOrbitsNamingThePlace) {
  const auto problem = [](std::size_t index, double value) {
    auto numbers = LnavNumbers();
    numbers[index] = value;
    const Content content = Read(kGpsFile + RecordText(kGpsEpoch, 4, numbers) +
                                 RecordText("G08 2023 01 08 02 00 00", 4, LnavNumbers()));
    EXPECT_EQ(content.report.rows_read, 1);
    EXPECT_EQ(content.report.rows_skipped, 1);
    return content.report.problems.empty()
               ? std::string()
               : FormatProblem(content.report.file, content.report.problems[0]);
  };
  EXPECT_THAT(problem(0, 0.2), HasSubstr("test.nav:3:24: "));
  EXPECT_THAT(problem(8, 0.9), HasSubstr("test.nav:5:24: "));
  EXPECT_THAT(problem(8, 0.9), HasSubstr("eccentricity"));
  EXPECT_THAT(problem(8, -0.1), HasSubstr("eccentricity"));
  EXPECT_THAT(problem(kRootOfAxis, 0), HasSubstr("test.nav:5:62: "));
  EXPECT_THAT(problem(kRootOfAxis, 6493), HasSubstr("semi-major axis"));
  EXPECT_THAT(problem(kTimeOfEphemeris, 300'000), HasSubstr("test.nav:6:5: "));
  EXPECT_THAT(problem(17, 1e3), HasSubstr("argument of perigee"));
}

TEST(RinexNavigation, SkipsTextThatIsNoNumber) {
  std::string record = RecordText(kGpsEpoch, 4, LnavNumbers());
  record.replace(record.find("1.230000000000E-02"), 6, "1.2x00");
  const Content content = Read(kGpsFile + record);
  EXPECT_EQ(content.report.rows_read, 0);
  ASSERT_EQ(content.report.problems.size(), 1u);
  EXPECT_EQ(content.report.problems[0].line, 5);
  EXPECT_EQ(content.report.problems[0].column, 24);
  for (const std::string not_a_number : {"nan", "inf", "1e999"}) {
    std::string other = RecordText(kGpsEpoch, 4, LnavNumbers());
    other.replace(other.find("1.230000000000E-02"), 18,
                  std::string(18 - not_a_number.size(), ' ') + not_a_number);
    EXPECT_EQ(Read(kGpsFile + other).report.rows_read, 0) << not_a_number;
  }
}

TEST(RinexNavigation, SkipsGlonassThatIsNotWhereGlonassIs) {
  auto numbers = GlonassNumbers();
  numbers[3] = 1e5;
  const Content content = Read(kMixedFile + RecordText("R09 2017 10 05 00 45 00", 4, numbers));
  ASSERT_EQ(content.report.problems.size(), 1u);
  EXPECT_THAT(content.report.problems[0].message, HasSubstr("position"));
}

TEST(RinexNavigation, FindsItsFeetAfterGarbage) {
  const std::string good = RecordText(kGpsEpoch, 4, LnavNumbers());
  std::string decapitated = good.substr(good.find('\n') + 1);
  const Content content = Read(kGpsFile + decapitated + good + "what is this\n" + good +
                               good.substr(0, 300) + "\n" + good + "\n\n" + good);
  EXPECT_EQ(content.report.rows_read, 4);
  EXPECT_EQ(content.report.rows_skipped, 3);
  ASSERT_EQ(content.report.problems.size(), 3u);
  EXPECT_THAT(content.report.problems[0].message, HasSubstr("no record"));
  EXPECT_THAT(content.report.problems[1].message, HasSubstr("neither starts nor continues"));
  EXPECT_THAT(content.report.problems[2].message, HasSubstr("ends after"));
}

TEST(RinexNavigation, SkipsSatellitesThatCannotBe) {
  const Content content = Read(kGpsFile + RecordText("G77 2023 01 08 02 00 00", 4, LnavNumbers()) +
                               RecordText("G07 2023 13 08 02 00 00", 4, LnavNumbers()) +
                               RecordText("X07 2023 01 08 02 00 00", 4, LnavNumbers()));
  EXPECT_EQ(content.report.rows_read, 0);
  EXPECT_EQ(content.report.rows_skipped, 2);
  EXPECT_EQ(content.report.rows_unknown, 1);
}

TEST(RinexNavigation, ReadsFilesStrungTogether) {
  const std::string file = kGpsFile + RecordText(kGpsEpoch, 4, LnavNumbers());
  const Content content = Read(file + file);
  EXPECT_EQ(content.report.rows_read, 2);
  EXPECT_EQ(content.report.rows_skipped, 0);
}

TEST(RinexNavigation, RefusesOtherFilesWithAReason) {
  const Content text = Read("Once upon a time\nthere was a file\n");
  ASSERT_FALSE(text.status.ok());
  EXPECT_THAT(text.status.error().message, HasSubstr("test.nav:1: not a RINEX file"));
  const Content observation = Read(Header("3.04", "OBSERVATION DATA    M"));
  ASSERT_FALSE(observation.status.ok());
  EXPECT_THAT(observation.status.error().message, HasSubstr("not navigation"));
  const Content future = Read(Header("5.00", "NAVIGATION DATA     M"));
  ASSERT_FALSE(future.status.ok());
  EXPECT_EQ(future.status.error().code, ErrorCode::kUnsupported);
  const Content endless = Read(kGpsFile.substr(0, 81));
  ASSERT_FALSE(endless.status.ok());
  EXPECT_THAT(endless.status.error().message, HasSubstr("END OF HEADER"));
}

}  // namespace
}  // namespace lodemark
