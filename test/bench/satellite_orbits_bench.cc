// Cost of a satellite's state at transmission, with a day of sets to choose from.
#include <benchmark/benchmark.h>

#include "core/base/units.h"
#include "core/gnss/broadcast_orbit.h"
#include "core/gnss/satellite_orbits.h"

namespace lodemark {
namespace {

constexpr std::int64_t kDay_gps_ns = 2'300 * kWeek_ns;
constexpr std::int64_t kAsked_ns = kDay_gps_ns + 43'500 * kSecond_ns;
constexpr double kPseudorange_m = 22'345'678.9;

KeplerEphemeris Set(SatelliteId satellite, MessageType type, std::int64_t toe_ns) {
  KeplerEphemeris e;
  e.satellite = satellite;
  e.type = type;
  e.toe_gps_ns = toe_ns;
  e.toc_gps_ns = toe_ns;
  e.transmitted_gps_ns = toe_ns;
  e.issue_of_data = static_cast<std::int32_t>(toe_ns / (600 * kSecond_ns) % 1024);
  const bool geosynchronous = satellite.system == System::kBeidou && satellite.number <= 5;
  e.semi_major_axis_m = geosynchronous ? 42.164e6 : 27.9e6;
  e.eccentricity = 0.012;
  e.mean_anomaly_rad = 0.7;
  e.argument_of_perigee_rad = -1.1;
  e.inclination_rad = 0.96;
  e.ascending_node_rad = 2.3;
  e.cuc_rad = 2.6e-6;
  e.cus_rad = 7.9e-6;
  e.crc_m = 262.0;
  e.crs_m = -87.0;
  e.clock_bias_s = 2.3e-4;
  e.group_delays.tgd_s = 4.6e-9;
  return e;
}

void Ask(benchmark::State& run, const SatelliteOrbits& orbits, SatelliteId satellite) {
  SatelliteState state;
  std::int64_t time_ns = kAsked_ns;
  for (auto _ : run) {
    time_ns += 1;
    const OrbitVerdict verdict =
        orbits.AtTransmission(satellite, {'1', 'C'}, time_ns, kPseudorange_m, 0.0, &state);
    if (verdict != OrbitVerdict::kGood) run.SkipWithError("no state");
    benchmark::DoNotOptimize(state);
  }
}

void AskKepler(benchmark::State& run, SatelliteId satellite, MessageType type, int minutes) {
  SatelliteOrbits orbits;
  for (int at = 0; at < 24 * 60; at += minutes) {
    orbits.Add(Set(satellite, type, kDay_gps_ns + at * 60 * kSecond_ns));
  }
  Ask(run, orbits, satellite);
}

void Gps(benchmark::State& run) { AskKepler(run, {System::kGps, 5}, MessageType::kLnav, 120); }
void Galileo(benchmark::State& run) {
  AskKepler(run, {System::kGalileo, 5}, MessageType::kInav, 10);
}
void BeidouGeostationary(benchmark::State& run) {
  AskKepler(run, {System::kBeidou, 3}, MessageType::kD2, 60);
}

void Glonass(benchmark::State& run) {
  SatelliteOrbits orbits;
  StateEphemeris e;
  e.satellite = {System::kGlonass, 3};
  e.position_in_ecef = {19'149'780.2, 16'776'976.8, 709'889.0};
  e.velocity_in_ecef = {186.57, -69.78, -3'582.94};
  for (int at = 15; at < 24 * 60; at += 30) {
    e.toe_gps_ns = kDay_gps_ns + at * 60 * kSecond_ns;
    orbits.Add(e);
  }
  Ask(run, orbits, e.satellite);
}

void Precise(benchmark::State& run) {
  const SatelliteId satellite = {System::kGps, 5};
  const KeplerEphemeris orbit = Set(satellite, MessageType::kLnav, kAsked_ns);
  PreciseOrbits table;
  for (int i = 0; i < 288; ++i) {
    PreciseSample sample;
    sample.time_gps_ns = kDay_gps_ns + i * 300 * kSecond_ns;
    sample.position_in_ecef = KeplerState(orbit, sample.time_gps_ns, 0.0).position_in_ecef;
    sample.has_clock = true;
    table.samples[satellite].push_back(sample);
  }
  SatelliteOrbits orbits;
  orbits.Add(table);
  Ask(run, orbits, satellite);
}

BENCHMARK(Gps);
BENCHMARK(Galileo);
BENCHMARK(BeidouGeostationary);
BENCHMARK(Glonass);
BENCHMARK(Precise);

}  // namespace
}  // namespace lodemark

BENCHMARK_MAIN();
