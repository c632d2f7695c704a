// Reading RINEX observations: 15 satellites of four quantities each, as a phone or a receiver of
// one frequency writes them, and the same with Hatanaka's compression undone on the way.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "core/logs/rinex_observation.h"

namespace lodemark {
namespace {

constexpr int kEpochs = 600;
constexpr int kSatellites = 15;

std::string Record(std::string content, std::string_view label) {
  content.resize(60, ' ');
  return content.append(label).append("\n");
}

std::string Head() {
  return Record("     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
         Record("G    4 C1C L1C D1C S1C", "SYS / # / OBS TYPES") + Record("", "END OF HEADER");
}

std::string PlainText() {
  std::string text = Head();
  char line[128];
  for (int n = 0; n < kEpochs; ++n) {
    std::snprintf(line, sizeof line, "> 2020 01 01 00 %02d %2d.4299102  0 %2d\n", n / 60, n % 60,
                  kSatellites);
    text += line;
    for (int s = 1; s <= kSatellites; ++s) {
      std::snprintf(line, sizeof line, "G%02d%14.3f 7%14.3f17%14.3f%16.3f\n", s,
                    20e6 + 1e5 * s + 400.123 * n, 105e6 + 5e5 * s + 2100.456 * n, -2100.456 + s,
                    40.0 + 0.25 * s);
      text += line;
    }
  }
  return text;
}

std::string CompressedText() {
  std::string text = Record("3.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE") +
                     Record("", "CRINEX PROG / DATE") + Head();
  for (int n = 0; n < kEpochs; ++n) {
    if (n == 0) {
      text += "> 2020 01 01 00 00  0.4299102  0 15      ";
      for (int s = 1; s <= kSatellites; ++s) {
        text += s < 10 ? "G0" + std::to_string(s) : "G" + std::to_string(s);
      }
    } else {
      char tag[32];
      std::snprintf(tag, sizeof tag, "%16s%02d %02d", "", n / 60, n % 60);
      text += tag;
    }
    text += "\n\n";
    for (int s = 1; s <= kSatellites; ++s) {
      text += n == 0 ? "3&2012345678" + std::to_string(s % 10) +
                           " 3&105123456789 3&-2100456 3&40250 7 7\n"
                     : std::to_string(400 + s) + " " + std::to_string(-2100 - n) + " -13 0\n";
    }
  }
  return text;
}

void ReadAll(benchmark::State& state, const std::string& text) {
  std::int64_t epochs = 0;
  std::int64_t signals = 0;
  ObservationEpoch epoch;
  for (auto _ : state) {
    auto reader = RinexObservationReader::FromLines(LineReader::FromMemory("bench", text));
    while (reader->Next(&epoch)) {
      ++epochs;
      signals += static_cast<std::int64_t>(epoch.signals.size());
    }
    benchmark::DoNotOptimize(epoch);
  }
  if (signals != epochs * kSatellites || epochs % kEpochs != 0) {
    state.SkipWithError("not every signal was read");
  }
  state.SetItemsProcessed(epochs);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(text.size()));
}

void ReadRinexObservation(benchmark::State& state) { ReadAll(state, PlainText()); }
BENCHMARK(ReadRinexObservation)->Unit(benchmark::kMillisecond);

void ReadCrinexObservation(benchmark::State& state) { ReadAll(state, CompressedText()); }
BENCHMARK(ReadCrinexObservation)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lodemark

BENCHMARK_MAIN();
