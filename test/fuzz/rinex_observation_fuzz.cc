// RINEX observations out of any bytes: what is read is plausible, and reads the same once written.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/logs/rinex_observation.h"
#include "core/logs/rinex_observation_writer.h"

namespace {

using lodemark::ObservationEpoch;
using lodemark::SignalObservation;

// Unpacked text may be a thousand times as long as the input; this much is enough.
constexpr std::size_t kMostSignals = 20'000;
constexpr std::size_t kMostEpochs = 2'000;
constexpr std::int64_t kDay_ns = 86'400LL * 1'000'000'000;

void Require(bool condition) {
  if (!condition) std::abort();
}

void CheckSignal(const SignalObservation& signal) {
  Require(signal.satellite.number >= 1 &&
          signal.satellite.number <= lodemark::LargestSatelliteNumber(signal.satellite.system));
  Require(signal.present != 0);
  if (signal.Has(lodemark::kHasPseudorange)) {
    Require(signal.pseudorange_m >= 1e6 && signal.pseudorange_m <= 1e9);
  }
  Require(std::abs(signal.carrier_phase_cycles) <= 1e11);
  Require(std::abs(signal.doppler_hz) <= 1e5);
  Require(signal.cn0_dbhz >= 0.0 && signal.cn0_dbhz < 100.0);
  Require(signal.frequency_hz == 0.0 || (signal.frequency_hz > 1e9 && signal.frequency_hz < 3e9));
}

std::string Rewritten(const lodemark::RinexObservationHeader& header,
                      const std::vector<ObservationEpoch>& epochs) {
  lodemark::RinexObservationContents contents;
  for (const ObservationEpoch& epoch : epochs) contents.Add(epoch);
  lodemark::RinexObservationHeader fitting = header;
  fitting.types = contents.types;
  fitting.glonass_channels = contents.glonass_channels;
  std::string text;
  lodemark::RinexObservationWriter writer(fitting, {"fuzz", {}, {}},
                                          [&](std::string_view piece) { text += piece; });
  for (const ObservationEpoch& epoch : epochs) writer.Write(epoch);
  writer.Finish();
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  auto reader =
      lodemark::RinexObservationReader::FromLines(lodemark::LineReader::FromMemory("input", bytes));
  if (!reader.ok()) {
    Require(!reader.error().message.empty());
    return 0;
  }
  std::vector<ObservationEpoch> epochs;
  std::size_t signal_count = 0;
  ObservationEpoch epoch;
  while (signal_count < kMostSignals && epochs.size() < kMostEpochs && reader->Next(&epoch)) {
    Require(epoch.time_gps_ns >= 0 && epoch.time_gps_ns < 121 * 366 * kDay_ns);
    for (const SignalObservation& signal : epoch.signals) CheckSignal(signal);
    signal_count += epoch.signals.size();
    epochs.push_back(epoch);
  }
  Require(reader->progress() >= 0.0 && reader->progress() <= 1.0);
  if (epochs.empty()) return 0;

  const std::string text = Rewritten(reader->header(), epochs);
  auto again = lodemark::RinexObservationReader::FromLines(
      lodemark::LineReader::FromMemory("rewritten", text));
  if (!again.ok()) {
    Require(signal_count == 0);  // a file without a signal has no types
    return 0;
  }
  for (const ObservationEpoch& before : epochs) {
    Require(again->Next(&epoch));
    Require(epoch.signals.size() <= before.signals.size());
  }
  Require(!again->Next(&epoch));
  Require(again->report().rows_skipped == 0);
  return 0;
}
