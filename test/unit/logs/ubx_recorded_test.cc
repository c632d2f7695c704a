// u-blox files among the recordings against what RTKLIB's convbin makes of them: published beside
// one of them, and by the program itself for the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/base/units.h"
#include "core/gnss/navigation_message.h"
#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_observation.h"
#include "core/logs/ubx.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

const std::string kWalk = "drive/walk_boulder_20250828/gnss_1730.ubx";
const std::string kColdStart = "gnss/ublox_coldstart_20250425/16dBatt_no_interference_coldstart";

// Codes of one band go by different letters in different versions of convbin, so the band counts.
using Key = std::tuple<std::int64_t, SatelliteId, char>;  // tenths of a millisecond
using Signals = std::map<Key, SignalObservation>;

void Add(const ObservationEpoch& epoch, Signals* signals) {
  for (const SignalObservation& signal : epoch.signals) {
    const std::int64_t time = (epoch.time_gps_ns + 50'000) / 100'000;
    signals->emplace(Key{time, signal.satellite, signal.signal.band}, signal);
  }
}

struct Contents {
  Signals signals;
  std::vector<KeplerEphemeris> ephemerides;
  std::map<MessageVerdict, int> verdicts;
};

Contents OfUbx(const std::string& path) {
  Contents contents;
  Result<UbxReader> reader = UbxReader::Open(path);
  if (!reader) return contents;
  NavigationMessageDecoder decoder;
  std::vector<NavigationRecord> records;
  std::int64_t time_gps_ns = -1;
  for (UbxRecord record; reader->Next(&record);) {
    if (const auto* epoch = std::get_if<ObservationEpoch>(&record)) {
      time_gps_ns = epoch->time_gps_ns;
      Add(*epoch, &contents.signals);
    } else if (const auto* message = std::get_if<LoggedNavigationMessage>(&record)) {
      ++contents.verdicts[decoder.Push(message->type, message->svid, message->bytes, time_gps_ns,
                                       &records)];
    }
  }
  for (const NavigationRecord& record : records) {
    if (const auto* e = std::get_if<KeplerEphemeris>(&record)) contents.ephemerides.push_back(*e);
  }
  return contents;
}

Contents OfRinex(const std::string& observations, const std::string& navigation) {
  Contents contents;
  Result<RinexObservationReader> reader = RinexObservationReader::Open(observations);
  if (!reader) return contents;
  for (ObservationEpoch epoch; reader->Next(&epoch);) Add(epoch, &contents.signals);
  ReadReport report;
  const auto take = [&](const NavigationRecord& record) {
    if (const auto* e = std::get_if<KeplerEphemeris>(&record)) contents.ephemerides.push_back(*e);
  };
  EXPECT_TRUE(ReadRinexNavigation(navigation, take, &report).ok());
  return contents;
}

struct Shared {
  std::int64_t missing = 0;  // signals of RTKLIB that the reader does not have
  std::int64_t codes = 0, phases = 0, dopplers = 0, strengths = 0;
};

// RINEX has three decimals.
Shared CompareSignals(const Signals& ours, const Signals& theirs) {
  Shared shared;
  for (const auto& [key, b] : theirs) {
    const auto found = ours.find(key);
    if (found == ours.end()) {
      ++shared.missing;
      continue;
    }
    const SignalObservation& a = found->second;
    const auto near = [&](std::uint32_t field, double value, double other, std::int64_t* count) {
      if (!a.Has(field) || !b.Has(field)) return;
      ++*count;
      EXPECT_NEAR(value, other, 0.00051) << SatelliteName(a.satellite) << " " << a.signal.band;
    };
    near(kHasPseudorange, a.pseudorange_m, b.pseudorange_m, &shared.codes);
    near(kHasCarrierPhase, a.carrier_phase_cycles, b.carrier_phase_cycles, &shared.phases);
    near(kHasDoppler, a.doppler_hz, b.doppler_hz, &shared.dopplers);
    near(kHasCn0, a.cn0_dbhz, b.cn0_dbhz, &shared.strengths);
  }
  return shared;
}

// How many sets of RTKLIB the reader has, too. Twelve digits of a number are equal.
int CompareEphemerides(const std::vector<KeplerEphemeris>& ours,
                       const std::vector<KeplerEphemeris>& theirs) {
  int shared = 0;
  for (const KeplerEphemeris& b : theirs) {
    const auto a = std::find_if(ours.begin(), ours.end(), [&](const KeplerEphemeris& e) {
      return e.satellite == b.satellite && e.toe_gps_ns == b.toe_gps_ns &&
             e.issue_of_data == b.issue_of_data;
    });
    if (a == ours.end()) continue;
    ++shared;
    const auto near = [&](double value, double other) {
      EXPECT_NEAR(value, other, 1e-11 * std::abs(other)) << SatelliteName(b.satellite);
    };
    EXPECT_EQ(a->toc_gps_ns, b.toc_gps_ns);
    near(a->clock_bias_s, b.clock_bias_s);
    near(a->clock_drift_sps, b.clock_drift_sps);
    near(a->semi_major_axis_m, b.semi_major_axis_m);
    near(a->eccentricity, b.eccentricity);
    near(a->mean_anomaly_rad, b.mean_anomaly_rad);
    near(a->mean_motion_difference_radps, b.mean_motion_difference_radps);
    near(a->argument_of_perigee_rad, b.argument_of_perigee_rad);
    near(a->inclination_rad, b.inclination_rad);
    near(a->inclination_rate_radps, b.inclination_rate_radps);
    near(a->ascending_node_rad, b.ascending_node_rad);
    near(a->ascending_node_rate_radps, b.ascending_node_rate_radps);
    near(a->cuc_rad, b.cuc_rad);
    near(a->cus_rad, b.cus_rad);
    near(a->cic_rad, b.cic_rad);
    near(a->cis_rad, b.cis_rad);
    near(a->crc_m, b.crc_m);
    near(a->crs_m, b.crs_m);
  }
  return shared;
}

TEST(UbxRecorded, AWalkIsWhatConvbinMakesOfIt) {
  LODEMARK_NEEDS_RECORDING(kWalk);
  if (std::system("command -v convbin >/dev/null 2>&1") != 0) GTEST_SKIP() << "no convbin";
  const std::string stem = ::testing::TempDir() + "lodemark_ubx_walk";
  const std::string command = "convbin -r ubx -od -os -v 3.04 -o '" + stem + ".obs' -n '" + stem +
                              ".nav' '" + test::RecordingPath(kWalk) + "' >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Contents ours = OfUbx(test::RecordingPath(kWalk));
  const Contents theirs = OfRinex(stem + ".obs", stem + ".nav");

  const Shared shared = CompareSignals(ours.signals, theirs.signals);
  EXPECT_EQ(shared.missing, 0);
  // This version of convbin knows L1, L2 and E1 only.
  EXPECT_GT(shared.codes, 12'000);
  EXPECT_GT(shared.phases, 8'000);  // it leaves out uncertain ones
  EXPECT_EQ(shared.dopplers, shared.codes);
  EXPECT_EQ(shared.strengths, shared.codes);
  EXPECT_GT(ours.signals.size(), 37'000u);

  EXPECT_EQ(theirs.ephemerides.size(), 12u);
  EXPECT_EQ(CompareEphemerides(ours.ephemerides, theirs.ephemerides), 12);
  EXPECT_GE(ours.ephemerides.size(), 19u);
  EXPECT_EQ(ours.verdicts.count(MessageVerdict::kBadParity), 0u);
  EXPECT_EQ(ours.verdicts.count(MessageVerdict::kUnknownSatellite), 0u);
}

TEST(UbxRecorded, AColdStartIsWhatWasPublishedBesideIt) {
  LODEMARK_NEEDS_RECORDING(kColdStart + ".ubx.gz");
  const Contents ours = OfUbx(test::RecordingPath(kColdStart + ".ubx.gz"));
  const Contents theirs = OfRinex(test::RecordingPath(kColdStart + ".obs.gz"),
                                  test::RecordingPath(kColdStart + ".nav.gz"));
  // The u-blox file was cut after 582 epochs, RINEX goes on.
  ASSERT_FALSE(ours.signals.empty());
  const std::int64_t last = std::get<0>(ours.signals.rbegin()->first);
  Signals until;
  for (const auto& [key, signal] : theirs.signals) {
    if (std::get<0>(key) <= last) until.emplace(key, signal);
  }
  const Shared shared = CompareSignals(ours.signals, until);
  EXPECT_EQ(shared.missing, 0);
  EXPECT_GT(shared.codes, 10'000);
  EXPECT_GT(shared.phases, 6'000);
  EXPECT_EQ(shared.dopplers, shared.codes);
  EXPECT_GE(CompareEphemerides(ours.ephemerides, theirs.ephemerides), 12);
  EXPECT_EQ(ours.verdicts.count(MessageVerdict::kBadParity), 0u);
}

}  // namespace
}  // namespace lodemark
