// How fast a GnssLogger text is read: a log of Raw rows with the inertial rows that come with them.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdio>
#include <string>

#include "core/base/random.h"
#include "core/logs/gnss_logger.h"

namespace lodemark {
namespace {

constexpr char kHeader[] =
    "# Raw,utcTimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,FullBiasNanos,BiasNanos,"
    "BiasUncertaintyNanos,DriftNanosPerSecond,DriftUncertaintyNanosPerSecond,"
    "HardwareClockDiscontinuityCount,Svid,TimeOffsetNanos,State,ReceivedSvTimeNanos,"
    "ReceivedSvTimeUncertaintyNanos,Cn0DbHz,PseudorangeRateMetersPerSecond,"
    "PseudorangeRateUncertaintyMetersPerSecond,AccumulatedDeltaRangeState,"
    "AccumulatedDeltaRangeMeters,AccumulatedDeltaRangeUncertaintyMeters,CarrierFrequencyHz,"
    "CarrierCycles,CarrierPhase,CarrierPhaseUncertainty,MultipathIndicator,SnrInDb,"
    "ConstellationType,AgcDb,BasebandCn0DbHz,FullInterSignalBiasNanos,"
    "FullInterSignalBiasUncertaintyNanos,SatelliteInterSignalBiasNanos,"
    "SatelliteInterSignalBiasUncertaintyNanos,CodeType,ChipsetElapsedRealtimeNanos\n";

// Epochs of 40 signals with all the digits a phone writes, and 10 inertial rows each.
std::string SyntheticLog(int epochs) {
  std::string text = kHeader;
  Random random(20240501);
  char row[512];
  for (int epoch = 0; epoch < epochs; ++epoch) {
    const long long time_ns = 61'000'000'000LL + epoch * 1'000'000'000LL;
    for (int i = 0; i < 40; ++i) {
      std::snprintf(row, sizeof row,
                    "Raw,%lld,%lld,18,,-1400000000123456789,%.17g,%.15f,%.17g,%.14f,22,%d,0.0,"
                    "16399,%lld,%d,%.15f,%.13f,%.16f,25,%.11f,%.18f,1575420000,,,,0,,1,%.15f,"
                    "%.15f,%.17f,1.0,%.17f,1.0,C,%lld\n",
                    1'700'000'594'000LL + epoch * 1000LL, time_ns, random.Uniform(-1.0, 0.0),
                    random.Uniform(5.0, 9.0), random.Uniform(-20.0, 20.0), random.Uniform(1.0, 9.0),
                    1 + i % 32, 250'000'111'222'333LL + epoch * 1'000'000'000LL + i, 5 + i,
                    random.Uniform(20.0, 50.0), random.Uniform(-900.0, 900.0),
                    random.Uniform(0.01, 0.5), random.Uniform(-1e6, 1e6),
                    random.Uniform(0.001, 0.01), random.Uniform(-2.0, 40.0),
                    random.Uniform(20.0, 45.0), random.Uniform(-1.0, 1.0),
                    random.Uniform(-1.0, 1.0), 16'000'555'333'000LL + epoch * 1'000'000'000LL);
      text += row;
    }
    for (int i = 0; i < 10; ++i) {
      std::snprintf(row, sizeof row, "UncalGyro,%lld,%lld,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n",
                    1'700'000'594'000LL + epoch * 1000LL + i * 100,
                    16'000'555'333'000LL + epoch * 1'000'000'000LL + i * 100'000'000LL,
                    random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0),
                    0.001, 0.002, 0.003);
      text += row;
    }
  }
  return text;
}

void ReadGnssLogger(benchmark::State& state) {
  const std::string text = SyntheticLog(static_cast<int>(state.range(0)));
  std::int64_t rows = 0;
  for (auto _ : state) {
    auto reader = GnssLoggerReader::FromLines(LineReader::FromMemory("log.txt", text));
    GnssLoggerRecord record;
    while (reader->Next(&record)) benchmark::DoNotOptimize(record);
    if (reader->report().rows_skipped != 0) state.SkipWithError("rows were skipped");
    rows += reader->report().rows_read;
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.counters["rows"] =
      benchmark::Counter(static_cast<double>(rows), benchmark::Counter::kIsRate);
}
BENCHMARK(ReadGnssLogger)->Arg(14000)->Unit(benchmark::kMillisecond)->MinTime(3.0);  // 200 MB

}  // namespace
}  // namespace lodemark

BENCHMARK_MAIN();
