// The SP3 files among the recordings, against rows split by scanf.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>
#include <string_view>

#include "core/geo/time.h"
#include "core/logs/sp3.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

class RecordedSp3 : public testing::TestWithParam<const char*> {};

TEST_P(RecordedSp3, HoldsEveryRowAsItStands) {
  LODEMARK_NEEDS_RECORDING(GetParam());
  const std::string path = test::RecordingPath(GetParam());
  ReadReport report;
  const Result<PreciseOrbits> orbits = ReadSp3(path, &report);
  ASSERT_TRUE(orbits.ok());
  EXPECT_EQ(report.rows_skipped, 0);
  EXPECT_EQ(report.rows_unknown, 0);

  Result<LineReader> lines = LineReader::Open(path);
  ASSERT_TRUE(lines.ok());
  std::map<SatelliteId, std::size_t> next;
  std::int64_t time_ns = 0;
  std::int64_t rows = 0;
  std::string_view view;
  while (lines->Next(&view)) {
    const std::string line(view);
    CalendarTime calendar;
    if (std::sscanf(line.c_str(), "*  %d %d %d %d %d %lf", &calendar.year, &calendar.month,
                    &calendar.day, &calendar.hour, &calendar.minute, &calendar.second) == 6) {
      time_ns = *NanosecondsFromCalendar(calendar);
    }
    char name[4] = {};
    double x_km = 0, y_km = 0, z_km = 0, clock_us = 0;
    if (std::sscanf(line.c_str(), "P%3s %lf %lf %lf %lf", name, &x_km, &y_km, &z_km, &clock_us) !=
        5) {
      continue;
    }
    ++rows;
    const SatelliteId satellite = *SatelliteFromName(name);
    const PreciseSample& sample = orbits->samples.at(satellite).at(next[satellite]++);
    ASSERT_EQ(sample.time_gps_ns, time_ns);
    ASSERT_DOUBLE_EQ(sample.position_in_ecef.x(), 1000 * x_km);
    ASSERT_DOUBLE_EQ(sample.position_in_ecef.y(), 1000 * y_km);
    ASSERT_DOUBLE_EQ(sample.position_in_ecef.z(), 1000 * z_km);
    ASSERT_EQ(sample.has_clock, clock_us < 999'999);
    if (sample.has_clock) {
      ASSERT_DOUBLE_EQ(sample.clock_bias_s, 1e-6 * clock_us);
    }
    ASSERT_GT(sample.position_sigma_m, 0.01);
  }
  EXPECT_EQ(report.rows_read, rows);
  EXPECT_GT(rows, 5000);
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedSp3,
    testing::Values("drive/berlin_potsdamer_20160606/gbm19001.sp3.gz",
                    "gnss/pixel5_mtv_20210428/COD0MGXFIN_20211180000_01D_05M_ORB.SP3.gz"));

}  // namespace
}  // namespace lodemark
