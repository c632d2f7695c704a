#include "core/logs/sensor_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace lodemark {
namespace {

std::vector<SensorRow> RowsOf(SensorTableReader* reader) {
  std::vector<SensorRow> rows;
  SensorRow row;
  while (reader->Next(&row)) rows.push_back(row);
  return rows;
}

// The text outlives the reader.
SensorTableReader Read(std::string_view text, std::string_view columns = {}) {
  Result<SensorTableReader> reader =
      SensorTableReader::FromLines(LineReader::FromMemory("imu.csv", text), columns);
  EXPECT_TRUE(reader.ok()) << (reader.ok() ? "" : reader.error().message);
  return std::move(reader).value();
}

std::string Refusal(std::string_view text, std::string_view columns = {}) {
  const Result<SensorTableReader> reader =
      SensorTableReader::FromLines(LineReader::FromMemory("imu.csv", text), columns);
  return reader.ok() ? "" : reader.error().message;
}

TEST(SensorTable, ReadsItsOwnColumnsInAnyOrder) {
  constexpr std::string_view kText =
      "gyro_z_radps,time_gps_ns,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,"
      "pressure_hpa,colour\n"
      "0.3,1380000000000000001,0.1,-0.2,9.8,0.1,0.2,1013.25,red\n"
      "0.3,1380000000010000001,,,,0.1,0.2,,red\n";
  SensorTableReader reader = Read(kText);
  const std::vector<SensorRow> rows = RowsOf(&reader);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].time_ns, 1380000000000000001);
  EXPECT_EQ(rows[0].force_mps2, (std::array{0.1, -0.2, 9.8}));
  EXPECT_EQ(rows[0].turn_rate_radps, (std::array{0.1, 0.2, 0.3}));
  EXPECT_EQ(rows[0].pressure_hpa, 1013.25);
  EXPECT_FALSE(rows[0].speed_mps.has_value());
  EXPECT_FALSE(rows[1].force_mps2.has_value());
  EXPECT_TRUE(rows[1].turn_rate_radps.has_value());
  EXPECT_FALSE(reader.is_relative());
  EXPECT_EQ(reader.report().rows_read, 2);
  EXPECT_EQ(reader.report().rows_skipped, 0);
}

TEST(SensorTable, ReadsOdometry) {
  SensorTableReader reader =
      Read("time_gps_ns,speed_kmh,yaw_rate_degps\n1380000000000000000,36,-90\n");
  const std::vector<SensorRow> rows = RowsOf(&reader);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_NEAR(*rows[0].speed_mps, 10.0, 1e-12);
  EXPECT_NEAR(*rows[0].yaw_rate_radps, -std::acos(0.0), 1e-12);
}

TEST(SensorTable, ReadsTheHeaderOfEuroc) {
  SensorTableReader reader = Read(
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
      "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
      "1380000000000000000,1,2,3,4,5,6\n");
  const std::vector<SensorRow> rows = RowsOf(&reader);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].turn_rate_radps, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(rows[0].force_mps2, (std::array{4.0, 5.0, 6.0}));
}

TEST(SensorTable, TakesTheColumnsThatAManifestStates) {
  SensorTableReader reader =
      Read("t a a a\n100.25,1,0,0\n", "time_s,accel_x_g,accel_y_g,accel_z_g");
  const std::vector<SensorRow> rows = RowsOf(&reader);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(reader.is_relative());
  EXPECT_EQ(rows[0].time_ns, 100'250'000'000);
  EXPECT_NEAR((*rows[0].force_mps2)[0], 9.80665, 1e-12);
}

// 2017-01-01 00:00:00 UTC is 18 s later in GPS time, which began 315,964,800 s after 1970.
TEST(SensorTable, CountsTimeAsTheColumnSays) {
  const std::int64_t expected_ns = (1'483'228'800LL - 315'964'800LL) * 1'000'000'000;
  const auto time_of = [](const char* name, const char* value) {
    const std::string text = std::string(name) + ",pressure_pa\n" + value + ",101325\n";
    SensorTableReader reader = Read(text);
    const std::vector<SensorRow> rows = RowsOf(&reader);
    EXPECT_EQ(rows.size(), 1U) << name;
    EXPECT_NEAR(rows.at(0).pressure_hpa.value_or(0.0), 1013.25, 1e-9);
    return rows.at(0).time_ns;
  };
  EXPECT_EQ(time_of("time_unix_s", "1483228800"), expected_ns + 18'000'000'000);
  EXPECT_EQ(time_of("time_unix_ns", "1483228800000000005"), expected_ns + 18'000'000'005);
  EXPECT_EQ(time_of("time_calendar_gps_s", "1483228800"), expected_ns);
  EXPECT_EQ(time_of("time_gps_s", "1167264000.5"), expected_ns + 500'000'000);
  EXPECT_EQ(time_of("time_gps_ns", "1167264000000000000"), expected_ns);
  EXPECT_EQ(time_of("time_s", "0.2"), 200'000'000);
}

TEST(SensorTable, TellsColumnsByTheNumbersWhereTheFileHasNoHeader) {
  SensorTableReader in_g = Read("1483228800.25,0.01,0.02,1.01,0.1,0.2,0.3,7,8\n");
  const std::vector<SensorRow> rows = RowsOf(&in_g);
  EXPECT_FALSE(in_g.guessed_columns().empty());
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].time_ns, (1'483'228'800LL - 315'964'800LL) * 1'000'000'000 + 250'000'000);
  EXPECT_NEAR((*rows[0].force_mps2)[2], 1.01 * 9.80665, 1e-12);
  EXPECT_EQ(rows[0].turn_rate_radps, (std::array{0.1, 0.2, 0.3}));
  SensorTableReader in_si = Read("1380000000000000001,0.01,9.7,1.01,0.1,0.2,0.3\n");
  EXPECT_EQ(RowsOf(&in_si).at(0).time_ns, 1380000000000000001);
  EXPECT_NE(Refusal("1,2,3\n").find("columns cannot be told"), std::string::npos);
  EXPECT_NE(Refusal("1,300,3,4,5,6,7\n").find("columns cannot be told"), std::string::npos);
}

TEST(SensorTable, ReadsOdom3RowsAmongOthers) {
  SensorTableReader reader = Read(
      "odom3 0 5.85 0 0 0 0 -0.006 0.0025 0.0009 0.0009 4e-06 4e-06 4e-06   \n"
      "pseudorange3 0 2.1e7 1 2 3 4 5 6 7\n"
      "odom3 0.5 6.2 0 0 0\n"
      "odom3 0.7 6.3 0 0 0 0 0.01\n");
  const std::vector<SensorRow> rows = RowsOf(&reader);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(reader.is_relative());
  EXPECT_EQ(rows[0].time_ns, 0);
  EXPECT_EQ(rows[0].speed_mps, 5.85);
  EXPECT_EQ(rows[0].yaw_rate_radps, -0.006);
  EXPECT_EQ(rows[1].time_ns, 700'000'000);
  EXPECT_EQ(reader.report().rows_unknown, 1);
  EXPECT_EQ(reader.report().rows_skipped, 1);
}

TEST(SensorTable, SkipsRowsThatNoSensorGives) {
  SensorTableReader reader = Read(
      "time_gps_ns,accel_x_mps2,accel_y_mps2,accel_z_mps2\n"
      "1,1,2\n"
      "2,nan,2,3\n"
      "x,1,2,3\n"
      "-5,1,2,3\n"
      "3,1,2,1e9\n"
      "# a remark\n"
      "\n"
      "4,1,2,3\n"
      "5,1,2,3");
  const std::vector<SensorRow> rows = RowsOf(&reader);
  ASSERT_EQ(rows.size(), 1U);  // the last one may be cut off
  EXPECT_EQ(rows[0].time_ns, 4);
  EXPECT_EQ(reader.report().rows_skipped, 6);
}

TEST(SensorTable, RefusesWhatHasNoTimeOrNoSensor) {
  for (const char* header : {"accel_x_mps2,accel_y_mps2,accel_z_mps2\n1,2,3\n",
                             "time_gps_ns,accel_x_mps2,accel_y_mps2\n1,2,3\n",
                             "time_gps_ns,speed_mps\n1,2\n", "hello\n", "\n\n"}) {
    EXPECT_NE(Refusal(header), "") << header;
  }
}

}  // namespace
}  // namespace lodemark
