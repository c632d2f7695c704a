#include "core/gnss/satellite_orbits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/gnss/broadcast_orbit.h"
#include "test/unit/gnss/orbit_scene.h"

namespace lodemark {
namespace {

constexpr std::int64_t kMinute_ns = 60 * kSecond_ns;
constexpr std::int64_t kHour_ns = 60 * kMinute_ns;
constexpr SatelliteId kGps5 = {System::kGps, 5};
constexpr SignalCode kL1 = {'1', 'C'};

KeplerEphemeris SetAt(std::int64_t toe_ns, std::int64_t sent_ns, int issue) {
  KeplerEphemeris set = FullSet(kGps5, MessageType::kLnav);
  set.toe_gps_ns = toe_ns;
  set.toc_gps_ns = toe_ns;
  set.transmitted_gps_ns = sent_ns;
  set.issue_of_data = issue;
  return set;
}

TEST(SatelliteOrbits, KnowsNothingAtFirst) {
  const SatelliteOrbits orbits;
  SatelliteState state;
  EXPECT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns, 0.0, &state), OrbitVerdict::kNoEphemeris);
  EXPECT_EQ(orbits.GlonassChannel(3), kUnknownGlonassChannel);
}

TEST(SatelliteOrbits, TakesTheNewestSetAlreadySent) {
  SatelliteOrbits orbits;
  EXPECT_TRUE(orbits.Add(SetAt(kSceneToe_ns + 2 * kHour_ns, kSceneToe_ns + 10 * kMinute_ns, 2)));
  EXPECT_TRUE(orbits.Add(SetAt(kSceneToe_ns, kSceneToe_ns - kHour_ns, 1)));
  EXPECT_TRUE(orbits.Add(SetAt(kSceneToe_ns, kSceneToe_ns + 5 * kMinute_ns, 3)));  // an upload
  SatelliteState state;
  ASSERT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_EQ(state.issue_of_data, 1);
  ASSERT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns + 6 * kMinute_ns, 0.0, &state),
            OrbitVerdict::kGood);
  EXPECT_EQ(state.issue_of_data, 3);
  ASSERT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns + 11 * kMinute_ns, 0.0, &state),
            OrbitVerdict::kGood);
  EXPECT_EQ(state.issue_of_data, 2);
  EXPECT_EQ(state.reference_gps_ns, kSceneToe_ns + 2 * kHour_ns);
}

TEST(SatelliteOrbits, TakesASetFromTheFutureOnlyWhereThePastHasNone) {
  SatelliteOrbits orbits;
  orbits.Add(SetAt(kSceneToe_ns, kSceneToe_ns, 1));
  orbits.Add(SetAt(kSceneToe_ns + 2 * kHour_ns, kSceneToe_ns + 2 * kHour_ns, 2));
  SatelliteState state;
  ASSERT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns - kHour_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_EQ(state.issue_of_data, 1);
  ASSERT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns + 110 * kMinute_ns, 0.0, &state),
            OrbitVerdict::kGood);
  EXPECT_EQ(state.issue_of_data, 1);
}

TEST(SatelliteOrbits, GrowsTooOld) {
  SatelliteOrbits orbits;
  orbits.Add(FullSet(kGps5, MessageType::kLnav));
  orbits.Add(FullSet({System::kGalileo, 5}, MessageType::kInav));
  orbits.Add(FullSet({System::kBeidou, 25}, MessageType::kD1));
  orbits.Add(FullSet({System::kQzss, 2}, MessageType::kLnav));
  orbits.Add(GlonassSet(3));
  struct Case {
    SatelliteId satellite;
    std::int64_t limit_ns;
  };
  SatelliteState state;
  for (const Case& c :
       {Case{kGps5, 150 * kMinute_ns}, Case{{System::kGalileo, 5}, 4 * kHour_ns},
        Case{{System::kBeidou, 25}, 150 * kMinute_ns}, Case{{System::kQzss, 2}, 90 * kMinute_ns},
        Case{{System::kGlonass, 3}, 30 * kMinute_ns}}) {
    for (const int sign : {-1, 1}) {
      EXPECT_EQ(orbits.AtTime(c.satellite, kL1, kSceneToe_ns + sign * c.limit_ns, 0.0, &state),
                OrbitVerdict::kGood);
      EXPECT_EQ(orbits.AtTime(c.satellite, kL1, kSceneToe_ns + sign * (c.limit_ns + kSecond_ns),
                              0.0, &state),
                OrbitVerdict::kTooOld);
    }
  }
}

TEST(SatelliteOrbits, BelievesTheNewestSetThatItIsUnhealthy) {
  SatelliteOrbits orbits;
  orbits.Add(SetAt(kSceneToe_ns, kSceneToe_ns - kHour_ns, 1));
  KeplerEphemeris sick = SetAt(kSceneToe_ns, kSceneToe_ns, 2);
  sick.healthy = false;
  sick.health = 63;
  orbits.Add(sick);
  SatelliteState state;
  EXPECT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns - 1, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns, 0.0, &state), OrbitVerdict::kUnhealthy);
}

TEST(SatelliteOrbits, KeepsASetOnce) {
  SatelliteOrbits orbits;
  EXPECT_TRUE(orbits.Add(FullSet(kGps5, MessageType::kLnav)));
  EXPECT_FALSE(orbits.Add(FullSet(kGps5, MessageType::kLnav)));
  EXPECT_TRUE(orbits.Add(FullSet(kGps5, MessageType::kCnav)));
  EXPECT_TRUE(orbits.Add(GlonassSet(3)));
  EXPECT_FALSE(orbits.Add(GlonassSet(3)));
  EXPECT_EQ(orbits.GlonassChannel(3), -4);
}

TEST(SatelliteOrbits, RefusesWhatNoSatelliteSends) {
  SatelliteOrbits orbits;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  KeplerEphemeris set = FullSet(kGps5, MessageType::kLnav);
  set.eccentricity = nan;
  EXPECT_FALSE(orbits.Add(set));
  set = FullSet({System::kGps, 33}, MessageType::kLnav);
  EXPECT_FALSE(orbits.Add(set));
  set = FullSet({System::kGps, 0}, MessageType::kLnav);
  EXPECT_FALSE(orbits.Add(set));
  set = FullSet(kGps5, MessageType::kLnav);
  set.toe_gps_ns = std::numeric_limits<std::int64_t>::max();
  EXPECT_FALSE(orbits.Add(set));
  StateEphemeris state = GlonassSet(3);
  state.position_in_ecef.setZero();
  EXPECT_FALSE(orbits.Add(state));
  state = GlonassSet(3);
  state.l2_delay_s = nan;
  EXPECT_FALSE(orbits.Add(state));
}

TEST(SatelliteOrbits, ForgetsTheOldestSetWhenFull) {
  SatelliteOrbits orbits;
  const int sets = static_cast<int>(SatelliteOrbits::kMostSets) + 40;
  for (int i = 0; i < sets; ++i) {
    const std::int64_t toe_ns = kSceneToe_ns + i * 2 * kHour_ns;
    EXPECT_TRUE(orbits.Add(SetAt(toe_ns, toe_ns - kHour_ns, i)));
  }
  SatelliteState state;
  EXPECT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns, 0.0, &state), OrbitVerdict::kTooOld);
  EXPECT_EQ(orbits.AtTime(kGps5, kL1, kSceneToe_ns + sets * 2 * kHour_ns, 0.0, &state),
            OrbitVerdict::kGood);
  EXPECT_FALSE(orbits.Add(SetAt(kSceneToe_ns, kSceneToe_ns, 1)));
}

TEST(SatelliteOrbits, PrefersTheGalileoMessageMadeForTheSignal) {
  SatelliteOrbits orbits;
  const SatelliteId satellite = {System::kGalileo, 5};
  KeplerEphemeris inav = FullSet(satellite, MessageType::kInav);
  KeplerEphemeris fnav = FullSet(satellite, MessageType::kFnav);
  inav.issue_of_data = 1;
  fnav.issue_of_data = 2;
  orbits.Add(inav);
  orbits.Add(fnav);
  SatelliteState state;
  ASSERT_EQ(orbits.AtTime(satellite, {'5', 'Q'}, kSceneToe_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_EQ(state.issue_of_data, 2);
  ASSERT_EQ(orbits.AtTime(satellite, {'1', 'C'}, kSceneToe_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_EQ(state.issue_of_data, 1);
}

// The clock difference across the flight is what makes the reading of the satellite at
// transmission: reception - pseudorange / c = transmission + clock.
TEST(SatelliteOrbits, FindsTheTimeOfTransmission) {
  SatelliteOrbits orbits;
  KeplerEphemeris fast = FullSet(kGps5, MessageType::kLnav);
  fast.clock_bias_s = 9e-4;
  fast.group_delays.tgd_s = 1.1e-8;
  orbits.Add(fast);
  orbits.Add(GlonassSet(3));
  constexpr double kPseudorange_m = 22'345'678.9;
  constexpr double kReceiverClock_s = 3e-4;
  for (const SatelliteId satellite : {kGps5, SatelliteId{System::kGlonass, 3}}) {
    SatelliteState sent;
    ASSERT_EQ(orbits.AtTransmission(satellite, kL1, kSceneToe_ns, kPseudorange_m, kReceiverClock_s,
                                    &sent),
              OrbitVerdict::kGood);
    const double flight_s =
        kPseudorange_m / kSpeedOfLight_mps - kReceiverClock_s + sent.clock_bias_s;
    SatelliteState direct;
    ASSERT_EQ(orbits.AtTime(satellite, kL1, kSceneToe_ns, -flight_s, &direct), OrbitVerdict::kGood);
    EXPECT_LT((sent.position_in_ecef - direct.position_in_ecef).norm(), 1e-7);
    EXPECT_LT((sent.velocity_in_ecef - direct.velocity_in_ecef).norm(), 1e-6);
    EXPECT_NEAR(sent.clock_bias_s, direct.clock_bias_s, 1e-17);
    EXPECT_EQ(sent.transmitted_gps_ns, direct.transmitted_gps_ns);

    SatelliteState reading;  // the receiver's own reading with no clock error means the same
    ASSERT_EQ(orbits.AtTransmission(satellite, kL1, kSceneToe_ns + 300'000, kPseudorange_m, 0.0,
                                    &reading),
              OrbitVerdict::kGood);
    EXPECT_LT((sent.position_in_ecef - reading.position_in_ecef).norm(), 1e-6);
  }
}

TEST(SatelliteOrbits, AppliesTheGroupDelayOfTheSignal) {
  SatelliteOrbits orbits;
  KeplerEphemeris set = FullSet(kGps5, MessageType::kLnav);
  set.group_delays.tgd_s = 1.1e-8;
  orbits.Add(set);
  const double plain_s = KeplerState(set, kSceneToe_ns, 0.0).clock_bias_s;
  SatelliteState state;
  ASSERT_EQ(orbits.AtTime(kGps5, {'1', 'C'}, kSceneToe_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_NEAR(state.clock_bias_s, plain_s - 1.1e-8, 1e-18);
  ASSERT_EQ(orbits.AtTime(kGps5, {'2', 'W'}, kSceneToe_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_NEAR(state.clock_bias_s, plain_s - 1.1e-8 * std::pow(77.0 / 60.0, 2), 1e-18);

  // A CNAV set of the satellite tells more, though its orbit is not the one used.
  KeplerEphemeris cnav = FullSet(kGps5, MessageType::kCnav);
  cnav.group_delays.isc_l1ca_s = -4e-10;
  cnav.issue_of_data = 99;
  orbits.Add(cnav);
  ASSERT_EQ(orbits.AtTime(kGps5, {'1', 'C'}, kSceneToe_ns, 0.0, &state), OrbitVerdict::kGood);
  EXPECT_NEAR(state.clock_bias_s, plain_s - 1.1e-8 - 4e-10, 1e-18);
  EXPECT_EQ(state.issue_of_data, 17);
}

TEST(SatelliteOrbits, AnswersNonsenseWithNoEphemeris) {
  SatelliteOrbits orbits;
  orbits.Add(FullSet(kGps5, MessageType::kLnav));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  SatelliteState state;
  const SatelliteId nobody = {static_cast<System>(200), 250};
  EXPECT_EQ(orbits.AtTime(nobody, kL1, kSceneToe_ns, 0.0, &state), OrbitVerdict::kNoEphemeris);
  for (const double value : {nan, infinity, -infinity, 1e300}) {
    EXPECT_NE(orbits.AtTime(kGps5, kL1, kSceneToe_ns, value, &state), OrbitVerdict::kGood);
    EXPECT_NE(orbits.AtTransmission(kGps5, kL1, kSceneToe_ns, value, 0.0, &state),
              OrbitVerdict::kGood);
    EXPECT_NE(orbits.AtTransmission(kGps5, kL1, kSceneToe_ns, 2e7, value, &state),
              OrbitVerdict::kGood);
  }
  for (const std::int64_t time_ns : {kMost, kLeast, std::int64_t{-1}, std::int64_t{0}}) {
    EXPECT_NE(orbits.AtTime(kGps5, kL1, time_ns, 0.1, &state), OrbitVerdict::kGood);
    EXPECT_NE(orbits.AtTransmission(kGps5, kL1, time_ns, 2e7, 0.0, &state), OrbitVerdict::kGood);
  }
  EXPECT_EQ(orbits.GlonassChannel(-5), kUnknownGlonassChannel);
  EXPECT_EQ(orbits.GlonassChannel(1'000'000), kUnknownGlonassChannel);
}

}  // namespace
}  // namespace lodemark
