#include "core/gnss/android_observables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "test/unit/gnss/android_scene.h"

namespace lodemark {
namespace {

constexpr std::int64_t kTime_gps_ns = 2'300 * kWeek_ns + 123'456'789'012'345;
constexpr std::int64_t kTravel_ns = 70'123'456;

struct Converted {
  ObservationEpoch epoch;
  std::vector<RawOutcome> outcomes;
  bool usable = false;

  RawVerdict verdict(std::size_t i = 0) const { return outcomes.at(i).verdict; }
  double range_m(std::size_t i = 0) const { return epoch.signals.at(i).pseudorange_m; }
};

Converted Convert(const AndroidScene& scene, AndroidObservables* observables) {
  Converted result;
  result.usable = observables->Convert(scene.epoch, &result.epoch, &result.outcomes);
  return result;
}

Converted ConvertFresh(const AndroidScene& scene) {
  AndroidObservables observables;
  return Convert(scene, &observables);
}

TEST(AndroidObservables, GivesTheTravelTimeTimesTheSpeedOfLight) {
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 7, kTowState, kTravel_ns);
  const Converted result = ConvertFresh(scene);
  ASSERT_TRUE(result.usable);
  ASSERT_EQ(result.verdict(), RawVerdict::kGood);
  EXPECT_EQ(result.epoch.time_gps_ns, kTime_gps_ns);
  EXPECT_EQ(result.epoch.signals[0].satellite, (SatelliteId{System::kGps, 7}));
  EXPECT_EQ(result.epoch.signals[0].signal, (SignalCode{'1', 'C'}));
  EXPECT_NEAR(result.range_m(), LightMeters(kTravel_ns), 1e-4);
  EXPECT_NEAR(result.epoch.signals[0].pseudorange_sigma_m, LightMeters(20), 1e-9);
}

TEST(AndroidObservables, SurvivesWeekRolloverInFlight) {
  for (const std::int64_t after_ns : {30'000'000LL, 0LL, 70'123'456LL, -1LL}) {
    AndroidScene scene(2'300 * kWeek_ns + after_ns);
    scene.Add(1, 7, kTowState, kTravel_ns);
    scene.Add(6, 7, kTowState | 1024, kTravel_ns);
    const Converted result = ConvertFresh(scene);
    ASSERT_EQ(result.epoch.signals.size(), 2u) << after_ns;
    EXPECT_NEAR(result.range_m(0), LightMeters(kTravel_ns), 1e-4) << after_ns;
    EXPECT_NEAR(result.range_m(1), LightMeters(kTravel_ns), 1e-4) << after_ns;
  }
}

TEST(AndroidObservables, SurvivesBeidouWeekRolloverInFlight) {
  AndroidScene scene(2'300 * kWeek_ns + 14 * kSecond_ns + 30'000'000);
  scene.Add(5, 21, kTowState, 80'000'000);
  EXPECT_NEAR(ConvertFresh(scene).range_m(), LightMeters(80'000'000), 1e-4);
}

TEST(AndroidObservables, SurvivesGlonassDayRolloverInFlight) {
  // 21:00:18 GPS time is midnight of GLONASS.
  AndroidScene scene(2'300 * kWeek_ns + kDay_ns - (3 * 3600 - 18) * kSecond_ns + 30'000'000);
  const AndroidMeasurement raw = scene.Add(3, 5, kGlonassTodState, kTravel_ns, kDay_ns);
  EXPECT_EQ(raw.received_sv_time_ns, kDay_ns + 30'000'000 - kTravel_ns);
  EXPECT_NEAR(ConvertFresh(scene).range_m(), LightMeters(kTravel_ns), 1e-4);
}

TEST(AndroidObservables, RejectsAWholeSecondOfError) {
  AndroidScene scene(kTime_gps_ns);
  for (int i = 0; i < 3; ++i) scene.Add(1, 1 + i, kTowState, kTravel_ns);
  scene.epoch.measurements[0].received_sv_time_ns -= kSecond_ns;
  const Converted result = ConvertFresh(scene);
  EXPECT_EQ(result.verdict(0), RawVerdict::kImplausibleRange);
  EXPECT_EQ(result.verdict(1), RawVerdict::kGood);
}

TEST(AndroidObservables, KeepsTheNanosecondsThatADoubleWouldLose) {
  AndroidScene scene(1'455'000'000'123'456'789);
  scene.Add(1, 1, kTowState, 70'000'000);
  scene.Add(1, 2, kTowState, 70'000'001);
  const Converted result = ConvertFresh(scene);
  EXPECT_NEAR(result.range_m(1) - result.range_m(0), LightMeters(1), 1e-6);
}

TEST(AndroidObservables, CarriesTheBiasFractionInTagAndRange) {
  AndroidScene scene(kTime_gps_ns);
  scene.epoch.clock.present |= kClockHasBias;
  scene.epoch.clock.bias_ns = 0.25;
  scene.Add(1, 1, kTowState, kTravel_ns);
  const Converted result = ConvertFresh(scene);
  EXPECT_EQ(result.epoch.time_gps_ns, kTime_gps_ns - 1);
  EXPECT_DOUBLE_EQ(result.epoch.time_fraction_ns, 0.75);
  EXPECT_NEAR(result.range_m(), LightMeters(kTravel_ns - 0.25), 1e-4);
}

TEST(AndroidObservables, KeepsTheFractionBelowOneForAHairOfBias) {
  AndroidScene scene(kTime_gps_ns);
  scene.epoch.clock.present |= kClockHasBias;
  scene.epoch.clock.bias_ns = 1e-20;
  const Converted result = ConvertFresh(scene);
  EXPECT_EQ(result.epoch.time_gps_ns, kTime_gps_ns);
  EXPECT_EQ(result.epoch.time_fraction_ns, 0.0);
}

TEST(AndroidObservables, RefersRangeAndPhaseToTheEpochNotToTheOffset) {
  AndroidScene scene(kTime_gps_ns);
  AndroidMeasurement& raw = scene.Add(1, 1, kTowState, kTravel_ns);
  // Received 0.8 ms after the epoch while the range grows by 500 m/s.
  raw.time_offset_ns = 800'000.0;
  raw.received_sv_time_ns += 800'000;
  raw.pseudorange_rate_mps = 500.0;
  raw.accumulated_delta_range_m = 1'000.0;
  raw.accumulated_delta_range_state = 1;
  raw.present |= kMeasurementHasAccumulatedDeltaRange;
  const Converted result = ConvertFresh(scene);
  EXPECT_NEAR(result.range_m(), LightMeters(kTravel_ns) - 0.4, 1e-4);
  const SignalObservation& signal = result.epoch.signals[0];
  EXPECT_NEAR(signal.carrier_phase_cycles * kSpeedOfLight_mps / signal.frequency_hz, 999.6, 1e-6);
}

TEST(AndroidObservables, HoldsTheFirstBias) {
  AndroidObservables observables;
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 1, kTowState, kTravel_ns);
  Convert(scene, &observables);
  scene.Advance(kSecond_ns);
  scene.epoch.clock.full_bias_ns -= 300;  // the phone now thinks its clock is 300 ns behind
  scene.Add(1, 1, kTowState, kTravel_ns);
  const Converted result = Convert(scene, &observables);
  EXPECT_FALSE(result.epoch.clock_discontinuity);
  EXPECT_EQ(result.epoch.time_gps_ns, kTime_gps_ns + kSecond_ns);
  EXPECT_NEAR(result.range_m(), LightMeters(kTravel_ns - 300), 1e-4);
}

TEST(AndroidObservables, TakesTheBiasAnewWhenTheHardwareClockIsDiscontinuous) {
  AndroidObservables observables;
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 1, kTowState, kTravel_ns);
  Convert(scene, &observables);
  scene.Advance(kSecond_ns);
  scene.epoch.clock.full_bias_ns -= 300;
  ++scene.epoch.clock.hardware_clock_discontinuity_count;
  scene.Add(1, 1, kTowState, kTravel_ns);
  const Converted result = Convert(scene, &observables);
  EXPECT_TRUE(result.epoch.clock_discontinuity);
  EXPECT_EQ(result.epoch.time_gps_ns, kTime_gps_ns + kSecond_ns + 300);
  EXPECT_NEAR(result.range_m(), LightMeters(kTravel_ns), 1e-4);
}

TEST(AndroidObservables, TakesTheBiasAnewWhenItStepsMoreThanAClockCanDrift) {
  AndroidObservables observables;
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 1, kTowState, kTravel_ns);
  Convert(scene, &observables);
  scene.Advance(kSecond_ns);
  scene.epoch.clock.full_bias_ns += 379 * kMillisecond_ns;
  scene.Add(1, 1, kTowState, kTravel_ns);
  const Converted result = Convert(scene, &observables);
  EXPECT_TRUE(result.epoch.clock_discontinuity);
  EXPECT_NEAR(result.range_m(), LightMeters(kTravel_ns), 1e-4);
}

TEST(AndroidObservables, SetsAClockThatDecodedTimesShowToBeOff) {
  AndroidScene scene(kTime_gps_ns);
  for (int i = 0; i < 4; ++i) scene.Add(1, 1 + i, kTowState, kTravel_ns + i * 2'000'000);
  scene.Add(6, 3, 1 | 1024 | 2048, kTravel_ns + 9'000'000, 100 * kMillisecond_ns);
  scene.epoch.clock.full_bias_ns -= 380'300'000;  // ahead of GPS by 380.3 ms
  scene.epoch.clock.bias_uncertainty_ns = 6e9;
  scene.epoch.clock.present |= kClockHasBiasUncertainty;
  AndroidObservables observables;
  const Converted first = Convert(scene, &observables);
  ASSERT_EQ(first.epoch.signals.size(), 5u);
  EXPECT_NEAR(first.range_m(1) - first.range_m(0), LightMeters(2'000'000), 1e-3);
  EXPECT_NEAR(first.range_m(4) - first.range_m(0), LightMeters(9'000'000), 1e-3);
  EXPECT_NEAR(first.range_m(0), LightMeters(kTravel_ns), LightMeters(10'000'000));
  // What is left of the error stands in the tag as it does in the ranges.
  const double tag_error_ns = static_cast<double>(first.epoch.time_gps_ns - kTime_gps_ns);
  EXPECT_NEAR(first.range_m(0), LightMeters(kTravel_ns + tag_error_ns), 1e-3);

  const Converted second = Convert(scene, &observables);
  EXPECT_FALSE(second.epoch.clock_discontinuity);
  EXPECT_EQ(second.epoch.time_gps_ns, first.epoch.time_gps_ns);
}

TEST(AndroidObservables, ResolvesThePilotsHundredMilliseconds) {
  AndroidScene scene(kTime_gps_ns);
  scene.Add(6, 3, 2 | 32 | 1024 | 2048, 84'000'000, 100 * kMillisecond_ns);
  const Converted result = ConvertFresh(scene);
  ASSERT_EQ(result.verdict(), RawVerdict::kGood);
  EXPECT_NEAR(result.range_m(), LightMeters(84'000'000), 1e-4);
  EXPECT_TRUE(result.epoch.signals[0].flags & kSignalTimeUncertain);
}

TEST(AndroidObservables, LeavesAmbiguousWhatCouldBeMoreThanOneRange) {
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 3, 1, kTravel_ns, kMillisecond_ns);                    // code lock only
  scene.Add(6, 3, 1024 | 2, 84'000'000, 4 * kMillisecond_ns);         // E1-B code only
  scene.Add(1, 4, kTowState | 16, kTravel_ns);                        // millisecond unknown
  scene.Add(5, 30, 1 | 2 | 65536, 80'000'000, 20 * kMillisecond_ns);  // may be high or low
  const Converted result = ConvertFresh(scene);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(result.verdict(i), RawVerdict::kTimeAmbiguous) << i;
  for (const SignalObservation& signal : result.epoch.signals) {
    EXPECT_FALSE(signal.Has(kHasPseudorange));
    EXPECT_TRUE(signal.Has(kHasDoppler));
  }
}

TEST(AndroidObservables, ResolvesACodeByTheSatellitesOtherSignal) {
  AndroidScene scene(kTime_gps_ns);
  AndroidMeasurement& l5 = scene.Add(1, 3, 1, kTravel_ns + 40, kMillisecond_ns);
  l5.carrier_frequency_hz = 1'176'450'050.0;
  l5.present |= kMeasurementHasCarrierFrequency;
  scene.Add(1, 3, kTowState, kTravel_ns);
  const Converted result = ConvertFresh(scene);
  ASSERT_EQ(result.verdict(0), RawVerdict::kGood);
  EXPECT_NEAR(result.range_m(0), LightMeters(kTravel_ns + 40), 1e-4);
  EXPECT_EQ(result.epoch.signals[0].signal, (SignalCode{'5', 'Q'}));
}

TEST(AndroidObservables, ResolvesACodeByTheEpochBefore) {
  AndroidObservables observables;
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 3, kTowState, kTravel_ns).pseudorange_rate_mps = LightMeters(2'000);
  Convert(scene, &observables);
  scene.Advance(kSecond_ns);
  scene.Add(1, 3, 1, kTravel_ns + 2'000, kMillisecond_ns);
  const Converted result = Convert(scene, &observables);
  ASSERT_EQ(result.verdict(), RawVerdict::kGood);
  EXPECT_NEAR(result.range_m(), LightMeters(kTravel_ns + 2'000), 1e-4);
}

TEST(AndroidObservables, SaysWhyAMeasurementGivesNoRange) {
  AndroidScene scene(kTime_gps_ns);
  scene.Add(9, 1, kTowState, kTravel_ns);
  scene.Add(1, 33, kTowState, kTravel_ns);
  AndroidMeasurement& odd = scene.Add(1, 1, kTowState, kTravel_ns);
  odd.carrier_frequency_hz = 1.4e9;
  odd.present |= kMeasurementHasCarrierFrequency;
  scene.Add(1, 2, 16384, kTravel_ns);
  scene.Add(1, 3, kTowState, kTravel_ns).received_sv_time_uncertainty_ns = 501;
  scene.Add(1, 4, kTowState, kTravel_ns);
  scene.Add(1, 4, kTowState, kTravel_ns);
  scene.Add(1, 5, kTowState, kTravel_ns).received_sv_time_ns = -1;
  scene.Add(1, 6, kTowState, kTravel_ns).time_offset_ns = std::numeric_limits<double>::quiet_NaN();
  const Converted result = ConvertFresh(scene);
  std::vector<RawVerdict> verdicts;
  for (const RawOutcome& outcome : result.outcomes) verdicts.push_back(outcome.verdict);
  using enum RawVerdict;
  EXPECT_THAT(verdicts, testing::ElementsAre(kUnknownConstellation, kUnknownSatellite,
                                             kUnknownSignal, kNotTracking, kTimeUncertain, kGood,
                                             kDuplicate, kImplausibleRange, kImplausibleRange));
}

TEST(AndroidObservables, GivesNothingWithoutABias) {
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 1, kTowState, kTravel_ns);
  scene.epoch.clock.present = 0;
  const Converted result = ConvertFresh(scene);
  EXPECT_FALSE(result.usable);
  EXPECT_TRUE(result.epoch.signals.empty());
  EXPECT_EQ(result.verdict(), RawVerdict::kClockUnusable);
}

TEST(AndroidObservables, SurvivesClocksAtTheEndsOfTheirRange) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  AndroidObservables observables;
  for (const std::int64_t time_ns : {kMin, kMax, std::int64_t{0}}) {
    for (const std::int64_t bias_ns : {kMin, kMax, std::int64_t{0}}) {
      AndroidScene scene(kTime_gps_ns);
      scene.Add(1, 1, kTowState, kTravel_ns).received_sv_time_ns = kMax;
      scene.epoch.clock.time_ns = time_ns;
      scene.epoch.clock.full_bias_ns = bias_ns;
      EXPECT_FALSE(Convert(scene, &observables).usable);
    }
  }
}

TEST(AndroidObservables, TurnsTheRangeRateIntoDoppler) {
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 1, kTowState, kTravel_ns).pseudorange_rate_mps = 100.0;
  const Converted result = ConvertFresh(scene);
  EXPECT_NEAR(result.epoch.signals[0].doppler_hz, -100.0 / 0.190293672798, 1e-6);
  EXPECT_DOUBLE_EQ(result.epoch.signals[0].range_rate_sigma_mps, 0.1);
}

TEST(AndroidObservables, PrefersAGivenPseudorange) {
  AndroidScene scene(kTime_gps_ns);
  AndroidMeasurement& raw = scene.Add(1, 1, kTowState, kTravel_ns + 3'000);
  raw.given_pseudorange_m = 21'000'000.5;
  raw.present |= kMeasurementHasGivenPseudorange;
  EXPECT_DOUBLE_EQ(ConvertFresh(scene).range_m(), 21'000'000.5);
}

TEST(AndroidObservables, DropsImplausibleStrengths) {
  AndroidScene scene(kTime_gps_ns);
  scene.Add(1, 1, kTowState, kTravel_ns).cn0_dbhz = 1.7e308;
  AndroidMeasurement& raw = scene.Add(1, 2, kTowState, kTravel_ns);
  raw.agc_db = std::numeric_limits<double>::infinity();
  raw.present |= kMeasurementHasAgc;
  raw.multipath_indicator = 1;
  const Converted result = ConvertFresh(scene);
  EXPECT_FALSE(result.epoch.signals[0].Has(kHasCn0));
  EXPECT_FALSE(result.epoch.signals[1].Has(kHasAgc));
  EXPECT_TRUE(result.epoch.signals[1].flags & kMultipathDetected);
}

}  // namespace
}  // namespace lodemark
