// Time order, clock events and what is said about fixes.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/session/epoch_order.h"
#include "test/unit/session/session_scene.h"

namespace lodemark::test {
namespace {

void ShiftClock(ObservationEpoch* epoch, double shift_m) {
  for (SignalObservation& signal : epoch->signals) signal.pseudorange_m += shift_m;
}

TEST(EpochOrder, TakesWhatAdvances) {
  EpochOrder order;
  EXPECT_EQ(order.Judge(100), EpochPlace::kNext);
  EXPECT_EQ(order.Judge(101), EpochPlace::kNext);
  EXPECT_EQ(order.Judge(101), EpochPlace::kDuplicate);
  EXPECT_EQ(order.Judge(5'000), EpochPlace::kNext);
}

TEST(EpochOrder, FollowsARestartFromTheThirdEpochOn) {
  EpochOrder order;
  order.Judge(1000);
  EXPECT_EQ(order.Judge(10), EpochPlace::kBackwards);
  EXPECT_EQ(order.Judge(11), EpochPlace::kBackwards);
  EXPECT_EQ(order.Judge(12), EpochPlace::kRestart);
  EXPECT_EQ(order.Judge(13), EpochPlace::kNext);
}

TEST(EpochOrder, IsNotLedAstrayByStragglers) {
  EpochOrder order;
  order.Judge(1000);
  // They do not advance among themselves.
  EXPECT_EQ(order.Judge(12), EpochPlace::kBackwards);
  EXPECT_EQ(order.Judge(11), EpochPlace::kBackwards);
  EXPECT_EQ(order.Judge(11), EpochPlace::kBackwards);
  EXPECT_EQ(order.Judge(10), EpochPlace::kBackwards);
  // One of the true sequence ends the count.
  EXPECT_EQ(order.Judge(1001), EpochPlace::kNext);
  EXPECT_EQ(order.Judge(11), EpochPlace::kBackwards);
  EXPECT_EQ(order.Judge(12), EpochPlace::kBackwards);
  EXPECT_EQ(order.Judge(1002), EpochPlace::kNext);
}

class SessionEvents : public testing::Test {
 protected:
  const SessionEstimate& Process(const ObservationEpoch& epoch) {
    session_->ClearEvents();
    return ProcessEpoch(session_.get(), epoch);
  }
  int Count(EventKind kind) const { return CountEvents(*session_, kind); }
  double Error(double seconds) const {
    return (session_->estimate().position_in_ecef - scene_.PlaceAt(seconds)).norm();
  }

  SessionScene scene_;
  std::unique_ptr<Session> session_ = scene_.Open();
};

TEST_F(SessionEvents, AnOlderEpochIsDroppedAndReported) {
  Process(scene_.Epoch(10.0));
  const SessionEstimate& estimate = Process(scene_.Epoch(7.5));
  EXPECT_EQ(estimate.status, EstimateStatus::kNoData);
  EXPECT_EQ(estimate.time_gps_ns, kSceneStart_ns + 7'500 * kMillisecond_ns);
  EXPECT_TRUE(session_->satellites().empty());
  ASSERT_EQ(session_->events().size(), 1u);
  EXPECT_EQ(session_->events()[0].kind, EventKind::kTimeBackwards);
  EXPECT_NEAR(session_->events()[0].value, 2.5, 1e-9);
  EXPECT_EQ(session_->events()[0].time_gps_ns, estimate.time_gps_ns);
  EXPECT_EQ(session_->events()[0].text, "an epoch 2.500 s older than the last one; dropped");
  // As if it had not been.
  EXPECT_EQ(Process(scene_.Epoch(11.0)).status, EstimateStatus::kFix);
  EXPECT_TRUE(session_->events().empty());
}

TEST_F(SessionEvents, ALaterLogIsFollowedFromItsThirdEpochOn) {
  Process(scene_.Epoch(100.0));
  EXPECT_EQ(Process(scene_.Epoch(1.0)).status, EstimateStatus::kNoData);
  EXPECT_EQ(Process(scene_.Epoch(2.0)).status, EstimateStatus::kNoData);
  EXPECT_EQ(Process(scene_.Epoch(3.0)).status, EstimateStatus::kFix);
  EXPECT_EQ(Count(EventKind::kTimeBackwards), 1);
  EXPECT_LT(Error(3.0), 0.01);
  EXPECT_EQ(Process(scene_.Epoch(4.0)).status, EstimateStatus::kFix);
  EXPECT_TRUE(session_->events().empty());
}

TEST_F(SessionEvents, ADuplicateIsDroppedAndReported) {
  Process(scene_.Epoch(1.0));
  EXPECT_EQ(Process(scene_.Epoch(1.0)).status, EstimateStatus::kNoData);
  EXPECT_EQ(Count(EventKind::kDuplicateEpoch), 1);
  EXPECT_EQ(session_->events().size(), 1u);
}

TEST_F(SessionEvents, AMillisecondJumpIsRepairedAndReported) {
  constexpr double kMillisecond_m = kSpeedOfLight_mps * 1e-3;
  for (int i = 0; i < 4; ++i) Process(scene_.Epoch(i));
  for (int i = 4; i < 7; ++i) {
    // The clock is ahead by 2 ms more; the tags stay on whole seconds.
    scene_.clock_m = 30'000.0 + 2.0 * kMillisecond_m;
    const SessionEstimate& estimate = Process(scene_.Epoch(i));
    ASSERT_EQ(estimate.status, EstimateStatus::kFix);
    EXPECT_LT(Error(i), 0.01);
    EXPECT_NEAR(estimate.clock_bias_m, scene_.clock_m, 0.01);
    EXPECT_EQ(estimate.time_gps_ns, kSceneStart_ns + i * kSecond_ns);
    EXPECT_EQ(Count(EventKind::kMillisecondJump), i == 4 ? 1 : 0);
    if (i == 4) {
      EXPECT_EQ(session_->events()[0].value, 2.0);
      EXPECT_EQ(session_->events()[0].text, "the receiver clock jumped by 2 ms in code; repaired");
    }
  }
}

TEST_F(SessionEvents, ADiscontinuityIsReportedAndHarmless) {
  for (int i = 0; i < 3; ++i) Process(scene_.Epoch(i));
  ObservationEpoch epoch = scene_.Epoch(3.0);
  ShiftClock(&epoch, 123'456.0);
  epoch.time_gps_ns += 411'805;  // 123,456 m: the tag shows the step too
  epoch.clock_discontinuity = true;
  const SessionEstimate& estimate = Process(epoch);
  EXPECT_EQ(Count(EventKind::kClockDiscontinuity), 1);
  ASSERT_EQ(estimate.status, EstimateStatus::kFix);
  EXPECT_LT(Error(3.0), 0.5);
}

TEST_F(SessionEvents, ADiscontinuityOfADroppedEpochCountsForTheNext) {
  Process(scene_.Epoch(1.0));
  ObservationEpoch dropped = scene_.Epoch(1.0);
  dropped.clock_discontinuity = true;
  Process(dropped);
  EXPECT_EQ(Count(EventKind::kClockDiscontinuity), 0);
  Process(scene_.Epoch(2.0));
  EXPECT_EQ(Count(EventKind::kClockDiscontinuity), 1);
  Process(scene_.Epoch(3.0));
  EXPECT_EQ(Count(EventKind::kClockDiscontinuity), 0);
}

TEST_F(SessionEvents, TheFirstFixAndEachLossAreReportedOnce) {
  ObservationEpoch empty;
  empty.time_gps_ns = kSceneStart_ns;
  Process(empty);
  EXPECT_TRUE(session_->events().empty());
  Process(scene_.Epoch(1.0));
  EXPECT_EQ(Count(EventKind::kFirstFix), 1);
  EXPECT_EQ(session_->events()[0].value, session_->estimate().satellites_used);
  for (int loss = 0; loss < 2; ++loss) {
    empty.time_gps_ns = kSceneStart_ns + (10 * loss + 2) * kSecond_ns;
    Process(empty);
    EXPECT_EQ(Count(EventKind::kFixLost), 1);
    empty.time_gps_ns += kSecond_ns;
    Process(empty);
    EXPECT_TRUE(session_->events().empty());
    Process(scene_.Epoch(10.0 * loss + 4.0));
    EXPECT_TRUE(session_->events().empty());
  }
}

TEST_F(SessionEvents, TheOldestGiveWayAtTheLimit) {
  Process(scene_.Epoch(0.0));
  for (int i = 0; i < 300; ++i) ProcessEpoch(session_.get(), scene_.Epoch(0.0));
  ASSERT_EQ(session_->events().size(), 256u);
  EXPECT_EQ(session_->events()[0].kind, EventKind::kDuplicateEpoch);
}

}  // namespace
}  // namespace lodemark::test
