#include "test/recorded/outage_drift.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <optional>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "core/logs/trajectory.h"
#include "core/session/session.h"

namespace lodemark::test {

OutageDrift DriftThroughOutages(const MovingRecording& recording,
                                const std::function<bool(double)>& is_gone) {
  OutageDrift drift;
  SessionOptions options;
  options.estimator = Estimator::kFilter;
  Result<std::unique_ptr<Session>> session = Session::Open(options);
  ReadReport report;
  const Result<Trajectory> truth = ReadTrajectory(recording.truth, &report);
  if (!session || !truth || recording.epochs.empty()) return drift;
  for (const NavigationRecord& record : recording.navigation) {
    (void)(*session)->PushNavigation(record);
  }
  std::size_t sample = 0;
  bool was_gone = false;
  std::optional<Eigen::Vector2d> before;
  std::optional<Eigen::Vector2d> last;
  double accuracy_m = 0.0;
  const double degree = kPi / 180.0;
  for (ObservationEpoch epoch : recording.epochs) {
    const bool gone = is_gone(
        1e-9 * static_cast<double>(epoch.time_gps_ns - recording.epochs.front().time_gps_ns));
    if (gone) epoch.signals.clear();
    std::size_t end = sample;
    while (end < recording.samples.size() && recording.samples[end].time_ns <= epoch.time_gps_ns) {
      ++end;
    }
    EXPECT_TRUE((*session)->PushSensors(recording.samples.subspan(sample, end - sample)).ok());
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

}  // namespace lodemark::test
