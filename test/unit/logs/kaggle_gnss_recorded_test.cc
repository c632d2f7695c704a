// The Kaggle csv files among the recordings.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/kaggle_gnss.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

struct File {
  const char* path;
  bool rounded;
  // Between the clock and the given ranges. Those hold the first bias of the drive; a clock that
  // kept its digits is left as logged and drifts away from it.
  double apart_ns;
};

void PrintTo(const File& file, std::ostream* out) { *out << file.path; }

class RecordedKaggle : public ::testing::TestWithParam<File> {};

std::int64_t DataLines(const std::string& path) {
  Result<LineReader> lines = LineReader::Open(path);
  std::int64_t count = -1;  // the header
  std::string_view line;
  while (lines.ok() && lines->Next(&line)) count += line.empty() ? 0 : 1;
  return count;
}

TEST_P(RecordedKaggle, LosesNoRowAndKeepsTimesAndRangesTogether) {
  LODEMARK_NEEDS_RECORDING(GetParam().path);
  const std::string path = test::RecordingPath(GetParam().path);
  Result<KaggleGnssReader> reader = KaggleGnssReader::Open(path);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  std::int64_t rows = 0;
  KaggleEpoch epoch;
  while (reader->Next(&epoch)) {
    rows += static_cast<std::int64_t>(epoch.raw.measurements.size());
    ASSERT_EQ(epoch.derived.size(), epoch.raw.measurements.size());
    for (const AndroidMeasurement& m : epoch.raw.measurements) {
      if (!m.Has(kMeasurementHasGivenPseudorange) || m.constellation_type != 1) continue;
      const double travel_ns = m.given_pseudorange_m * 1e9 / kSpeedOfLight_mps;
      const std::int64_t sent_ns = epoch.time_gps_ns - std::llround(travel_ns);
      const double apart_ns = static_cast<double>(
          m.received_sv_time_ns -
          NearestCongruent(FloorModulo(sent_ns, kWeek_ns), kWeek_ns, m.received_sv_time_ns));
      EXPECT_NEAR(apart_ns, 0.0, GetParam().apart_ns);
    }
  }
  EXPECT_EQ(rows, DataLines(path));
  EXPECT_EQ(reader->report().rows_skipped, 0);
  EXPECT_EQ(reader->timestamps_rounded(), GetParam().rounded);
}

INSTANTIATE_TEST_SUITE_P(
    Recorded, RecordedKaggle,
    ::testing::Values(File{"gnss/pixel7pro_castrovalley_20230907/device_gnss.csv", true, 2.0},
                      File{"gnss/pixel_mtv_20210429/device_gnss.csv", false, 10'000.0},
                      File{"gnss/pixel4_mtv_20200514/Pixel4_derived.csv", true, 2.0},
                      File{"gnss/pixel4_sjc_20210428/Pixel4_derived_clkdiscnt.csv", false, 2.0}));

TEST(RecordedKaggleTimes, RecoverTheClockThatTheLogOfTheSameDataHas) {
  const std::string folder = "gnss/pixel7pro_castrovalley_20230907/";
  LODEMARK_NEEDS_RECORDING(folder);
  auto log = GnssLoggerReader::Open(test::RecordingPath(folder + "gnss_log.txt"));
  auto csv = KaggleGnssReader::Open(test::RecordingPath(folder + "device_gnss.csv"));
  ASSERT_TRUE(log.ok() && csv.ok());
  GnssLoggerRecord record;
  KaggleEpoch epoch;
  int compared = 0;
  std::int64_t held_bias_ns = 0;
  while (log->Next(&record)) {
    const auto* logged = std::get_if<AndroidEpoch>(&record);
    if (logged == nullptr) continue;
    ASSERT_TRUE(csv->Next(&epoch));
    EXPECT_EQ(epoch.raw.clock.time_ns, logged->clock.time_ns);
    // The file has 10 us steps; the ranges hold a bias of shortly before the excerpt.
    if (compared == 0) held_bias_ns = epoch.raw.clock.full_bias_ns;
    EXPECT_NEAR(static_cast<double>(epoch.raw.clock.full_bias_ns - held_bias_ns), 0.0, 3.0);
    EXPECT_NEAR(static_cast<double>(epoch.raw.clock.full_bias_ns - logged->clock.full_bias_ns), 0.0,
                300.0);
    ASSERT_EQ(epoch.raw.measurements.size(), logged->measurements.size());
    for (std::size_t i = 0; i < logged->measurements.size(); ++i) {
      EXPECT_EQ(epoch.raw.measurements[i].received_sv_time_ns,
                logged->measurements[i].received_sv_time_ns);
    }
    ++compared;
  }
  EXPECT_EQ(compared, 5);
}

}  // namespace
}  // namespace lodemark
