// Messages that a phone decoded itself, put together and held against what a station nearby wrote
// to its RINEX file on the same day.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/base/units.h"
#include "core/gnss/navigation_message.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/rinex_navigation.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

const std::string kLog = "gnss/s8_perth_20171005/SensorLog20171005.txt.gz";
const std::string kStation = "gnss/s8_perth_20171005/PERT00AUS_R_20172780000_01D_MN.rnx.gz";

struct Decoded {
  std::vector<NavigationRecord> records;
  std::map<MessageVerdict, int> verdicts;
};

Decoded DecodeLog(const std::string& name) {
  Decoded decoded;
  Result<GnssLoggerReader> reader = GnssLoggerReader::Open(test::RecordingPath(name));
  if (!reader) return decoded;
  NavigationMessageDecoder decoder;
  std::int64_t time_gps_ns = -1;
  GnssLoggerRecord record;
  while (reader->Next(&record)) {
    if (const auto* epoch = std::get_if<AndroidEpoch>(&record)) {
      if (epoch->clock.Has(kClockHasFullBias)) {
        time_gps_ns = epoch->clock.time_ns - epoch->clock.full_bias_ns;
      }
    } else if (const auto* message = std::get_if<LoggedNavigationMessage>(&record)) {
      ++decoded.verdicts[decoder.Push(message->type, message->svid, message->bytes, time_gps_ns,
                                      &decoded.records)];
    }
  }
  return decoded;
}

template <typename T>
std::vector<T> All(const std::vector<NavigationRecord>& records, System system) {
  std::vector<T> found;
  for (const NavigationRecord& record : records) {
    const T* item = std::get_if<T>(&record);
    if (item != nullptr && item->satellite.system == system) found.push_back(*item);
  }
  return found;
}

std::vector<NavigationRecord> StationRecords() {
  std::vector<NavigationRecord> records;
  ReadReport report;
  EXPECT_TRUE(ReadRinexNavigation(
                  test::RecordingPath(kStation),
                  [&](const NavigationRecord& record) { records.push_back(record); }, &report)
                  .ok());
  return records;
}

// Half of the last of the file's twelve digits, which begin after the point.
#define EXPECT_SAME(field) EXPECT_NEAR(mine.field, theirs.field, 5.1e-12 * std::abs(theirs.field))

TEST(RecordedNavigationMessages, GpsEqualsTheStationsFile) {
  LODEMARK_NEEDS_RECORDING(kLog);
  Decoded decoded = DecodeLog(kLog);
  EXPECT_EQ(decoded.verdicts[MessageVerdict::kBadParity], 1);  // of 1241, in a GPS subframe
  EXPECT_EQ(decoded.verdicts[MessageVerdict::kMalformed], 0);
  EXPECT_EQ(decoded.verdicts[MessageVerdict::kUnknownType], 0);
  EXPECT_EQ(decoded.verdicts[MessageVerdict::kUnknownSatellite], 0);

  const auto station = All<KeplerEphemeris>(StationRecords(), System::kGps);
  int matched = 0;
  const auto sets = All<KeplerEphemeris>(decoded.records, System::kGps);
  for (const KeplerEphemeris& mine : sets) {
    for (const KeplerEphemeris& theirs : station) {
      if (mine.satellite != theirs.satellite || mine.issue_of_data != theirs.issue_of_data ||
          mine.toe_gps_ns != theirs.toe_gps_ns) {
        continue;
      }
      SCOPED_TRACE(SatelliteName(mine.satellite));
      ++matched;
      EXPECT_EQ(mine.toc_gps_ns, theirs.toc_gps_ns);
      EXPECT_LE(std::abs(mine.transmitted_gps_ns - theirs.toe_gps_ns), 3 * 3600 * kSecond_ns);
      EXPECT_EQ(mine.issue_of_clock, theirs.issue_of_clock);
      EXPECT_EQ(mine.health, theirs.health);
      EXPECT_EQ(mine.healthy, theirs.healthy);
      // Of the same index we give the nominal value and they the largest: 2.0 and 2.4.
      EXPECT_NEAR(theirs.accuracy_m / mine.accuracy_m, 1.2, 0.02);
      EXPECT_EQ(mine.fit_interval_s, theirs.fit_interval_s);
      EXPECT_SAME(clock_bias_s);
      EXPECT_SAME(clock_drift_sps);
      EXPECT_SAME(clock_drift_rate_sps2);
      EXPECT_SAME(semi_major_axis_m);
      EXPECT_SAME(eccentricity);
      EXPECT_SAME(mean_anomaly_rad);
      EXPECT_SAME(mean_motion_difference_radps);
      EXPECT_SAME(argument_of_perigee_rad);
      EXPECT_SAME(inclination_rad);
      EXPECT_SAME(inclination_rate_radps);
      EXPECT_SAME(ascending_node_rad);
      EXPECT_SAME(ascending_node_rate_radps);
      EXPECT_SAME(cuc_rad);
      EXPECT_SAME(cus_rad);
      EXPECT_SAME(cic_rad);
      EXPECT_SAME(cis_rad);
      EXPECT_SAME(crc_m);
      EXPECT_SAME(crs_m);
      EXPECT_SAME(group_delays.tgd_s.value());
    }
  }
  EXPECT_EQ(matched, static_cast<int>(sets.size()));
  EXPECT_GE(matched, 10);
}

TEST(RecordedNavigationMessages, GlonassEqualsTheStationsFile) {
  LODEMARK_NEEDS_RECORDING(kLog);
  const auto station = All<StateEphemeris>(StationRecords(), System::kGlonass);
  const auto sets = All<StateEphemeris>(DecodeLog(kLog).records, System::kGlonass);
  int matched = 0;
  for (const StateEphemeris& mine : sets) {
    for (const StateEphemeris& theirs : station) {
      if (mine.satellite != theirs.satellite || mine.toe_gps_ns != theirs.toe_gps_ns) continue;
      SCOPED_TRACE(SatelliteName(mine.satellite));
      ++matched;
      EXPECT_EQ(mine.glonass_channel, theirs.glonass_channel);
      EXPECT_EQ(mine.health, theirs.health);
      EXPECT_EQ(mine.age_days, theirs.age_days);
      EXPECT_LE(std::abs(mine.transmitted_gps_ns - theirs.transmitted_gps_ns), 1800 * kSecond_ns);
      EXPECT_SAME(clock_bias_s);
      EXPECT_SAME(frequency_bias);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_SAME(position_in_ecef[axis]);
        EXPECT_SAME(velocity_in_ecef[axis]);
        EXPECT_SAME(acceleration_in_ecef[axis]);
      }
    }
  }
  EXPECT_EQ(matched, static_cast<int>(sets.size()));
  EXPECT_GE(matched, 5);
}

TEST(RecordedNavigationMessages, EveryStringOfTheNorwegianLogPassesItsCode) {
  const std::string log = "gnss/android_norway_20161205/gnss_android_raw_data.txt";
  LODEMARK_NEEDS_RECORDING(log);
  Decoded decoded = DecodeLog(log);
  EXPECT_EQ(decoded.verdicts[MessageVerdict::kBadParity], 0);
  EXPECT_EQ(decoded.verdicts[MessageVerdict::kMalformed], 0);
  EXPECT_GT(decoded.verdicts[MessageVerdict::kUnused], 0);  // almanacs
}

}  // namespace
}  // namespace lodemark
