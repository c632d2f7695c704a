// Carrier phase of raw Android measurements: sign, slips, resets and gaps.
#include <gtest/gtest.h>

#include <limits>

#include "core/gnss/android_observables.h"
#include "test/unit/gnss/android_scene.h"

namespace lodemark {
namespace {

constexpr std::int64_t kTime_gps_ns = 2'300 * kWeek_ns + 123'456'789'012'345;
constexpr double kRate_mps = 300.0;

// Six satellites tracked for a second each epoch, all with the same rate.
class AndroidPhase : public testing::Test {
 protected:
  AndroidPhase() : scene_(kTime_gps_ns) { AddSatellites(); }

  void AddSatellites() {
    for (int svid = 1; svid <= 6; ++svid) {
      AndroidMeasurement& raw = scene_.Add(1, svid, kTowState, 70'000'000);
      raw.pseudorange_rate_mps = kRate_mps;
      raw.accumulated_delta_range_m = 1'000.0 + kRate_mps * elapsed_s_;
      raw.accumulated_delta_range_state = 1;
      raw.accumulated_delta_range_uncertainty_m = 0.004;
      raw.present |= kMeasurementHasAccumulatedDeltaRange;
    }
  }

  void Advance(std::int64_t elapsed_ns) {
    scene_.Advance(elapsed_ns);
    elapsed_s_ += 1e-9 * static_cast<double>(elapsed_ns);
    AddSatellites();
  }

  AndroidMeasurement& raw(std::size_t i) { return scene_.epoch.measurements.at(i); }

  const SignalObservation& Convert(std::size_t i = 0) {
    std::vector<RawOutcome> outcomes;
    observables_.Convert(scene_.epoch, &epoch_, &outcomes);
    return epoch_.signals.at(i);
  }

  double elapsed_s_ = 0.0;
  AndroidScene scene_;
  AndroidObservables observables_;
  ObservationEpoch epoch_;
};

TEST_F(AndroidPhase, GrowsWithTheRangeWhereDopplerIsNegative) {
  const double first_cycles = Convert().carrier_phase_cycles;
  Advance(kSecond_ns);
  const SignalObservation second = Convert();
  EXPECT_NEAR(second.carrier_phase_cycles - first_cycles, kRate_mps / 0.190293672798, 1e-4);
  EXPECT_NEAR(second.doppler_hz, -kRate_mps / 0.190293672798, 1e-6);
  EXPECT_DOUBLE_EQ(second.carrier_phase_sigma_m, 0.004);
}

TEST_F(AndroidPhase, IsNotContinuousAtFirstAndIsAfterwards) {
  EXPECT_TRUE(Convert().flags & kLossOfLock);
  Advance(kSecond_ns);
  EXPECT_FALSE(Convert().flags & kLossOfLock);
}

TEST_F(AndroidPhase, IsAbsentUnlessTheStateSaysValid) {
  raw(0).accumulated_delta_range_state = 16;
  raw(1).accumulated_delta_range_m = std::numeric_limits<double>::quiet_NaN();
  raw(2).accumulated_delta_range_uncertainty_m = 3.4e38;
  Convert();
  EXPECT_FALSE(epoch_.signals[0].Has(kHasCarrierPhase));
  EXPECT_FALSE(epoch_.signals[1].Has(kHasCarrierPhase));
  EXPECT_TRUE(epoch_.signals[2].Has(kHasCarrierPhase));
  EXPECT_FALSE(epoch_.signals[2].Has(kHasCarrierPhaseSigma));
}

TEST_F(AndroidPhase, IsBrokenByResetSlipAndInvalidEpochs) {
  Convert();
  Advance(kSecond_ns);
  raw(0).accumulated_delta_range_state = 1 | 2;
  raw(1).accumulated_delta_range_state = 1 | 4;
  raw(2).accumulated_delta_range_state = 0;
  Convert();
  EXPECT_TRUE(epoch_.signals[0].flags & kLossOfLock);
  EXPECT_TRUE(epoch_.signals[1].flags & kLossOfLock);
  Advance(kSecond_ns);
  EXPECT_FALSE(Convert(0).flags & kLossOfLock);
  EXPECT_TRUE(epoch_.signals[2].flags & kLossOfLock);
}

TEST_F(AndroidPhase, IsBrokenByAnUnreportedSlip) {
  Convert();
  Advance(kSecond_ns);
  raw(3).accumulated_delta_range_m += 20.0;
  Convert();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ((epoch_.signals[i].flags & kLossOfLock) != 0, i == 3) << i;
  }
}

TEST_F(AndroidPhase, IsNotBrokenByWhatAllSatellitesShare) {
  Convert();
  Advance(kSecond_ns);
  for (std::size_t i = 0; i < 6; ++i) raw(i).accumulated_delta_range_m += 20.0;
  Convert();
  for (const SignalObservation& signal : epoch_.signals) {
    EXPECT_FALSE(signal.flags & kLossOfLock);
  }
}

TEST_F(AndroidPhase, IsBrokenByAGapAndByTheHardwareClock) {
  Convert();
  Advance(11 * kSecond_ns);
  EXPECT_TRUE(Convert().flags & kLossOfLock);
  Advance(kSecond_ns);
  EXPECT_FALSE(Convert().flags & kLossOfLock);
  Advance(kSecond_ns);
  ++scene_.epoch.clock.hardware_clock_discontinuity_count;
  EXPECT_TRUE(Convert().flags & kLossOfLock);
}

TEST_F(AndroidPhase, SaysWhenHalfACycleIsOpen) {
  raw(0).accumulated_delta_range_state = 1 | 16;
  raw(1).accumulated_delta_range_state = 1 | 16 | 8;
  Convert();
  EXPECT_TRUE(epoch_.signals[0].flags & kHalfCycleAmbiguous);
  EXPECT_FALSE(epoch_.signals[1].flags & kHalfCycleAmbiguous);
  EXPECT_FALSE(epoch_.signals[2].flags & kHalfCycleAmbiguous);
}

TEST_F(AndroidPhase, EveryDutyCycledEpochIsFlagged) {
  Convert();
  for (int i = 0; i < 3; ++i) {
    Advance(kSecond_ns);
    ++scene_.epoch.clock.hardware_clock_discontinuity_count;
    scene_.epoch.clock.full_bias_ns -= 7'000;
    EXPECT_TRUE(Convert().flags & kLossOfLock);
    EXPECT_TRUE(epoch_.clock_discontinuity);
  }
}

}  // namespace
}  // namespace lodemark
