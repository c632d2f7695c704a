// Precise orbits and clocks against broadcast ones, and broadcast sets against their successors:
// two sources that know nothing of each other.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/gnss/broadcast_orbit.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/satellite_orbits.h"
#include "core/logs/rinex_navigation.h"
#include "core/logs/sp3.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

constexpr const char* kDrive = "gnss/pixel5_mtv_20210428";
constexpr const char* kMerged = "gnss/rinex4_nav_20230312";

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::vector<NavigationRecord> ReadSets(const std::string& path) {
  std::vector<NavigationRecord> records;
  ReadReport report;
  EXPECT_TRUE(ReadRinexNavigation(
                  test::RecordingPath(path),
                  [&](const NavigationRecord& record) { records.push_back(record); }, &report)
                  .ok());
  return records;
}

PreciseOrbits ReadPrecise() {
  ReadReport report;
  Result<PreciseOrbits> orbits =
      ReadSp3(test::RecordingPath(kDrive) + "/COD0MGXFIN_20211180000_01D_05M_ORB.SP3.gz", &report);
  EXPECT_TRUE(orbits.ok());
  return orbits.ok() ? *orbits : PreciseOrbits{};
}

// The table holds centres of mass, 0.5 to 1.6 m behind the antennas that the messages describe.
TEST(RecordedPreciseOrbits, AgreeWithBroadcastWithinMetres) {
  LODEMARK_NEEDS_RECORDING(kDrive);
  SatelliteOrbits broadcast;
  SatelliteOrbits both;
  for (const NavigationRecord& record : ReadSets(std::string(kDrive) + "/hour1180.21n")) {
    if (const auto* set = std::get_if<KeplerEphemeris>(&record)) {
      broadcast.Add(*set);
      both.Add(*set);
    }
  }
  const PreciseOrbits precise = ReadPrecise();
  both.Add(precise);
  std::vector<double> position_m;
  std::vector<double> range_m;
  const std::int64_t start_ns = precise.samples.begin()->second.front().time_gps_ns;
  for (int minute = 7; minute < 350; minute += 7) {
    const std::int64_t time_ns = start_ns + minute * 60 * kSecond_ns + 123'456'789;
    std::vector<double> ranges_m;
    for (const auto& [satellite, samples] : precise.samples) {
      SatelliteState b;
      SatelliteState p;
      if (satellite.system != System::kGps ||
          broadcast.AtTime(satellite, {'1', 'C'}, time_ns, 0.0, &b) != OrbitVerdict::kGood) {
        continue;
      }
      ASSERT_EQ(both.AtTime(satellite, {'1', 'C'}, time_ns, 0.0, &p), OrbitVerdict::kGood);
      if (!p.precise) continue;  // some samples lack the clock
      const Eigen::Vector3d difference = b.position_in_ecef - p.position_in_ecef;
      position_m.push_back(difference.norm());
      EXPECT_LT(difference.norm(), 6.0) << SatelliteName(satellite);
      EXPECT_LT((b.velocity_in_ecef - p.velocity_in_ecef).norm(), 5e-3) << SatelliteName(satellite);
      EXPECT_NEAR(b.clock_drift_sps, p.clock_drift_sps, 3e-12) << SatelliteName(satellite);
      ranges_m.push_back(difference.dot(p.position_in_ecef.normalized()) -
                         kSpeedOfLight_mps * (b.clock_bias_s - p.clock_bias_s));
    }
    ASSERT_GT(ranges_m.size(), 20u);
    // What all satellites share is the difference of the two time scales.
    const double shared_m = Median(ranges_m);
    for (const double value_m : ranges_m) range_m.push_back(std::abs(value_m - shared_m));
  }
  EXPECT_LT(Median(position_m), 2.0);
  EXPECT_LT(Median(range_m), 0.8);
  EXPECT_LT(*std::max_element(range_m.begin(), range_m.end()), 6.0);
}

// Every second sample left out, and predicted from the others ten minutes apart.
TEST(RecordedPreciseOrbits, PredictTheSamplesLeftOut) {
  LODEMARK_NEEDS_RECORDING(kDrive);
  for (const auto& [satellite, samples] : ReadPrecise().samples) {
    std::vector<PreciseSample> thinned;
    for (std::size_t i = 0; i < samples.size(); i += 2) thinned.push_back(samples[i]);
    for (std::size_t i = 1; i + 1 < samples.size(); i += 2) {
      const auto state = InterpolatePrecise(thinned, samples[i].time_gps_ns, 0.0);
      if (!state) continue;
      const bool centred = i >= 10 && i + 10 < samples.size();
      EXPECT_LT((state->position_in_ecef - samples[i].position_in_ecef).norm(),
                centred ? 0.005 : 0.02)
          << SatelliteName(satellite) << " sample " << i;
    }
  }
}

// A set and its successor tell of the same orbit. Were a rotation, a week or a reference time
// wrong, they would part by kilometres where their reference times differ: geostationary sets,
// whose frame is that of toe, above all.
TEST(RecordedBroadcastOrbits, FollowEachOther) {
  LODEMARK_NEEDS_RECORDING(kMerged);
  std::map<std::pair<SatelliteId, MessageType>, std::vector<KeplerEphemeris>> kepler;
  std::map<SatelliteId, std::vector<StateEphemeris>> states;
  for (const NavigationRecord& record :
       ReadSets(std::string(kMerged) + "/BRD400DLR_S_20230710000_01D_MN.rnx.gz")) {
    if (const auto* set = std::get_if<KeplerEphemeris>(&record)) {
      if (set->healthy) kepler[{set->satellite, set->type}].push_back(*set);
    }
    if (const auto* set = std::get_if<StateEphemeris>(&record)) {
      if (set->healthy && set->type == MessageType::kFdma) states[set->satellite].push_back(*set);
    }
  }
  // By kind: the letter of the system, with g for geostationary BeiDou.
  std::map<std::string, std::vector<double>> parting_m;
  for (auto& [key, sets] : kepler) {
    std::string kind(1, SystemLetter(key.first.system));
    if (IsBeidouGeostationary(key.first)) kind += 'g';
    for (const KeplerEphemeris& set : sets) {
      for (const KeplerEphemeris& next : sets) {
        const std::int64_t age_ns = next.toe_gps_ns - set.toe_gps_ns;
        if (age_ns <= 0 || age_ns > 7'200 * kSecond_ns) continue;
        parting_m[kind].push_back((KeplerState(set, next.toe_gps_ns, 0.0).position_in_ecef -
                                   KeplerState(next, next.toe_gps_ns, 0.0).position_in_ecef)
                                      .norm());
      }
    }
  }
  for (auto& [satellite, sets] : states) {
    for (const StateEphemeris& set : sets) {
      const StateOrbit orbit(set);
      for (const StateEphemeris& next : sets) {
        if (next.toe_gps_ns - set.toe_gps_ns != 1'800 * kSecond_ns) continue;
        parting_m["R"].push_back(
            (orbit.At(next.toe_gps_ns, 0.0).position_in_ecef - next.position_in_ecef).norm());
      }
    }
  }
  struct Limit {
    const char* kind;
    double median_m;
    double most_m;
  };
  // NavIC's sets, a quarter of an hour apart, do part by tens of metres.
  for (const Limit& limit :
       {Limit{"G", 1.0, 10.0}, Limit{"E", 0.5, 3.0}, Limit{"C", 0.5, 10.0}, Limit{"Cg", 0.5, 10.0},
        Limit{"J", 2.0, 20.0}, Limit{"R", 3.0, 10.0}, Limit{"I", 40.0, 200.0}}) {
    ASSERT_GT(parting_m[limit.kind].size(), 100u) << limit.kind;
    EXPECT_LT(Median(parting_m[limit.kind]), limit.median_m) << limit.kind;
    EXPECT_LT(*std::max_element(parting_m[limit.kind].begin(), parting_m[limit.kind].end()),
              limit.most_m)
        << limit.kind;
  }
}

}  // namespace
}  // namespace lodemark
