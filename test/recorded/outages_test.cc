// A walk and a drive with their satellites taken away for fifteen seconds at a time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_observation.h"
#include "core/logs/sensor_table.h"
#include "test/recorded/outage_drift.h"
#include "test/recorded/walk_recording.h"
#include "test/recordings.h"

namespace lodemark::test {
namespace {

constexpr double kGoneFor_s = 15.0;

void Record(const std::string& name, const OutageDrift& drift) {
  ::testing::Test::RecordProperty(name + "_drift_m", std::to_string(drift.mean_m));
  ::testing::Test::RecordProperty(name + "_accuracy_m", std::to_string(drift.mean_accuracy_m));
}

// Against RTK positions whose common offset falls out of a difference.
TEST(RecordedInertialWalk, IsCarriedThroughOutages) {
  LODEMARK_NEEDS_RECORDING(kWalk);
  const Walk walk = ReadWalk();
  ASSERT_GT(walk.samples.size(), 20'000u);
  // Most truth lies in the first 90 s.
  const auto is_gone = [](double seconds) {
    for (const double gone_s : {25.0, 48.0, 71.0}) {
      if (seconds >= gone_s && seconds < gone_s + kGoneFor_s) return true;
    }
    return false;
  };
  MovingRecording recording = {
      walk.epochs, walk.navigation, {}, RecordingPath(kWalk) + "/truth.csv"};
  const OutageDrift motion = DriftThroughOutages(recording, is_gone);
  recording.samples = walk.samples;
  const OutageDrift inertial = DriftThroughOutages(recording, is_gone);
  Record("motion", motion);
  Record("inertial", inertial);
  EXPECT_EQ(motion.outages, 3);
  EXPECT_EQ(inertial.outages, 3);
  EXPECT_TRUE(inertial.answered);
  EXPECT_LT(inertial.mean_m, 0.5 * motion.mean_m);
  EXPECT_LT(inertial.mean_m, 8.0);
  EXPECT_LT(inertial.over_accuracy, 1.5);
}

constexpr const char* kDrive = "drive/berlin_potsdamer_20160606";

// Speed and yaw rate of a car, in deep streets, without satellites in 15 of every 60 seconds, at
// four places in the minute.
TEST(RecordedWheels, CarryADriveThroughOutages) {
  LODEMARK_NEEDS_RECORDING(kDrive);
  const std::string folder = RecordingPath(kDrive);
  std::vector<ObservationEpoch> epochs;
  Result<RinexObservationReader> observations =
      RinexObservationReader::Open(folder + "/Berlin_Potsdamer_Platz.obs.gz");
  ASSERT_TRUE(observations);
  for (ObservationEpoch epoch; observations->Next(&epoch);) epochs.push_back(epoch);
  ASSERT_GT(epochs.size(), 1000u);
  std::vector<NavigationRecord> navigation;
  ReadReport report;
  ASSERT_TRUE(ReadRinexNavigation(
                  folder + "/BRDC00WRD_U_20161580000_01D_MN.rnx.gz",
                  [&](const NavigationRecord& record) { navigation.push_back(record); }, &report)
                  .ok());
  std::vector<SensorSample> samples;
  Result<SensorTableReader> table =
      SensorTableReader::Open(folder + "/Berlin_Potsdamer_Platz_Input.txt.gz");
  ASSERT_TRUE(table);
  for (SensorRow row; table->Next(&row);) {
    if (!row.speed_mps || !row.yaw_rate_radps) continue;
    const std::int64_t time_ns =
        row.time_ns + (table->is_relative() ? epochs.front().time_gps_ns : 0);
    samples.push_back({SensorKind::kVehicle, time_ns, {*row.speed_mps, *row.yaw_rate_radps, 0.0}});
  }
  ASSERT_GT(samples.size(), 1000u);

  double lost_m = 0.0;
  double squares = 0.0;
  int outages = 0;
  for (const double first_s : {20.0, 30.0, 40.0, 50.0}) {
    const auto is_gone = [&](double seconds) {
      return seconds >= first_s && std::fmod(seconds - first_s, 60.0) < kGoneFor_s;
    };
    const OutageDrift drift =
        DriftThroughOutages({epochs, navigation, samples, folder + "/truth.csv"}, is_gone);
    EXPECT_TRUE(drift.answered) << first_s;
    Record("from_" + std::to_string(static_cast<int>(first_s)) + "_s", drift);
    lost_m += drift.outages * drift.mean_m;
    squares += drift.outages * drift.over_accuracy * drift.over_accuracy;
    outages += drift.outages;
  }
  EXPECT_GE(outages, 16);
  ::testing::Test::RecordProperty("drift_m", std::to_string(lost_m / outages));
  EXPECT_LT(lost_m / outages, 1.8);
  EXPECT_LT(std::sqrt(squares / outages), 1.0);
}

}  // namespace
}  // namespace lodemark::test
