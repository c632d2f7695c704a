#include "core/session/epoch_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "test/unit/session/filter_scene.h"

namespace lodemark::test {
namespace {

const Eigen::Vector3d kDriving_mps(12.0, -7.0, 0.0);
const Eigen::Vector3d kStill_mps = Eigen::Vector3d::Zero();

double RmsFrom(const FilterScene& filter_scene, const std::vector<SessionEstimate>& estimates,
               int first) {
  double sum = 0.0;
  const int count = static_cast<int>(estimates.size());
  for (int i = first; i < count; ++i) {
    const double error_m = filter_scene.HorizontalError(estimates[static_cast<std::size_t>(i)], i);
    sum += error_m * error_m / (count - first);
  }
  return std::sqrt(sum);
}

void ExpectSame(const SessionEstimate& first, const SessionEstimate& second) {
  EXPECT_EQ(first.status, second.status);
  EXPECT_EQ(first.position_in_ecef, second.position_in_ecef);
  EXPECT_EQ(first.covariance_enu_m2, second.covariance_enu_m2);
  EXPECT_EQ(first.velocity_enu_mps, second.velocity_enu_mps);
  EXPECT_EQ(first.clock_bias_m, second.clock_bias_m);
}

TEST(EpochFilter, ErrsLessThanSingleEpochsAndAsMuchAsItSays) {
  FilterScene filtered(kDriving_mps);
  FilterScene single(kDriving_mps);
  single.scene.options.estimator = Estimator::kEpoch;
  const std::vector<ObservationEpoch> drive = filtered.Drive(90);
  const std::vector<SessionEstimate> estimates = filtered.Run(drive);
  EXPECT_LT(RmsFrom(filtered, estimates, 30), 0.6 * RmsFrom(single, single.Run(drive), 30));
  for (int i = 0; i < 90; ++i) {
    const SessionEstimate& estimate = estimates[static_cast<std::size_t>(i)];
    ASSERT_EQ(estimate.status, EstimateStatus::kFix);
    const Eigen::Vector3d error_m = filtered.ErrorEnu(estimate, i);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(std::abs(error_m[axis]), 4.0 * std::sqrt(estimate.covariance_enu_m2(axis, axis)));
    }
    if (i < 3) continue;
    EXPECT_LT((estimate.velocity_enu_mps - kDriving_mps).norm(), 0.15) << i;
  }
}

TEST(EpochFilter, TellsByHowMuchEachDopplerMissesItsVelocity) {
  const FilterScene filter_scene(kDriving_mps);
  std::vector<ObservationEpoch> drive = filter_scene.Drive(10);
  constexpr double kFault_mps = 3.0;
  SignalObservation& faulty = drive.back().signals[2];
  faulty.doppler_hz -= kFault_mps * faulty.frequency_hz / kSpeedOfLight_mps;
  drive.back().signals[4].present &= ~kHasDoppler;
  const std::unique_ptr<Session> session = filter_scene.scene.Open();
  FilterScene::Run(session.get(), drive);
  ASSERT_EQ(session->satellites().size(), drive.back().signals.size());
  for (std::size_t i = 0; i < session->satellites().size(); ++i) {
    const SatelliteStatus& satellite = session->satellites()[i];
    EXPECT_EQ(satellite.has_rate_residual, i != 4) << i;
    EXPECT_NEAR(satellite.range_rate_residual_mps, i == 2 ? kFault_mps : 0.0, 0.25) << i;
  }
}

TEST(EpochFilter, StandingStillItDoesNotWander) {
  const FilterScene filter_scene(kStill_mps);
  const std::vector<SessionEstimate> estimates = filter_scene.Run(filter_scene.Drive(90));
  for (std::size_t i = 60; i < estimates.size(); ++i) {
    // Phases tell that it stands; only what code says of where is still averaged.
    EXPECT_LT((estimates[i].position_in_ecef - estimates[i - 1].position_in_ecef).norm(), 0.4);
    EXPECT_LT(estimates[i].velocity_enu_mps.norm(), 0.1);
  }
}

TEST(EpochFilter, GoesOnThroughAnOutageWithAGrowingAccuracy) {
  const FilterScene filter_scene(kDriving_mps);
  std::vector<ObservationEpoch> drive = filter_scene.Drive(140);
  for (int i = 30; i < 130; ++i) drive[static_cast<std::size_t>(i)].signals.clear();
  const std::vector<SessionEstimate> estimates = filter_scene.Run(drive);
  bool gone = false;
  for (int i = 30; i < 130; ++i) {
    const SessionEstimate& estimate = estimates[static_cast<std::size_t>(i)];
    if (i < 38) {
      ASSERT_EQ(estimate.status, EstimateStatus::kFix) << i;
    }
    gone = gone || estimate.status != EstimateStatus::kFix;
    EXPECT_EQ(estimate.status == EstimateStatus::kFix, !gone) << i;
    if (gone) continue;
    EXPECT_LE(estimate.accuracy_m, 50.0);
    if (i > 30) {
      EXPECT_GT(estimate.accuracy_m, estimates[static_cast<std::size_t>(i) - 1].accuracy_m);
    }
    EXPECT_LT(filter_scene.HorizontalError(estimate, i), 3.0 * estimate.accuracy_m);
    EXPECT_EQ(estimate.satellites_used, 0);
    EXPECT_EQ(estimate.sources, 0u);
  }
  EXPECT_TRUE(gone);  // nobody knows where a car is after a hundred seconds
  EXPECT_EQ(estimates.back().status, EstimateStatus::kFix);
  EXPECT_LT(filter_scene.HorizontalError(estimates.back(), 139), 10.0);
}

TEST(EpochFilter, WholeMillisecondsOfTheClockChangeNothing) {
  const FilterScene filter_scene(kDriving_mps);
  const std::vector<ObservationEpoch> drive = filter_scene.Drive(30);
  std::vector<ObservationEpoch> jumping = drive;
  for (std::size_t i = 15; i < jumping.size(); ++i) {
    for (SignalObservation& signal : jumping[i].signals) {
      // The tag stays: it is late by as much as the ranges are long.
      signal.pseudorange_m += 1e-3 * kSpeedOfLight_mps;
    }
  }
  const std::vector<SessionEstimate> plain = filter_scene.Run(drive);
  const std::vector<SessionEstimate> jumped = filter_scene.Run(jumping);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    // A millisecond earlier it was elsewhere, by some centimetres, and so were the satellites.
    EXPECT_LT((jumped[i].position_in_ecef - plain[i].position_in_ecef).norm(), 1.0) << i;
    EXPECT_NEAR(jumped[i].accuracy_m, plain[i].accuracy_m, 0.1 * plain[i].accuracy_m);
  }
}

TEST(EpochFilter, TheSameEpochsGiveTheSameBytesAlsoAfterAReset) {
  const FilterScene filter_scene(kDriving_mps);
  const std::vector<ObservationEpoch> drive = filter_scene.Drive(30);
  const std::vector<SessionEstimate> first = filter_scene.Run(drive);
  const std::vector<SessionEstimate> second = filter_scene.Run(drive);
  const std::unique_ptr<Session> session = filter_scene.scene.Open();
  FilterScene::Run(session.get(), filter_scene.Drive(20, 77));
  session->Reset();
  const std::vector<SessionEstimate> reset = FilterScene::Run(session.get(), drive);
  for (std::size_t i = 0; i < drive.size(); ++i) {
    ExpectSame(first[i], second[i]);
    ExpectSame(first[i], reset[i]);
  }
}

TEST(EpochFilter, ARestartAtAnEarlierTimeIsFollowed) {
  const FilterScene filter_scene(kDriving_mps);
  const std::vector<ObservationEpoch> drive = filter_scene.Drive(70);
  const std::unique_ptr<Session> session = filter_scene.scene.Open();
  FilterScene::Run(session.get(), {drive.begin() + 40, drive.end()});
  const std::vector<SessionEstimate> again =
      FilterScene::Run(session.get(), {drive.begin(), drive.begin() + 40});
  for (std::size_t i = 3; i < again.size(); ++i) {
    ASSERT_EQ(again[i].status, EstimateStatus::kFix) << i;
    EXPECT_LT(filter_scene.HorizontalError(again[i], static_cast<int>(i)), 15.0) << i;
  }
}

TEST(EpochFilter, TimesSinceBootAreAsGoodAndMayGoBack) {
  FilterScene filter_scene(kDriving_mps);
  const std::vector<ObservationEpoch> drive = filter_scene.Drive(60);
  const std::vector<SessionEstimate> plain = filter_scene.Run(drive);
  filter_scene.scene.options.time_base = TimeBase::kBoot;
  const std::unique_ptr<Session> session = filter_scene.scene.Open();
  for (int i = 0; i < 60; ++i) {
    const auto index = static_cast<std::size_t>(i);
    // Once the phone starts anew, while the receiver goes on.
    const std::int64_t boot_ns = (i < 30 ? 5000 + i : i - 30) * kSecond_ns;
    (void)session->PushObservationEpoch(boot_ns, drive[index]);
    ASSERT_TRUE(session->ProcessNext());
    const SessionEstimate& estimate = session->estimate();
    ASSERT_EQ(estimate.status, EstimateStatus::kFix) << i;
    if (i < 30) {
      ExpectSame(estimate, plain[index]);
    }
    EXPECT_TRUE(estimate.covariance_enu_m2.allFinite());
    EXPECT_LT(filter_scene.HorizontalError(estimate, i), 15.0) << i;
    EXPECT_LT(filter_scene.HorizontalError(estimate, i), 4.0 * estimate.accuracy_m) << i;
  }
}

// The first epochs are those of a receiver 100 m to the north.
std::vector<ObservationEpoch> BegunElsewhere(const FilterScene& filter_scene, int epochs) {
  FilterScene elsewhere = filter_scene;
  elsewhere.scene.place.latitude_rad += 100.0 / 6.37e6;
  std::vector<ObservationEpoch> drive = filter_scene.Drive(epochs);
  const std::vector<ObservationEpoch> wrong = elsewhere.Drive(4, 5);
  std::copy(wrong.begin(), wrong.end(), drive.begin());
  return drive;
}

TEST(EpochFilter, ComesBackFromAWrongStart) {
  for (const Eigen::Vector3d& velocity_mps : {kDriving_mps, kStill_mps}) {
    const FilterScene filter_scene(velocity_mps);
    const std::vector<SessionEstimate> estimates =
        filter_scene.Run(BegunElsewhere(filter_scene, 60));
    EXPECT_GT(filter_scene.HorizontalError(estimates[3], 3), 80.0);
    for (std::size_t i = 25; i < estimates.size(); ++i) {
      const double error_m = filter_scene.HorizontalError(estimates[i], static_cast<int>(i));
      EXPECT_LT(error_m, 4.0 * estimates[i].accuracy_m) << i;
      EXPECT_LT(error_m, 12.0) << i;
    }
  }
}

}  // namespace
}  // namespace lodemark::test
