// A walk in tight turns with a u-blox receiver in the hand, from its own messages alone: each epoch
// for itself and filtered, against the receiver's RTK positions. Those are good to centimetres
// among each other and metres off as a whole, so the mean horizontal difference is taken off;
// heights are not told.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
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

// The three epochs at which the receiver's range to a geostationary satellite was 2 ms too long,
// which sends plain solvers 80 km away.
constexpr std::int64_t kFirstJump_gps_ns = 2381 * kWeek_ns + 408'707'498 * kMillisecond_ns;
constexpr std::int64_t kLastJump_gps_ns = 2381 * kWeek_ns + 408'707'998 * kMillisecond_ns;

struct Score {
  std::size_t epochs = 0;
  std::size_t answered = 0;
  std::size_t scored = 0;
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();  // the mean taken off
  double rmse_m = 0.0;                                 // horizontal, without it
  double largest_m = 0.0;
  double within_accuracy = 0.0;  // share of errors below the stated 68 % radius
  double largest_accuracy_m = 0.0;
  double farthest_m = 0.0;  // of all answers from their mean, truth or not
};

Score ScoreOf(const Walk& walk, Estimator estimator,
              const std::function<void(ObservationEpoch*)>& edit = {}) {
  Score score;
  SessionOptions options;
  options.estimator = estimator;
  Result<std::unique_ptr<Session>> session = Session::Open(options);
  ReadReport report;
  const Result<Trajectory> truth = ReadTrajectory(RecordingPath(kWalk) + "/truth.csv", &report);
  if (!session || !truth) return score;
  for (const NavigationRecord& record : walk.navigation) (void)(*session)->PushNavigation(record);

  const double degree = kPi / 180.0;
  std::vector<Eigen::Vector2d> places;  // of all answers, from the first
  std::vector<Eigen::Vector2d> errors;
  std::vector<double> accuracies;
  std::optional<Geodetic> first;
  for (ObservationEpoch epoch : walk.epochs) {
    if (edit) edit(&epoch);
    EXPECT_TRUE((*session)->PushObservationEpoch(0, epoch).ok());
    (*session)->ProcessNext();
    const SessionEstimate& estimate = (*session)->estimate();
    ++score.epochs;
    if (estimate.status != EstimateStatus::kFix) continue;
    ++score.answered;
    score.largest_accuracy_m = std::max(score.largest_accuracy_m, estimate.accuracy_m);
    if (!first) first = estimate.position;
    const auto from = [&](double latitude_rad, double longitude_rad) {
      const Eigen::Vector3d there =
          EcefFromGeodetic({latitude_rad, longitude_rad, estimate.position.height_m});
      const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(estimate.position);
      return Eigen::Vector2d((enu_from_ecef * (estimate.position_in_ecef - there)).head<2>());
    };
    places.push_back(from(first->latitude_rad, first->longitude_rad));
    const std::optional<TrajectoryPoint> at = truth->At(estimate.time_gps_ns);
    if (!at || !at->has_position()) continue;
    errors.push_back(from(*at->latitude_deg * degree, *at->longitude_deg * degree));
    accuracies.push_back(estimate.accuracy_m);
  }
  score.scored = errors.size();
  if (errors.empty()) return score;
  const auto mean_of = [](const std::vector<Eigen::Vector2d>& all) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& one : all) sum += one;
    return Eigen::Vector2d(sum / static_cast<double>(all.size()));
  };
  score.offset_m = mean_of(errors);
  const Eigen::Vector2d middle = mean_of(places);
  for (const Eigen::Vector2d& place : places) {
    score.farthest_m = std::max(score.farthest_m, (place - middle).norm());
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double error_m = (errors[i] - score.offset_m).norm();
    score.rmse_m += error_m * error_m;
    score.largest_m = std::max(score.largest_m, error_m);
    score.within_accuracy += error_m <= accuracies[i] ? 1.0 : 0.0;
  }
  score.rmse_m = std::sqrt(score.rmse_m / static_cast<double>(errors.size()));
  score.within_accuracy /= static_cast<double>(errors.size());
  return score;
}

void Record(const char* name, const Score& score) {
  const auto note = [&](const char* what, double value) {
    ::testing::Test::RecordProperty(std::string(name) + "_" + what, std::to_string(value));
  };
  note("rmse_m", score.rmse_m);
  note("largest_m", score.largest_m);
  note("offset_m", score.offset_m.norm());
  note("within_accuracy", score.within_accuracy);
  note("farthest_m", score.farthest_m);
}

// The range of a satellite that is used jumps as that of the geostationary one does.
void Jump(ObservationEpoch* epoch) {
  if (epoch->time_gps_ns < kFirstJump_gps_ns || epoch->time_gps_ns > kLastJump_gps_ns) return;
  for (SignalObservation& signal : epoch->signals) {
    if (signal.satellite == SatelliteId{System::kGps, 10}) signal.pseudorange_m += 599'584.916;
  }
}

void ExpectAWalk(const Score& score, double rmse_m) {
  EXPECT_EQ(score.epochs, 536u);
  EXPECT_EQ(score.answered, score.epochs);
  EXPECT_GT(score.scored, 340u);
  EXPECT_LT(score.rmse_m, rmse_m);
  EXPECT_LT(score.farthest_m, 30.0);
  EXPECT_LT(score.offset_m.norm(), 10.0);
}

TEST(RecordedWalk, IsAnsweredEveryEpochAndSmoothedByTheFilter) {
  LODEMARK_NEEDS_RECORDING(kWalk);
  const Walk walk = ReadWalk();
  const Score single = ScoreOf(walk, Estimator::kEpoch);
  const Score filter = ScoreOf(walk, Estimator::kFilter);
  Record("single", single);
  Record("filter", filter);
  ExpectAWalk(single, 1.6);
  ExpectAWalk(filter, 0.8);
  EXPECT_LE(filter.rmse_m, single.rmse_m);
  EXPECT_LE(filter.largest_m, single.largest_m);
  // What all epochs share is taken off, so more than 68 % are within.
  EXPECT_GT(single.within_accuracy, 0.68);
  EXPECT_GT(filter.within_accuracy, 0.68);
}

TEST(RecordedWalk, ARangeTwoMillisecondsTooLongMovesNothing) {
  LODEMARK_NEEDS_RECORDING(kWalk);
  const Walk walk = ReadWalk();
  for (const Estimator estimator : {Estimator::kEpoch, Estimator::kFilter}) {
    const Score without = ScoreOf(walk, estimator);
    const Score with = ScoreOf(walk, estimator, Jump);
    Record(estimator == Estimator::kEpoch ? "single_jump" : "filter_jump", with);
    ExpectAWalk(with, 1.6);
    EXPECT_NEAR(with.rmse_m, without.rmse_m, 0.05);
  }
}

}  // namespace
}  // namespace lodemark::test
