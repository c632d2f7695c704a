#include "core/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "test/unit/session/session_scene.h"

namespace lodemark::test {
namespace {

double ErrorOf(const SessionEstimate& estimate, const SessionScene& scene, double seconds) {
  return (estimate.position_in_ecef - scene.PlaceAt(seconds)).norm();
}

TEST(SessionFix, EqualsTruthFromNothingWithRangesWithoutNoise) {
  const SessionScene scene;
  const std::unique_ptr<Session> session = scene.Open();
  const SessionEstimate& first = ProcessEpoch(session.get(), scene.Epoch(0.0));
  ASSERT_EQ(first.status, EstimateStatus::kFix);
  // The coarse place that the earth's turning is reckoned from is a kilometre off at most.
  EXPECT_LT(ErrorOf(first, scene, 0.0), 0.05);
  const SessionEstimate& second = ProcessEpoch(session.get(), scene.Epoch(1.0));
  // Ranges are taken to be late rather than early, which is worth some millimetres.
  EXPECT_LT(ErrorOf(second, scene, 1.0), 0.01);
  EXPECT_NEAR(second.clock_bias_m, scene.clock_m, 0.02);
  EXPECT_EQ(second.time_gps_ns, kSceneStart_ns + kSecond_ns);
  EXPECT_EQ(second.sources, 1u);
}

TEST(SessionFix, TellsVelocityOfAMovingReceiver) {
  SessionScene scene;
  scene.velocity_enu_mps = {12.0, -5.0, 1.0};
  const std::unique_ptr<Session> session = scene.Open();
  const SessionEstimate& estimate = ProcessEpoch(session.get(), scene.Epoch(0.0));
  ASSERT_TRUE(estimate.has_velocity);
  EXPECT_LT((estimate.velocity_enu_mps - scene.velocity_enu_mps).norm(), 0.01);
  EXPECT_GT(estimate.speed_accuracy_mps, 0.0);
}

TEST(SessionFix, TakesFourSatellitesOfMixedSystemsOnceTheirBiasIsKnown) {
  SessionScene scene;
  scene.bias_of[System::kGalileo] = -2358.0;
  const std::unique_ptr<Session> session = scene.Open();
  ObservationEpoch few = scene.Epoch(0.0);
  KeepFirst(&few, System::kGps, 2);
  KeepFirst(&few, System::kGalileo, 2);
  EXPECT_EQ(ProcessEpoch(session.get(), few).status, EstimateStatus::kTooFewSatellites);

  const SessionEstimate& learned = ProcessEpoch(session.get(), scene.Epoch(1.0));
  ASSERT_EQ(learned.status, EstimateStatus::kFix);
  EXPECT_LT(ErrorOf(learned, scene, 1.0), 0.05);
  few = scene.Epoch(2.0);
  KeepFirst(&few, System::kGps, 2);
  KeepFirst(&few, System::kGalileo, 2);
  const SessionEstimate& estimate = ProcessEpoch(session.get(), few);
  ASSERT_EQ(estimate.status, EstimateStatus::kFix);
  EXPECT_LT(ErrorOf(estimate, scene, 2.0), 1.0);
  EXPECT_EQ(estimate.satellites_used, 4);
}

TEST(SessionFix, LearnsNoBiasWhenToldNotTo) {
  SessionScene scene;
  scene.options.learn_biases = false;
  const std::unique_ptr<Session> session = scene.Open();
  ASSERT_EQ(ProcessEpoch(session.get(), scene.Epoch(0.0)).status, EstimateStatus::kFix);
  ObservationEpoch few = scene.Epoch(1.0);
  KeepFirst(&few, System::kGps, 2);
  KeepFirst(&few, System::kGalileo, 2);
  EXPECT_EQ(ProcessEpoch(session.get(), few).status, EstimateStatus::kTooFewSatellites);
}

TEST(SessionFix, SaysThatThreeSatellitesAreTooFew) {
  const SessionScene scene({kSceneGps});
  const std::unique_ptr<Session> session = scene.Open();
  ASSERT_EQ(ProcessEpoch(session.get(), scene.Epoch(0.0)).status, EstimateStatus::kFix);
  ObservationEpoch epoch = scene.Epoch(1.0);
  KeepFirst(&epoch, System::kGps, 3);
  const SessionEstimate& estimate = ProcessEpoch(session.get(), epoch);
  EXPECT_EQ(estimate.status, EstimateStatus::kTooFewSatellites);
  EXPECT_EQ(estimate.satellites_seen, 3);
  EXPECT_EQ(estimate.sources, 0u);
}

TEST(SessionFix, DoesNotDependOnTheOrderOfTheSignals) {
  SessionScene scene({kSceneGps, kSceneGalileo, kSceneBeidou});
  scene.bias_of = {{System::kGalileo, 12.0}, {System::kBeidou, -40.0}};
  ObservationEpoch epoch = scene.Epoch(0.0);
  std::mt19937 random(7);
  std::normal_distribution<double> noise_m(0.0, 4.0);
  for (SignalObservation& signal : epoch.signals) signal.pseudorange_m += noise_m(random);
  const std::unique_ptr<Session> forward = scene.Open();
  const SessionEstimate first = ProcessEpoch(forward.get(), epoch);
  ASSERT_EQ(first.status, EstimateStatus::kFix);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(epoch.signals.begin(), epoch.signals.end(), random);
    const std::unique_ptr<Session> shuffled = scene.Open();
    const SessionEstimate& estimate = ProcessEpoch(shuffled.get(), epoch);
    ASSERT_EQ(estimate.status, EstimateStatus::kFix);
    EXPECT_LT((estimate.position_in_ecef - first.position_in_ecef).norm(), 0.05);
  }
}

TEST(SessionFix, HardlyMovesForOneLateSatellite) {
  const SessionScene scene;
  for (const double late_m : {30.0, 100.0, 1000.0, 100'000.0}) {
    const std::unique_ptr<Session> session = scene.Open();
    ObservationEpoch epoch = scene.Epoch(0.0);
    epoch.signals[2].pseudorange_m += late_m;
    const SessionEstimate& estimate = ProcessEpoch(session.get(), epoch);
    ASSERT_EQ(estimate.status, EstimateStatus::kFix) << late_m;
    EXPECT_LT(ErrorOf(estimate, scene, 0.0), 1.0) << late_m;
    EXPECT_EQ(session->satellites()[2].verdict, SatelliteVerdict::kOutlier) << late_m;
    EXPECT_EQ(estimate.satellites_used, static_cast<int>(epoch.signals.size()) - 1) << late_m;
  }
}

TEST(SessionFix, StatesNoProtectionLevelWithoutRedundancy) {
  const SessionScene scene({kSceneGps});
  for (const bool redundant : {false, true}) {
    const std::unique_ptr<Session> session = scene.Open();
    ObservationEpoch epoch = scene.Epoch(0.0);
    if (!redundant) epoch.signals.resize(4);
    const SessionEstimate& estimate = ProcessEpoch(session.get(), epoch);
    ASSERT_EQ(estimate.status, EstimateStatus::kFix);
    EXPECT_EQ(estimate.protection_level_m > 0.0, redundant);
    EXPECT_EQ(estimate.vertical_protection_level_m > 0.0, redundant);
  }
}

TEST(SessionFix, CountsASatelliteWithTwoSignalsOnce) {
  const SessionScene scene({kSceneGps});
  const std::unique_ptr<Session> session = scene.Open();
  ObservationEpoch epoch = scene.Epoch(0.0);
  const int satellites = static_cast<int>(epoch.signals.size());
  for (int i = 0; i < satellites; ++i) {
    SignalObservation second = epoch.signals[static_cast<std::size_t>(i)];
    second.signal = {'5', 'Q'};
    second.frequency_hz = 1176.45e6;
    second.doppler_hz *= 1176.45 / 1575.42;
    epoch.signals.push_back(second);
  }
  const SessionEstimate& estimate = ProcessEpoch(session.get(), epoch);
  ASSERT_EQ(estimate.status, EstimateStatus::kFix);
  EXPECT_EQ(estimate.satellites_used, satellites);
  EXPECT_EQ(estimate.satellites_seen, satellites);
}

TEST(SessionFix, ReportsBothSignalsOfACombinedPair) {
  SessionScene scene({kSceneGps});
  scene.options.ionosphere = IonosphereChoice::kBest;
  const std::unique_ptr<Session> session = scene.Open();
  ObservationEpoch epoch = scene.Epoch(0.0);
  const std::size_t satellites = epoch.signals.size();
  for (std::size_t i = 0; i < satellites; ++i) {
    SignalObservation second = epoch.signals[i];
    second.signal = {'2', 'W'};
    second.frequency_hz = 1227.6e6;
    second.doppler_hz *= 1227.6 / 1575.42;
    epoch.signals.push_back(second);
  }
  const SessionEstimate& estimate = ProcessEpoch(session.get(), epoch);
  ASSERT_EQ(estimate.status, EstimateStatus::kFix);
  // Without an ionosphere in the ranges, only its combination gives the truth.
  EXPECT_LT(ErrorOf(estimate, scene, 0.0), 0.05);
  EXPECT_EQ(estimate.satellites_used, static_cast<int>(satellites));
  for (std::size_t i = 0; i < satellites; ++i) {
    const SatelliteStatus& one = session->satellites()[i];
    const SatelliteStatus& two = session->satellites()[satellites + i];
    EXPECT_EQ(one.verdict, SatelliteVerdict::kUsed);
    EXPECT_EQ(two.verdict, SatelliteVerdict::kUsed);
    EXPECT_TRUE(two.has_residual);
    EXPECT_EQ(one.residual_m, two.residual_m);
    EXPECT_EQ(one.sigma_m, two.sigma_m);
  }
}

TEST(SessionFix, SaysThatOrbitsAreMissing) {
  SessionScene scene;
  scene.sets.clear();
  const ObservationEpoch epoch = SessionScene().Epoch(0.0);
  const std::unique_ptr<Session> session = scene.Open();
  for (int i = 0; i < 2; ++i) {
    ObservationEpoch now = epoch;
    now.time_gps_ns += i * kSecond_ns;
    EXPECT_EQ(ProcessEpoch(session.get(), now).status, EstimateStatus::kNoEphemeris);
    EXPECT_EQ(session->satellites()[0].verdict, SatelliteVerdict::kNoEphemeris);
  }
  // Each satellite is named once.
  EXPECT_EQ(CountEvents(*session, EventKind::kEphemerisMissing),
            static_cast<int>(epoch.signals.size()));
  EXPECT_EQ(session->events()[0].text,
            SatelliteName(epoch.signals[0].satellite) + ": no ephemeris");
}

TEST(SessionFix, LeavesOutUnhealthySatellitesUnlessTheyAreAccepted) {
  SessionScene scene;
  ObservationEpoch epoch = scene.Epoch(0.0);
  const SatelliteId sick = epoch.signals[1].satellite;
  for (KeplerEphemeris& set : scene.sets) set.healthy = set.satellite != sick;
  EXPECT_EQ(ProcessEpoch(scene.Open().get(), epoch).status, EstimateStatus::kFix);
  const std::unique_ptr<Session> strict = scene.Open();
  ProcessEpoch(strict.get(), epoch);
  EXPECT_EQ(strict->satellites()[1].verdict, SatelliteVerdict::kUnhealthy);
  scene.options.accept_unhealthy = true;
  const std::unique_ptr<Session> trusting = scene.Open();
  ProcessEpoch(trusting.get(), epoch);
  EXPECT_EQ(trusting->satellites()[1].verdict, SatelliteVerdict::kUsed);
}

TEST(SessionFix, HeedsMaskStrengthAndSystems) {
  SessionScene scene;
  ObservationEpoch epoch = scene.Epoch(0.0);
  scene.options.elevation_mask_rad = 0.6;
  scene.options.smallest_cn0_dbhz = 30.0;
  scene.options.systems = 1u << static_cast<int>(System::kGps);
  epoch.signals[0].cn0_dbhz = 29.0;
  const std::unique_ptr<Session> session = scene.Open();
  ProcessEpoch(session.get(), epoch);
  int low = 0;
  for (const SatelliteStatus& status : session->satellites()) {
    if (status.satellite.system == System::kGalileo) {
      EXPECT_EQ(status.verdict, SatelliteVerdict::kSystemOff);
    } else if (status.elevation_rad < 0.6) {
      EXPECT_EQ(status.verdict, SatelliteVerdict::kLowElevation);
      ++low;
    } else if (status.cn0_dbhz < 30.0) {
      EXPECT_EQ(status.verdict, SatelliteVerdict::kWeakSignal);
    } else {
      EXPECT_EQ(status.verdict, SatelliteVerdict::kUsed);
    }
  }
  EXPECT_GT(low, 0);
}

TEST(SessionFix, IsTheSameBitsForTheSameInput) {
  const SessionScene scene;
  const std::unique_ptr<Session> a = scene.Open();
  const std::unique_ptr<Session> b = scene.Open();
  for (int i = 0; i < 3; ++i) {
    ObservationEpoch epoch = scene.Epoch(i);
    epoch.signals[1].pseudorange_m += 25.0;
    const SessionEstimate& of_a = ProcessEpoch(a.get(), epoch);
    const SessionEstimate& of_b = ProcessEpoch(b.get(), epoch);
    EXPECT_EQ(of_a.position_in_ecef, of_b.position_in_ecef);
    EXPECT_EQ(of_a.covariance_enu_m2, of_b.covariance_enu_m2);
  }
}

TEST(SessionQueue, IsFullAtItsCapacityAndFirstInFirstOut) {
  SessionScene scene;
  scene.options.queue_capacity = 2;
  const std::unique_ptr<Session> session = scene.Open();
  EXPECT_FALSE(session->ProcessNext());
  ASSERT_TRUE(session->PushObservationEpoch(0, scene.Epoch(0.0)).ok());
  ASSERT_TRUE(session->PushObservationEpoch(0, scene.Epoch(1.0)).ok());
  const Status full = session->PushObservationEpoch(0, scene.Epoch(2.0));
  ASSERT_FALSE(full.ok());
  EXPECT_EQ(full.error().code, ErrorCode::kQueueFull);
  EXPECT_EQ(session->queued(), 2);
  EXPECT_TRUE(session->ProcessNext());
  EXPECT_EQ(session->estimate().time_gps_ns, kSceneStart_ns);
  EXPECT_EQ(session->queued(), 1);
}

TEST(SessionReset, ForgetsAllButOrbits) {
  const SessionScene scene;
  const std::unique_ptr<Session> session = scene.Open();
  ProcessEpoch(session.get(), scene.Epoch(5.0));
  ASSERT_TRUE(session->PushObservationEpoch(0, scene.Epoch(6.0)).ok());
  session->Reset();
  EXPECT_EQ(session->queued(), 0);
  EXPECT_EQ(session->estimate().status, EstimateStatus::kNoData);
  EXPECT_TRUE(session->satellites().empty());
  EXPECT_TRUE(session->events().empty());
  // An earlier time is no step back any more, and its fix is the first again.
  const SessionEstimate& estimate = ProcessEpoch(session.get(), scene.Epoch(0.0));
  EXPECT_EQ(estimate.status, EstimateStatus::kFix);
  EXPECT_EQ(CountEvents(*session, EventKind::kFirstFix), 1);
  EXPECT_EQ(session->events().size(), 1u);
  const std::unique_ptr<Session> fresh = scene.Open();
  EXPECT_EQ(estimate.position_in_ecef,
            ProcessEpoch(fresh.get(), scene.Epoch(0.0)).position_in_ecef);
}

TEST(SessionMessages, NeedATimeAndAKnownType) {
  const SessionScene scene;
  const std::unique_ptr<Session> session = scene.Open();
  const std::vector<std::uint8_t> bytes(40, 0);
  Status status = session->PushNavigationMessage(0x0101, 3, 1, 1, bytes);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kOutOfOrder);
  ProcessEpoch(session.get(), scene.Epoch(0.0));
  status = session->PushNavigationMessage(0x7777, 3, 1, 1, bytes);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kUnsupported);
  for (const std::int32_t svid : {3, 99}) {
    status = session->PushNavigationMessage(0x0101, svid, 1, 1, bytes);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::kBadData);
  }
}

}  // namespace
}  // namespace lodemark::test
