#include "core/gnss/precise_orbits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/gnss/broadcast_orbit.h"
#include "core/gnss/satellite_orbits.h"
#include "test/unit/gnss/orbit_scene.h"

namespace lodemark {
namespace {

constexpr std::int64_t kStart_ns = kSceneToe_ns - 3'600 * kSecond_ns;
constexpr double kClockDrift_sps = -3e-12;

KeplerEphemeris Orbit() { return FullSet({System::kGps, 5}, MessageType::kLnav); }

double Clock(std::int64_t time_ns) {
  return 1e-4 + kClockDrift_sps * 1e-9 * static_cast<double>(time_ns - kStart_ns);
}

// A table made from a broadcast orbit, which is smooth.
std::vector<PreciseSample> Table(int samples, std::int64_t spacing_ns) {
  std::vector<PreciseSample> table;
  for (int i = 0; i < samples; ++i) {
    PreciseSample sample;
    sample.time_gps_ns = kStart_ns + i * spacing_ns;
    sample.position_in_ecef = KeplerState(Orbit(), sample.time_gps_ns, 0.0).position_in_ecef;
    sample.clock_bias_s = Clock(sample.time_gps_ns);
    sample.has_clock = true;
    table.push_back(sample);
  }
  return table;
}

constexpr std::int64_t kFiveMinutes_ns = 300 * kSecond_ns;

TEST(InterpolatePrecise, GivesTheOrbitTheTableWasMadeFrom) {
  struct Case {
    std::int64_t spacing_ns;
    double centred_m;
    double edge_m;
  };
  for (const Case& c : {Case{kFiveMinutes_ns, 1e-5, 1e-5}, Case{3 * kFiveMinutes_ns, 1e-3, 0.05}}) {
    const std::vector<PreciseSample> table = Table(25, c.spacing_ns);
    for (double at = 0.0; at <= 24.0; at += 0.37) {
      const auto time_ns =
          kStart_ns + static_cast<std::int64_t>(at * static_cast<double>(c.spacing_ns));
      const std::optional<PreciseState> state = InterpolatePrecise(table, time_ns, 0.25e-9);
      ASSERT_TRUE(state.has_value()) << at;
      const BroadcastState truth = KeplerState(Orbit(), time_ns, 0.25e-9);
      const bool centred = at >= 5.0 && at <= 19.0;
      EXPECT_LT((state->position_in_ecef - truth.position_in_ecef).norm(),
                centred ? c.centred_m : c.edge_m)
          << at;
      EXPECT_LT((state->velocity_in_ecef - truth.velocity_in_ecef).norm(), centred ? 2e-5 : 1e-2)
          << at;
      EXPECT_NEAR(state->clock_bias_s, Clock(time_ns), 1e-15);
      EXPECT_NEAR(state->clock_drift_sps, kClockDrift_sps, 1e-15);
    }
  }
}

TEST(InterpolatePrecise, GivesTheSamplesThemselves) {
  const std::vector<PreciseSample> table = Table(15, kFiveMinutes_ns);
  for (const PreciseSample& sample : table) {
    const std::optional<PreciseState> state = InterpolatePrecise(table, sample.time_gps_ns, 0.0);
    ASSERT_TRUE(state.has_value());
    EXPECT_LT((state->position_in_ecef - sample.position_in_ecef).norm(), 1e-6);
    EXPECT_NEAR(state->clock_bias_s, sample.clock_bias_s, 1e-18);
  }
}

TEST(InterpolatePrecise, EndsWithTheTable) {
  const std::vector<PreciseSample> table = Table(15, kFiveMinutes_ns);
  const std::int64_t end_ns = table.back().time_gps_ns;
  EXPECT_TRUE(InterpolatePrecise(table, kStart_ns, 0.0).has_value());
  EXPECT_TRUE(InterpolatePrecise(table, end_ns, 0.0).has_value());
  EXPECT_FALSE(InterpolatePrecise(table, kStart_ns - 1, 0.0).has_value());
  EXPECT_FALSE(InterpolatePrecise(table, end_ns + 1, 0.0).has_value());
}

TEST(InterpolatePrecise, NeedsElevenSamplesInARow) {
  std::vector<PreciseSample> table = Table(11, kFiveMinutes_ns);
  const std::int64_t time_ns = table[5].time_gps_ns;
  EXPECT_TRUE(InterpolatePrecise(table, time_ns, 0.0).has_value());
  table.pop_back();
  EXPECT_FALSE(InterpolatePrecise(table, time_ns, 0.0).has_value());
  EXPECT_FALSE(InterpolatePrecise({}, time_ns, 0.0).has_value());
}

TEST(InterpolatePrecise, DoesNotReachAcrossGapsAndManoeuvres) {
  std::vector<PreciseSample> gap = Table(40, kFiveMinutes_ns);
  const std::int64_t missing_ns = gap[20].time_gps_ns;
  std::vector<PreciseSample> maneuver = gap;
  maneuver[20].maneuver = true;
  gap.erase(gap.begin() + 20);
  for (const auto& table : {gap, maneuver}) {
    EXPECT_FALSE(InterpolatePrecise(table, missing_ns, 0.0).has_value());
    EXPECT_FALSE(InterpolatePrecise(table, missing_ns - kSecond_ns, 0.0).has_value());
    // Beside it the eleven samples of one side serve.
    for (const std::int64_t time_ns :
         {missing_ns - kFiveMinutes_ns - kSecond_ns, missing_ns + kFiveMinutes_ns + kSecond_ns}) {
      const std::optional<PreciseState> state = InterpolatePrecise(table, time_ns, 0.0);
      ASSERT_TRUE(state.has_value());
      EXPECT_LT(
          (state->position_in_ecef - KeplerState(Orbit(), time_ns, 0.0).position_in_ecef).norm(),
          1e-4);
    }
  }
}

TEST(InterpolatePrecise, IsEmptyWithoutAClock) {
  std::vector<PreciseSample> table = Table(15, kFiveMinutes_ns);
  table[7].has_clock = false;
  EXPECT_FALSE(InterpolatePrecise(table, table[7].time_gps_ns - 1, 0.0).has_value());
  EXPECT_FALSE(InterpolatePrecise(table, table[7].time_gps_ns + 1, 0.0).has_value());
  EXPECT_TRUE(InterpolatePrecise(table, table[5].time_gps_ns, 0.0).has_value());
}

TEST(InterpolatePrecise, IsEmptyWhereTheClockJumps) {
  std::vector<PreciseSample> table = Table(15, kFiveMinutes_ns);
  table[7].clock_event = true;  // at some time after sample 6
  EXPECT_FALSE(InterpolatePrecise(table, table[7].time_gps_ns - 1, 0.0).has_value());
  EXPECT_TRUE(InterpolatePrecise(table, table[7].time_gps_ns + 1, 0.0).has_value());
}

TEST(PreciseInSatelliteOrbits, ComesFirstWhereItCovers) {
  SatelliteOrbits orbits;
  const SatelliteId satellite = Orbit().satellite;
  PreciseOrbits precise;
  precise.samples[satellite] = Table(15, kFiveMinutes_ns);
  orbits.Add(precise);
  SatelliteState state;
  const std::int64_t middle_ns = kStart_ns + 7 * kFiveMinutes_ns;
  ASSERT_EQ(orbits.AtTime(satellite, {'1', 'C'}, middle_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_TRUE(state.precise);

  KeplerEphemeris set = Orbit();
  set.group_delays.tgd_s = 5e-9;
  orbits.Add(set);
  const BroadcastState truth = KeplerState(set, middle_ns, 0.0);
  ASSERT_EQ(orbits.AtTime(satellite, {'1', 'C'}, middle_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_TRUE(state.precise);
  // The table lacks the relativistic term; the harmonics of the set keep the two some 40 ps apart.
  KeplerEphemeris still = set;
  still.clock_bias_s = 0.0;
  still.clock_drift_sps = 0.0;
  still.clock_drift_rate_sps2 = 0.0;
  const double relativity_s = KeplerState(still, middle_ns, 0.0).clock_bias_s;
  EXPECT_NEAR(state.clock_bias_s, Clock(middle_ns) + relativity_s - 5e-9, 1e-10);
  EXPECT_NEAR(state.clock_drift_sps,
              kClockDrift_sps + KeplerState(still, middle_ns, 0.0).clock_drift_sps, 3e-14);
  EXPECT_LT((state.velocity_in_ecef - truth.velocity_in_ecef).norm(), 1e-5);

  ASSERT_EQ(orbits.AtTime(satellite, {'1', 'C'}, kStart_ns + 20 * kFiveMinutes_ns, 0.0, &state),
            OrbitVerdict::kGood);
  EXPECT_FALSE(state.precise);
}

TEST(PreciseInSatelliteOrbits, FindsTheTimeOfTransmission) {
  SatelliteOrbits orbits;
  const SatelliteId satellite = Orbit().satellite;
  PreciseOrbits precise;
  precise.samples[satellite] = Table(15, kFiveMinutes_ns);
  orbits.Add(precise);
  const std::int64_t time_ns = kStart_ns + 7 * kFiveMinutes_ns + 12'345;
  constexpr double kPseudorange_m = 23.4e6;
  SatelliteState sent;
  ASSERT_EQ(orbits.AtTransmission(satellite, {'1', 'C'}, time_ns, kPseudorange_m, 0.0, &sent),
            OrbitVerdict::kGood);
  SatelliteState direct;
  ASSERT_EQ(orbits.AtTime(satellite, {'1', 'C'}, time_ns,
                          -kPseudorange_m / kSpeedOfLight_mps - sent.clock_bias_s, &direct),
            OrbitVerdict::kGood);
  EXPECT_LT((sent.position_in_ecef - direct.position_in_ecef).norm(), 1e-6);
}

TEST(PreciseInSatelliteOrbits, IsNotUsedForAnUnhealthySatellite) {
  SatelliteOrbits orbits;
  KeplerEphemeris sick = Orbit();
  sick.healthy = false;
  orbits.Add(sick);
  PreciseOrbits precise;
  precise.samples[sick.satellite] = Table(15, kFiveMinutes_ns);
  orbits.Add(precise);
  SatelliteState state;
  EXPECT_EQ(orbits.AtTime(sick.satellite, {'1', 'C'}, kSceneToe_ns, 0.0, &state),
            OrbitVerdict::kUnhealthy);
}

TEST(PreciseInSatelliteOrbits, GivesNothingFiniteTimeCannotHold) {
  SatelliteOrbits orbits;
  const SatelliteId satellite = Orbit().satellite;
  PreciseOrbits scattered;  // a second apart, at opposite ends of what is let in
  scattered.samples[satellite] = Table(15, kSecond_ns);
  for (std::size_t i = 0; i < 15; ++i) {
    scattered.samples[satellite][i].position_in_ecef.setConstant(i % 2 == 0 ? 5e8 : -5e8);
  }
  orbits.Add(scattered);
  SatelliteState state;
  EXPECT_EQ(orbits.AtTime(satellite, {'1', 'C'}, kStart_ns + 7 * kSecond_ns, 0.3, &state),
            OrbitVerdict::kNoEphemeris);
}

TEST(PreciseInSatelliteOrbits, MergesTablesAndDropsNonsense) {
  SatelliteOrbits orbits;
  const SatelliteId satellite = Orbit().satellite;
  std::vector<PreciseSample> table = Table(24, kFiveMinutes_ns);
  PreciseOrbits late;
  late.samples[satellite].assign(table.begin() + 12, table.end());
  PreciseOrbits early;
  early.samples[satellite].assign(table.begin(), table.begin() + 14);  // two of them again
  PreciseSample nonsense = table[5];
  nonsense.time_gps_ns += kSecond_ns;
  nonsense.position_in_ecef.x() = std::numeric_limits<double>::quiet_NaN();
  early.samples[satellite].push_back(nonsense);
  nonsense = table[5];
  nonsense.time_gps_ns = std::numeric_limits<std::int64_t>::min();
  early.samples[satellite].push_back(nonsense);
  nonsense = table[5];
  nonsense.time_gps_ns += kSecond_ns;
  nonsense.clock_bias_s = 1e300;
  early.samples[satellite].push_back(nonsense);
  early.samples[{static_cast<System>(99), 99}] = table;
  orbits.Add(late);
  orbits.Add(early);
  SatelliteState state;
  for (int i = 0; i < 24; ++i) {
    EXPECT_EQ(orbits.AtTime(satellite, {'1', 'C'}, kStart_ns + i * kFiveMinutes_ns, 0.0, &state),
              OrbitVerdict::kGood);
  }
}

}  // namespace
}  // namespace lodemark
