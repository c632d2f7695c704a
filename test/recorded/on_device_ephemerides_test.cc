// A phone's log that holds the satellites' messages: what it decoded itself against what a network
// of receivers collected.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/units.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/rinex_navigation.h"
#include "core/session/session.h"
#include "test/recordings.h"

namespace lodemark::test {
namespace {

constexpr const char* kPhone = "gnss/s8_perth_20171005";  // lies still

// Positions by time. With a navigation file the messages in the log are left out.
std::map<std::int64_t, Eigen::Vector3d> FixesOf(const std::string& log,
                                                const std::string& navigation) {
  std::map<std::int64_t, Eigen::Vector3d> fixes;
  Result<GnssLoggerReader> reader = GnssLoggerReader::Open(log);
  Result<std::unique_ptr<Session>> session = Session::Open(SessionOptions());
  if (!reader || !session) return fixes;
  if (!navigation.empty()) {
    ReadReport report;
    const Status read = ReadRinexNavigation(
        navigation,
        [&](const NavigationRecord& record) { (void)(*session)->PushNavigation(record); }, &report);
    if (!read.ok()) return fixes;
  }
  GnssLoggerRecord record;
  while (reader->Next(&record)) {
    if (const auto* message = std::get_if<LoggedNavigationMessage>(&record)) {
      if (!navigation.empty()) continue;
      (void)(*session)->PushNavigationMessage(message->type, message->svid, message->message_id,
                                              message->submessage_id, message->bytes);
    }
    const auto* epoch = std::get_if<AndroidEpoch>(&record);
    if (epoch == nullptr) continue;
    (void)(*session)->PushAndroidEpoch(epoch->clock.time_ns, *epoch);
    while ((*session)->ProcessNext()) {
      const SessionEstimate& estimate = (*session)->estimate();
      if (estimate.status == EstimateStatus::kFix) {
        fixes[estimate.time_gps_ns] = estimate.position_in_ecef;
      }
    }
  }
  return fixes;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector3d MedianPlace(const std::map<std::int64_t, Eigen::Vector3d>& fixes) {
  Eigen::Vector3d place;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const auto& [time_ns, position] : fixes) values.push_back(position[axis]);
    place[axis] = Median(std::move(values));
  }
  return place;
}

TEST(RecordedOnDeviceEphemerides, GiveThePlaceThatANavigationFileGives) {
  LODEMARK_NEEDS_RECORDING(kPhone);
  const std::string folder = RecordingPath(kPhone);
  const std::string log = folder + "/SensorLog20171005.txt.gz";
  const auto own = FixesOf(log, "");
  const auto of_network = FixesOf(log, folder + "/PERT00AUS_R_20172780000_01D_MN.rnx.gz");
  // The phone knows an orbit half a minute after its satellite came into view; the file knows all.
  ASSERT_GE(own.size(), 410u);
  ASSERT_GE(of_network.size(), own.size());
  EXPECT_LT(own.begin()->first - of_network.begin()->first, 30 * kSecond_ns);
  // The same log has no Fix row. It lies still, so what it decoded and what others received must
  // lead to one place: within what changing sets of satellites do to single epochs.
  EXPECT_LT((MedianPlace(own) - MedianPlace(of_network)).norm(), 5.0);
  std::vector<double> apart_m;
  for (const auto& [time_ns, position] : own) {
    const auto same = of_network.find(time_ns);
    if (same != of_network.end()) apart_m.push_back((position - same->second).norm());
  }
  ASSERT_GE(apart_m.size(), 410u);
  EXPECT_LT(Median(apart_m), 8.0);
  EXPECT_LT(*std::max_element(apart_m.begin(), apart_m.end()), 40.0);
}

}  // namespace
}  // namespace lodemark::test
