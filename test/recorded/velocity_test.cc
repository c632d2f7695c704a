// Velocities from Doppler against the exact motion that a professional simulator was told.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "core/geo/time.h"
#include "core/logs/line_reader.h"
#include "core/logs/parse_number.h"
#include "test/recorded/session_replay.h"
#include "test/recordings.h"

namespace lodemark::test {
namespace {

constexpr const char* kMoving = "gnss/spirent_rtk_20230108";
constexpr const char* kStanding = "gnss/spirent_static_20230108";

// By time in nanoseconds; earth-fixed.
struct Motion {
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_ecef = Eigen::Vector3d::Zero();
};

// Columns: time of day, three for the week and its second, position, velocity, attitude.
std::map<std::int64_t, Motion> ReadMotion(const std::string& path) {
  constexpr std::int64_t kWeek = 2 * 1024 + 196;
  std::map<std::int64_t, Motion> motions;
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return motions;
  std::string_view line;
  while (lines->Next(&line)) {
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      numbers.push_back(ParseDouble(line.substr(begin, end - begin)).value_or(NAN));
      begin = end + 1;
    }
    if (numbers.size() < 10 || !std::isfinite(numbers[3])) continue;
    const std::int64_t time_ns =
        kWeek * kWeek_ns + std::llround(10.0 * numbers[3]) * (kSecond_ns / 10);
    motions[time_ns] = {{numbers[4], numbers[5], numbers[6]}, {numbers[7], numbers[8], numbers[9]}};
  }
  return motions;
}

// GPS and Galileo, along a rose at 5 m/s, turning all the time. What remains are the rates of
// ionosphere and troposphere, which are not modelled: millimetres per second.
TEST(RecordedSimulatorVelocity, OfAMovingReceiverIsWithinMillimetresPerSecond) {
  LODEMARK_NEEDS_RECORDING(kMoving);
  const std::string folder = RecordingPath(kMoving);
  const std::map<std::int64_t, Motion> motions = ReadMotion(folder + "/rover-dynamic_pva.csv.gz");
  ASSERT_FALSE(motions.empty());
  const std::vector<SessionEstimate> estimates =
      Replay({folder + "/rover-dynamic.obs.gz",
              {folder + "/RINEX_GN_Spirent.23N", folder + "/RINEX_EN_Spirent.23L"}},
             SessionOptions());
  ASSERT_GT(estimates.size(), 595u);
  std::vector<double> errors_mps;
  for (const SessionEstimate& estimate : estimates) {
    const auto found = motions.find(estimate.time_gps_ns);
    if (found == motions.end()) continue;
    ASSERT_EQ(estimate.status, EstimateStatus::kFix);
    ASSERT_TRUE(estimate.has_velocity);
    const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(estimate.position);
    errors_mps.push_back(
        (estimate.velocity_enu_mps - enu_from_ecef * found->second.velocity_in_ecef).norm());
  }
  ASSERT_GT(errors_mps.size(), 595u);
  std::sort(errors_mps.begin(), errors_mps.end());
  RecordProperty("median_mps", std::to_string(errors_mps[errors_mps.size() / 2]));
  RecordProperty("largest_mps", std::to_string(errors_mps.back()));
  EXPECT_LT(errors_mps[errors_mps.size() / 2], 0.005);
  EXPECT_LT(errors_mps.back(), 0.02);
}

TEST(RecordedSimulatorVelocity, OfAStandingReceiverIsZero) {
  LODEMARK_NEEDS_RECORDING(kStanding);
  const std::string folder = RecordingPath(kStanding);
  SessionOptions options;
  options.systems = SystemsOf("GEJ");
  options.ionosphere = IonosphereChoice::kNone;
  options.troposphere = TroposphereChoice::kNone;
  for (const SessionEstimate& estimate :
       Replay({folder + "/iono-none_tropo-none.obs.gz",
               {folder + "/Spirent_RINEX_GN.23N", folder + "/Spirent_RINEX_EN.23L",
                folder + "/Spirent_RINEX_JN.23J"}},
              options)) {
    ASSERT_TRUE(estimate.has_velocity);
    EXPECT_LT(estimate.velocity_enu_mps.norm(), 0.0005);
    EXPECT_LT(std::abs(estimate.clock_drift_mps), 0.0005);
  }
}

}  // namespace
}  // namespace lodemark::test
