#include "tools/simulator/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/units.h"
#include "core/gnss/android_observables.h"

namespace lodemark {
namespace {

using Name = std::pair<SatelliteId, SignalCode>;

TEST(Simulator, GivesRangesThatThePhoneRulesAccept) {
  Simulator simulator(*PresetScenario("static"));
  AndroidObservables observables;
  SimulatedEpoch epoch;
  ObservationEpoch observed;
  std::vector<RawOutcome> outcomes;
  int epochs = 0;
  while (simulator.Next(&epoch)) {
    ++epochs;
    ASSERT_TRUE(observables.Convert(epoch.raw, &observed, &outcomes));
    EXPECT_GT(observed.signals.size(), 25u);
    for (const RawOutcome& outcome : outcomes) EXPECT_EQ(outcome.verdict, RawVerdict::kGood);
  }
  EXPECT_EQ(epochs, 120);
}

// Everything that the time of transmission is made of, put together again: what is left per system
// and band is the receiver's clock, one hardware delay and the errors asked for.
TEST(Simulator, RangesAreGeometryClocksAndAtmosphereToSomeMetres) {
  const Scenario scenario = *PresetScenario("static");
  Simulator simulator(scenario);
  AndroidObservables observables;
  SimulatedEpoch epoch;
  ObservationEpoch observed;
  std::vector<RawOutcome> outcomes;
  ASSERT_TRUE(simulator.Next(&epoch));
  ASSERT_TRUE(observables.Convert(epoch.raw, &observed, &outcomes));
  const Eigen::Vector3d place = EcefFromGeodetic(scenario.place);
  std::map<std::pair<System, char>, std::vector<double>> left_m;
  for (const SignalObservation& signal : observed.signals) {
    for (const SimulatedSatellite& satellite : simulator.satellites()) {
      if (satellite.id != signal.satellite) continue;
      // Travel time and the turn of the earth by the textbook's Sagnac term instead of a rotation.
      double range_m = 2.2e7;
      TrueSatelliteState state;
      for (int i = 0; i < 5; ++i) {
        state = satellite.At(epoch.true_gps_ns, -range_m / kSpeedOfLight_mps);
        const Eigen::Vector3d& p = state.position_in_ecef;
        range_m = (p - place).norm() +
                  7.2921151467e-5 / kSpeedOfLight_mps * (p.x() * place.y() - p.y() * place.x());
      }
      const double clock_s = state.clock_bias_s + satellite.GroupDelay(signal.signal);
      left_m[{signal.satellite.system, signal.signal.band}].push_back(
          signal.pseudorange_m - range_m + kSpeedOfLight_mps * clock_s);
    }
  }
  ASSERT_EQ(left_m.size(), 6u);
  for (const auto& [group, values] : left_m) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    // Atmosphere from the zenith to 8 degrees: some 25 m of troposphere and ionosphere on L1, 40 on
    // L5.
    EXPECT_LT(*most - *least, 60.0) << SystemLetter(group.first) << group.second;
    EXPECT_LT(std::abs(*most), 100.0);
    EXPECT_GT(*least, -10.0);  // the atmosphere only delays; the clock is known to some 10 ns
  }
}

TEST(Simulator, PhaseMovesAsDopplerSays) {
  Simulator simulator(*PresetScenario("walk"));
  AndroidObservables observables;
  SimulatedEpoch epoch;
  std::map<std::pair<int, int>, AndroidMeasurement> before;
  int pairs = 0;
  int beyond = 0;
  std::map<std::pair<int, int>, AndroidMeasurement> now;
  while (simulator.Next(&epoch)) {
    now.clear();
    for (const AndroidMeasurement& m : epoch.raw.measurements) {
      const auto name = std::pair(m.constellation_type * 1000 + m.svid,
                                  static_cast<int>(m.carrier_frequency_hz / 1e8));
      now[name] = m;
      const auto old = before.find(name);
      if (old == before.end() || (m.accumulated_delta_range_state & 7) != 1 ||
          (old->second.accumulated_delta_range_state & 1) == 0) {
        continue;
      }
      const double moved_m = m.accumulated_delta_range_m - old->second.accumulated_delta_range_m;
      const double told_m = 0.5 * (m.pseudorange_rate_mps + old->second.pseudorange_rate_mps);
      const double sigma_m = 0.71 * std::hypot(m.pseudorange_rate_uncertainty_mps,
                                               old->second.pseudorange_rate_uncertainty_mps);
      ++pairs;
      // 0.2 m for the acceleration within the second.
      if (std::abs(moved_m - told_m) > 4.0 * sigma_m + 0.2) ++beyond;
    }
    before = now;
  }
  EXPECT_GT(pairs, 2000);
  EXPECT_EQ(beyond, 0);
}

TEST(Simulator, ReportsAClockThatFitsTheTrueTime) {
  Simulator simulator(*PresetScenario("static"));
  SimulatedEpoch epoch;
  std::int64_t last_time_ns = 0;
  std::int64_t last_true_ns = 0;
  while (simulator.Next(&epoch)) {
    const AndroidClock& clock = epoch.raw.clock;
    const std::int64_t believed_ns = clock.time_ns - clock.full_bias_ns;
    EXPECT_LT(std::abs(believed_ns - epoch.true_gps_ns), 80);
    EXPECT_LE(std::abs(clock.bias_ns), 0.5);
    if (last_time_ns != 0) {
      EXPECT_EQ(clock.time_ns - last_time_ns, kSecond_ns);
      // 180 ns in a second, give or take.
      const std::int64_t gained_ns = kSecond_ns - (epoch.true_gps_ns - last_true_ns);
      EXPECT_NEAR(static_cast<double>(gained_ns), 180.0, 20.0);
    }
    last_time_ns = clock.time_ns;
    last_true_ns = epoch.true_gps_ns;
  }
}

}  // namespace
}  // namespace lodemark
