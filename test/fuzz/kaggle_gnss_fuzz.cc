// Any bytes as a Kaggle measurement file.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/logs/kaggle_gnss.h"

namespace {

void Require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  auto reader =
      lodemark::KaggleGnssReader::FromLines(lodemark::LineReader::FromMemory("input", bytes));
  if (!reader) return 0;
  lodemark::KaggleEpoch epoch;
  while (reader->Next(&epoch)) {
    Require(!epoch.raw.measurements.empty() && epoch.raw.measurements.size() <= 1024);
    Require(epoch.derived.size() == epoch.raw.measurements.size());
    Require(std::isfinite(epoch.raw.clock.bias_ns));
    for (const lodemark::AndroidMeasurement& m : epoch.raw.measurements) {
      Require(std::isfinite(m.given_pseudorange_m) && std::isfinite(m.time_offset_ns));
      Require(m.svid >= 1 && m.svid <= 255);
    }
    for (const lodemark::KaggleDerived& derived : epoch.derived) {
      if (derived.satellite_in_ecef) Require(derived.satellite_in_ecef->allFinite());
    }
  }
  return 0;
}
