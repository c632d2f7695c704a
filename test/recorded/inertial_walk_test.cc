// The walk with its satellites taken away for fifteen seconds at a time: how far the motion alone,
// and the inertial sensor, lead astray until they come back. Against RTK positions whose common
// offset falls out of a difference.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "core/geo/time.h"
#include "core/logs/trajectory.h"
#include "core/session/session.h"
#include "test/recorded/walk_recording.h"
#include "test/recordings.h"

namespace lodemark::test {
namespace {

// Seconds after the first epoch at which satellites go. Most truth lies in the first 90 s.
constexpr std::array<int, 3> kGone_s = {25, 48, 71};
constexpr int kGoneFor_s = 15;

struct Drift {
  double mean_m = 0.0;         // of the position's error over an outage
  double over_accuracy = 0.0;  // root mean square of the same, as a share of what is stated then
  double mean_accuracy_m = 0.0;
  int outages = 0;       // that could be scored
  bool answered = true;  // every epoch of them
};

bool IsGone(double seconds) {
  for (const int gone_s : kGone_s) {
    if (seconds >= gone_s && seconds < gone_s + kGoneFor_s) return true;
  }
  return false;
}

Drift DriftOf(const Walk& walk, bool with_sensors) {
  Drift drift;
  SessionOptions options;
  options.estimator = Estimator::kFilter;
  Result<std::unique_ptr<Session>> session = Session::Open(options);
  ReadReport report;
  const Result<Trajectory> truth = ReadTrajectory(RecordingPath(kWalk) + "/truth.csv", &report);
  if (!session || !truth || walk.epochs.empty()) return drift;
  for (const NavigationRecord& record : walk.navigation) (void)(*session)->PushNavigation(record);
  std::size_t sample = 0;
  bool was_gone = false;
  std::optional<Eigen::Vector2d> before;
  std::optional<Eigen::Vector2d> last;
  double accuracy_m = 0.0;
  const double degree = kPi / 180.0;
  for (ObservationEpoch epoch : walk.epochs) {
    const bool gone =
        IsGone(1e-9 * static_cast<double>(epoch.time_gps_ns - walk.epochs.front().time_gps_ns));
    if (gone) epoch.signals.clear();
    std::size_t end = sample;
    while (end < walk.samples.size() && walk.samples[end].time_ns <= epoch.time_gps_ns) ++end;
    if (with_sensors) {
      EXPECT_TRUE(
          (*session)->PushSensors(std::span(walk.samples).subspan(sample, end - sample)).ok());
    }
    sample = end;
    EXPECT_TRUE((*session)->PushObservationEpoch(0, epoch).ok());
    (*session)->ProcessNext();
    const SessionEstimate& estimate = (*session)->estimate();
    drift.answered = drift.answered && (!gone || estimate.status == EstimateStatus::kFix);
    if (gone && !was_gone) before = last;
    if (!gone && was_gone && before && last) {
      const double moved_m = (*last - *before).norm();
      ++drift.outages;
      drift.mean_m += moved_m;
      drift.mean_accuracy_m += accuracy_m;
      drift.over_accuracy += moved_m * moved_m / (accuracy_m * accuracy_m);
    }
    was_gone = gone;
    const std::optional<TrajectoryPoint> at = truth->At(epoch.time_gps_ns);
    if (!at || !at->has_position() || estimate.status != EstimateStatus::kFix) continue;
    const Eigen::Vector3d there = EcefFromGeodetic(
        {*at->latitude_deg * degree, *at->longitude_deg * degree, estimate.position.height_m});
    last = (EnuFromEcefRotation(estimate.position) * (estimate.position_in_ecef - there)).head<2>();
    accuracy_m = estimate.accuracy_m;
  }
  if (drift.outages == 0) return drift;
  drift.mean_m /= drift.outages;
  drift.mean_accuracy_m /= drift.outages;
  drift.over_accuracy = std::sqrt(drift.over_accuracy / drift.outages);
  return drift;
}

void Record(const std::string& name, const Drift& drift) {
  ::testing::Test::RecordProperty(name + "_drift_m", std::to_string(drift.mean_m));
  ::testing::Test::RecordProperty(name + "_accuracy_m", std::to_string(drift.mean_accuracy_m));
}

TEST(RecordedInertialWalk, IsCarriedThroughOutages) {
  LODEMARK_NEEDS_RECORDING(kWalk);
  const Walk walk = ReadWalk();
  ASSERT_GT(walk.samples.size(), 20'000u);
  const Drift motion = DriftOf(walk, false);
  const Drift inertial = DriftOf(walk, true);
  Record("motion", motion);
  Record("inertial", inertial);
  EXPECT_EQ(motion.outages, 3);
  EXPECT_EQ(inertial.outages, 3);
  EXPECT_TRUE(inertial.answered);
  EXPECT_LT(inertial.mean_m, 0.5 * motion.mean_m);
  EXPECT_LT(inertial.mean_m, 8.0);
  EXPECT_LT(inertial.over_accuracy, 1.5);
}

}  // namespace
}  // namespace lodemark::test
