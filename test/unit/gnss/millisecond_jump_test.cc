#include "core/gnss/millisecond_jump.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kMillisecond_m = kSpeedOfLight_mps * 1e-3;
constexpr double kL1_hz = 1575.42e6;
constexpr std::int64_t kStart_gps_ns = 2'000 * kWeek_ns;

// Five satellites with steady rates, observed every second by a receiver that may misread.
struct Receiver {
  double code_ms = 0.0;
  double phase_ms = 0.0;
  std::int64_t tag_ms = 0;
  bool doppler = true;

  ObservationEpoch At(int second) const {
    ObservationEpoch epoch;
    epoch.time_gps_ns = kStart_gps_ns + second * kSecond_ns + tag_ms * kMillisecond_ns;
    for (int i = 0; i < 5; ++i) {
      const double rate_mps = 300.0 * (i - 2);
      const double range_m = 21e6 + 1e6 * i + rate_mps * second;
      SignalObservation signal;
      signal.satellite = {System::kGps, static_cast<std::uint8_t>(i + 1)};
      signal.signal = {'1', 'C'};
      signal.frequency_hz = kL1_hz;
      signal.present = kHasPseudorange | kHasCarrierPhase | (doppler ? kHasDoppler : 0u);
      signal.pseudorange_m = range_m + code_ms * kMillisecond_m;
      signal.carrier_phase_cycles =
          (range_m + phase_ms * kMillisecond_m) * kL1_hz / kSpeedOfLight_mps;
      signal.doppler_hz = -rate_mps * kL1_hz / kSpeedOfLight_mps;
      epoch.signals.push_back(signal);
    }
    return epoch;
  }
};

using Kind = MillisecondJump::Kind;

// Whole seconds 0..2 before, 3..5 after the jump.
struct Outcome {
  std::vector<std::optional<MillisecondJump>> jumps;
  std::vector<ObservationEpoch> epochs;
};

Outcome Observe(const Receiver& before, const Receiver& after) {
  Outcome outcome;
  MillisecondJumpRepair repair;
  for (int second = 0; second < 6; ++second) {
    outcome.epochs.push_back((second < 3 ? before : after).At(second));
    outcome.jumps.push_back(repair.Repair(&outcome.epochs.back()));
  }
  return outcome;
}

void ExpectOneJump(const Outcome& outcome, std::int32_t milliseconds, Kind kind) {
  for (std::size_t i = 0; i < outcome.jumps.size(); ++i) {
    EXPECT_EQ(outcome.jumps[i].has_value(), i == 3) << i;
  }
  ASSERT_TRUE(outcome.jumps[3].has_value());
  EXPECT_EQ(outcome.jumps[3]->milliseconds, milliseconds);
  EXPECT_EQ(outcome.jumps[3]->kind, kind);
}

// Codes and phases go on as if nothing had happened, and transmissions are when they were.
void ExpectContinuous(const Receiver& receiver, const Outcome& outcome, std::int64_t tag_ms = 0) {
  for (int second = 3; second < 6; ++second) {
    const ObservationEpoch& epoch = outcome.epochs[static_cast<std::size_t>(second)];
    const ObservationEpoch expected = receiver.At(second);
    EXPECT_EQ(epoch.time_gps_ns, expected.time_gps_ns + tag_ms * kMillisecond_ns);
    for (std::size_t i = 0; i < epoch.signals.size(); ++i) {
      EXPECT_NEAR(epoch.signals[i].pseudorange_m, expected.signals[i].pseudorange_m, 1e-6);
      EXPECT_NEAR(epoch.signals[i].carrier_phase_cycles, expected.signals[i].carrier_phase_cycles,
                  1e-5);
    }
  }
}

TEST(MillisecondJump, OfTagCodeAndPhaseIsTakenBack) {
  const Receiver before;
  const Outcome outcome = Observe(before, Receiver{7.0, 7.0, 7});
  ExpectOneJump(outcome, 7, Kind::kTagCodeAndPhase);
  ExpectContinuous(before, outcome);
}

TEST(MillisecondJump, OfTagAndCodeLeavesThePhase) {
  const Receiver before;
  const Outcome outcome = Observe(before, Receiver{-3.0, 0.0, -3});
  ExpectOneJump(outcome, -3, Kind::kTagAndCode);
  ExpectContinuous(before, outcome);
}

TEST(MillisecondJump, WithoutTheTagMovesTheTag) {
  const Receiver before;
  const Outcome outcome = Observe(before, Receiver{-1.0, 0.0, 0});
  ExpectOneJump(outcome, -1, Kind::kCode);
  ExpectContinuous(before, outcome, 1);
}

TEST(MillisecondJump, OfCodeAndPhaseIsTakenFromBoth) {
  const Receiver before;
  const Outcome outcome = Observe(before, Receiver{2.0, 2.0, 0});
  ExpectOneJump(outcome, 2, Kind::kCodeAndPhase);
  ExpectContinuous(before, outcome, -2);
}

TEST(MillisecondJump, OfPhasesAloneIsTakenFromThem) {
  const Receiver before;
  const Outcome outcome = Observe(before, Receiver{0.0, 4.0, 0});
  ExpectOneJump(outcome, 4, Kind::kPhase);
  ExpectContinuous(before, outcome);
}

TEST(MillisecondJump, IsFoundWithoutDoppler) {
  Receiver before;
  before.doppler = false;
  const Outcome outcome = Observe(before, Receiver{1.0, 1.0, 0, false});
  ExpectOneJump(outcome, 1, Kind::kCodeAndPhase);
}

TEST(MillisecondJump, IsNotAnIrregularInterval) {
  // Ranges that moved as long as the tag says: a receiver that samples 20 ms late.
  MillisecondJumpRepair repair;
  ObservationEpoch first = Receiver().At(0);
  ObservationEpoch second = Receiver().At(1);
  second.time_gps_ns += 20 * kMillisecond_ns;
  repair.Repair(&first);
  EXPECT_FALSE(repair.Repair(&second).has_value());
}

TEST(MillisecondJump, IsNotABrokenMillisecondNorASingleSatellites) {
  EXPECT_FALSE(Observe(Receiver(), Receiver{0.5, 0.0, 0}).jumps[3].has_value());
  MillisecondJumpRepair repair;
  ObservationEpoch first = Receiver().At(0);
  ObservationEpoch second = Receiver().At(1);
  second.signals[0].pseudorange_m += kMillisecond_m;
  repair.Repair(&first);
  EXPECT_FALSE(repair.Repair(&second).has_value());
}

TEST(MillisecondJump, ToleratesAReflectionAndAWrongMillisecond) {
  MillisecondJumpRepair repair;
  ObservationEpoch first = Receiver().At(0);
  ObservationEpoch second = Receiver{3.0, 3.0, 0}.At(1);
  second.signals[0].pseudorange_m += 500.0;
  second.signals[1].pseudorange_m += kMillisecond_m;
  repair.Repair(&first);
  const auto jump = repair.Repair(&second);
  ASSERT_TRUE(jump.has_value());
  EXPECT_EQ(jump->milliseconds, 3);
}

TEST(MillisecondJump, IsNotSoughtAcrossADiscontinuityOrAGap) {
  MillisecondJumpRepair repair;
  ObservationEpoch first = Receiver().At(0);
  ObservationEpoch second = Receiver{3.0, 3.0, 0}.At(1);
  second.clock_discontinuity = true;
  ObservationEpoch third = Receiver().At(90);
  repair.Repair(&first);
  EXPECT_FALSE(repair.Repair(&second).has_value());
  EXPECT_FALSE(repair.Repair(&third).has_value());
}

// A clock that loses a microsecond a second and is reset every thousand.
TEST(MillisecondJump, OfADriftingClockDoesNotPileUp) {
  MillisecondJumpRepair repair;
  int jumps = 0;
  int restarts = 0;
  for (int reset = 0; reset < 25; ++reset) {
    Receiver receiver;
    receiver.code_ms = reset;
    ObservationEpoch epoch = receiver.At(reset * 30);
    const double given_m = epoch.signals[2].pseudorange_m;
    if (repair.Repair(&epoch)) ++jumps;
    if (epoch.clock_discontinuity) ++restarts;
    EXPECT_LE(std::abs(epoch.signals[2].pseudorange_m - given_m), 10.001 * kMillisecond_m);
  }
  EXPECT_EQ(jumps, 24);
  EXPECT_EQ(restarts, 2);
}

}  // namespace
}  // namespace lodemark
