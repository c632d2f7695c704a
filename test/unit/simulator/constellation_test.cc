#include "tools/simulator/constellation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/units.h"
#include "core/geo/time.h"

namespace lodemark {
namespace {

constexpr std::int64_t kHour_ns = 3600 * kSecond_ns;

Scenario LongScenario(std::int64_t start_gps_ns) {
  Scenario scenario = *PresetScenario("static");
  scenario.start_gps_ns = start_gps_ns;
  scenario.epochs = 5 * 3600;
  return scenario;
}

TEST(Rereferenced, TellsTheSameOrbitAndClock) {
  const auto satellites = MakeConstellation(*PresetScenario("static"));
  for (const SimulatedSatellite& satellite : satellites) {
    if (satellite.kepler_sets().empty()) continue;
    const KeplerEphemeris& first = satellite.kepler_sets().front();
    // Two hours on, and beyond the end of the week.
    for (const std::int64_t shift_ns : {2 * kHour_ns, 70 * kHour_ns}) {
      const std::int64_t time_ns = first.toe_gps_ns + shift_ns + kHour_ns / 2;
      const BroadcastState before = KeplerState(first, time_ns, 0.25);
      const BroadcastState after = KeplerState(Rereferenced(first, shift_ns), time_ns, 0.25);
      EXPECT_LT((before.position_in_ecef - after.position_in_ecef).norm(), 1e-3)
          << SatelliteName(satellite.id);
      EXPECT_NEAR(before.clock_bias_s, after.clock_bias_s, 1e-15);
    }
  }
}

TEST(MakeConstellation, GivesDistinctSatellitesOfTheSystemsAsked) {
  Scenario scenario = *PresetScenario("static");
  scenario.systems = "GE";
  std::set<SatelliteId> ids;
  for (const SimulatedSatellite& satellite : MakeConstellation(scenario)) {
    EXPECT_TRUE(satellite.id.system == System::kGps || satellite.id.system == System::kGalileo);
    EXPECT_LE(satellite.id.number, LargestSatelliteNumber(satellite.id.system));
    ids.insert(satellite.id);
  }
  EXPECT_EQ(ids.size(), 54u);
}

TEST(MakeConstellation, HasASetSentBeforeTheStartAndForAllOfTheTime) {
  const Scenario scenario = LongScenario(1'399'860'000 * kSecond_ns + 1234 * kSecond_ns);
  const std::int64_t end_ns = scenario.start_gps_ns + scenario.epochs * kSecond_ns;
  for (const SimulatedSatellite& satellite : MakeConstellation(scenario)) {
    std::int64_t first_sent_ns = 0;
    std::int64_t last_toe_ns = 0;
    if (satellite.kepler_sets().empty()) {
      first_sent_ns = satellite.state_sets().front().transmitted_gps_ns;
      last_toe_ns = satellite.state_sets().back().toe_gps_ns;
    } else {
      first_sent_ns = satellite.kepler_sets().front().transmitted_gps_ns;
      last_toe_ns = satellite.kepler_sets().back().toe_gps_ns;
    }
    EXPECT_LE(first_sent_ns, scenario.start_gps_ns) << SatelliteName(satellite.id);
    EXPECT_LE(end_ns - last_toe_ns, kHour_ns) << SatelliteName(satellite.id);
  }
}

TEST(MakeConstellation, ErrsFromTheBroadcastAsRealSystemsDo) {
  const Scenario scenario = *PresetScenario("static");
  int count = 0;
  double squares_m2 = 0.0;
  for (const SimulatedSatellite& satellite : MakeConstellation(scenario)) {
    if (satellite.kepler_sets().empty()) continue;
    const BroadcastState broadcast =
        KeplerState(satellite.kepler_sets().front(), scenario.start_gps_ns, 0.0);
    const TrueSatelliteState truth = satellite.At(scenario.start_gps_ns, 0.0);
    const double error_m = (truth.position_in_ecef - broadcast.position_in_ecef).norm();
    EXPECT_LT(error_m, 4.0);
    squares_m2 += error_m * error_m;
    ++count;
  }
  EXPECT_GT(std::sqrt(squares_m2 / count), 0.3);
  EXPECT_LT(std::sqrt(squares_m2 / count), 1.5);
}

TEST(MakeConstellation, LetsGlonassSetsContinueEachOther) {
  const Scenario scenario = LongScenario(1'399'860'000 * kSecond_ns);
  for (const SimulatedSatellite& satellite : MakeConstellation(scenario)) {
    const auto& sets = satellite.state_sets();
    for (std::size_t i = 0; i + 1 < sets.size(); ++i) {
      const std::int64_t between_ns = (sets[i].toe_gps_ns + sets[i + 1].toe_gps_ns) / 2;
      const BroadcastState before = StateOrbit(sets[i]).At(between_ns, 0.0);
      const BroadcastState after = StateOrbit(sets[i + 1]).At(between_ns, 0.0);
      EXPECT_LT((before.position_in_ecef - after.position_in_ecef).norm(), 0.01);
    }
    // 15 and 45 minutes past the hour of UTC, as the sets of GLONASS are.
    for (const StateEphemeris& set : sets) {
      const std::int64_t utc_ns = ScaleFromGps(set.toe_gps_ns, TimeScale::kUtc);
      EXPECT_EQ(FloorModulo(utc_ns, kHour_ns / 2), kHour_ns / 4);
    }
  }
}

}  // namespace
}  // namespace lodemark
