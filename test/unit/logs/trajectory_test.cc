#include "core/logs/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <string_view>

namespace lodemark {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

TrajectoryPoint Point(std::int64_t time_gps_ns, double latitude_deg, double longitude_deg,
                      std::optional<double> height_m = std::nullopt) {
  TrajectoryPoint point;
  point.time_gps_ns = time_gps_ns;
  point.latitude_deg = latitude_deg;
  point.longitude_deg = longitude_deg;
  point.height_m = height_m;
  return point;
}

Result<Trajectory> Read(std::string_view text, ReadReport* report) {
  LineReader lines = LineReader::FromMemory("truth.csv", text);
  return ReadTrajectory(&lines, report);
}

TEST(Trajectory, ReadsColumnsInAnyOrderAndLeavesEmptyOnesOut) {
  ReadReport report;
  const auto track = Read(
      "longitude_deg,mood,velocity_up_mps,latitude_deg,time_gps_ns,height_m\r\n"
      "-122.25,good,0.5,37.5,1303770943999000000,\r\n",
      &report);
  ASSERT_TRUE(track.ok());
  ASSERT_EQ(track->points().size(), 1u);
  const TrajectoryPoint& point = track->points()[0];
  EXPECT_EQ(point.time_gps_ns, 1'303'770'943'999'000'000);
  EXPECT_EQ(point.latitude_deg, 37.5);
  EXPECT_EQ(point.longitude_deg, -122.25);
  EXPECT_EQ(point.height_m, std::nullopt);
  EXPECT_EQ(point.velocity_enu_mps[0], std::nullopt);
  EXPECT_EQ(point.velocity_enu_mps[2], 0.5);
}

TEST(Trajectory, OfOnePointHoldsAtAllTimes) {
  const Trajectory track({Point(1'000 * kSecond, 60.0, 10.0, 5.0)});
  EXPECT_TRUE(track.is_static());
  ASSERT_TRUE(track.At(0).has_value());
  EXPECT_EQ(track.At(2'000'000 * kSecond)->latitude_deg, 60.0);
  EXPECT_EQ(track.At(17)->time_gps_ns, 17);
}

TEST(Trajectory, IsLinearBetweenPointsWhateverTheirOrder) {
  const Trajectory track(
      {Point(12 * kSecond, 60.2, 10.4, 9.0), Point(10 * kSecond, 60.0, 10.0, 5.0)});
  const auto at = track.At(10 * kSecond + kSecond / 2);
  ASSERT_TRUE(at.has_value());
  EXPECT_NEAR(*at->latitude_deg, 60.05, 1e-12);
  EXPECT_NEAR(*at->longitude_deg, 10.1, 1e-12);
  EXPECT_NEAR(*at->height_m, 6.0, 1e-12);
  EXPECT_EQ(track.At(10 * kSecond)->latitude_deg, 60.0);
  EXPECT_EQ(track.At(12 * kSecond)->latitude_deg, 60.2);
}

TEST(Trajectory, KeepsTheFirstOfTwoPointsWithOneTime) {
  const Trajectory track({Point(kSecond, 60.2, 10.0), Point(0, 60.0, 10.0), Point(0, 70.0, 10.0)});
  ASSERT_EQ(track.points().size(), 2u);
  EXPECT_EQ(track.At(0)->latitude_deg, 60.0);
}

TEST(Trajectory, EndsAtItsEndsAndBridgesNoGapAboveThreeSeconds) {
  const Trajectory track(
      {Point(0, 60.0, 10.0), Point(3 * kSecond, 60.1, 10.0), Point(6 * kSecond + 1, 60.2, 10.0)});
  EXPECT_TRUE(track.At(kSecond).has_value());
  EXPECT_FALSE(track.At(4 * kSecond).has_value());
  EXPECT_TRUE(track.At(6 * kSecond + 1).has_value());
  EXPECT_FALSE(track.At(-1).has_value());
  EXPECT_FALSE(track.At(6 * kSecond + 2).has_value());
}

TEST(Trajectory, CrossesTheDateLineTheShortWay) {
  const Trajectory track({Point(0, 0.0, 179.75), Point(2 * kSecond, 0.0, -179.75)});
  EXPECT_NEAR(std::abs(*track.At(kSecond)->longitude_deg), 180.0, 1e-12);
  EXPECT_NEAR(*track.At(kSecond / 2)->longitude_deg, 179.875, 1e-12);
}

TEST(Trajectory, InterpolatesOverRowsWithoutPositionButNotTheirGap) {
  TrajectoryPoint none;
  none.time_gps_ns = kSecond;
  const Trajectory track({Point(0, 60.0, 10.0), none, Point(2 * kSecond, 60.2, 10.0)});
  ASSERT_TRUE(track.At(kSecond).has_value());
  EXPECT_NEAR(*track.At(kSecond)->latitude_deg, 60.1, 1e-12);
  EXPECT_FALSE(Trajectory({none}).is_static());
  EXPECT_FALSE(Trajectory({none}).At(kSecond).has_value());
}

TEST(Trajectory, RefusesNanAbsurdAndShortRows) {
  ReadReport report;
  const auto track = Read(
      "time_gps_ns,latitude_deg,longitude_deg,height_m\n"
      "1000,nan,10.0,5.0\n"
      "1001,60.0,inf,5.0\n"
      "1002,160.0,10.0,5.0\n"
      "-3,60.0,10.0,5.0\n"
      "1003,60.0,,5.0\n"
      "1004,60.0\n"
      "1005,60.0,10.0,NaN\n",
      &report);
  ASSERT_TRUE(track.ok());
  ASSERT_EQ(track->points().size(), 1u);
  EXPECT_EQ(track->points()[0].time_gps_ns, 1005);
  EXPECT_EQ(track->points()[0].height_m, std::nullopt);
  EXPECT_EQ(report.rows_skipped, 6);
  EXPECT_EQ(FormatProblem(report.file, report.problems[0]),
            "truth.csv:2:6: latitude_deg 'nan' is no plausible value");
}

TEST(Trajectory, SaysWhyAFileIsNone) {
  ReadReport report;
  const auto wrong = Read("a,b\n1,2\n", &report);
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().message, HasSubstr("does not name the columns time_gps_ns"));
  const auto empty = Read("time_gps_ns,latitude_deg,longitude_deg\n", &report);
  ASSERT_FALSE(empty.ok());
  EXPECT_THAT(empty.error().message, HasSubstr("only a header"));
}

TEST(Trajectory, ReadsBackWhatItWrites) {
  TrajectoryPoint full = Point(1'303'770'943'999'000'001, 37.123456789, -122.5, -28.25);
  full.velocity_enu_mps = {1.5, -2.25, 0.125};
  full.accuracy_m = 3.5;
  full.vertical_accuracy_m = 7.25;
  full.speed_accuracy_mps = 0.5;
  full.protection_level_m = 20.5;
  full.vertical_protection_level_m = 40.75;
  full.covariance_enu_m2 = {4.5, -0.25, 5.5, 1e-7, 0.125, 1234567.0};
  full.clock_bias_m = -123456789.5;
  full.clock_drift_mps = 0.0625;
  full.sources = "gnss+vision";
  full.satellites_used = 17;
  full.hdop = 0.875;
  full.vdop = 1.5;
  full.status = "fix";
  TrajectoryPoint none;
  none.time_gps_ns = full.time_gps_ns + kSecond;
  none.accuracy_m = std::numeric_limits<double>::quiet_NaN();
  none.status = "too_few_satellites";

  std::string text = TrajectoryHeader();
  AppendTrajectoryRow(full, &text);
  AppendTrajectoryRow(none, &text);
  ReadReport report;
  const auto track = Read(text, &report);
  ASSERT_TRUE(track.ok());
  EXPECT_EQ(report.rows_skipped + report.values_dropped, 0);
  ASSERT_EQ(track->points().size(), 2u);
  const TrajectoryPoint& read = track->points()[0];
  EXPECT_EQ(read.time_gps_ns, full.time_gps_ns);
  EXPECT_EQ(read.latitude_deg, full.latitude_deg);
  EXPECT_EQ(read.longitude_deg, full.longitude_deg);
  EXPECT_EQ(read.height_m, full.height_m);
  EXPECT_EQ(read.velocity_enu_mps, full.velocity_enu_mps);
  EXPECT_EQ(read.accuracy_m, full.accuracy_m);
  EXPECT_EQ(read.vertical_accuracy_m, full.vertical_accuracy_m);
  EXPECT_EQ(read.speed_accuracy_mps, full.speed_accuracy_mps);
  EXPECT_EQ(read.protection_level_m, full.protection_level_m);
  EXPECT_EQ(read.vertical_protection_level_m, full.vertical_protection_level_m);
  EXPECT_EQ(read.covariance_enu_m2, full.covariance_enu_m2);
  EXPECT_EQ(read.clock_bias_m, full.clock_bias_m);
  EXPECT_EQ(read.clock_drift_mps, full.clock_drift_mps);
  EXPECT_EQ(read.sources, full.sources);
  EXPECT_EQ(read.satellites_used, full.satellites_used);
  EXPECT_EQ(read.hdop, full.hdop);
  EXPECT_EQ(read.vdop, full.vdop);
  EXPECT_EQ(read.status, full.status);
  EXPECT_FALSE(track->points()[1].has_position());
  EXPECT_EQ(track->points()[1].accuracy_m, std::nullopt);
  EXPECT_EQ(track->points()[1].status, "too_few_satellites");
}

}  // namespace
}  // namespace lodemark
