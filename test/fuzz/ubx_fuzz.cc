// Any bytes as a u-blox file: whatever is taken is finite and plausible. The same bytes once more
// with the checksums of what looks like frames put right, so that damage reaches what is inside.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/logs/ubx.h"
#include "test/fuzz/bytes.h"

namespace {

using lodemark::test::Require;

void Check(const lodemark::ObservationEpoch& epoch) {
  Require(epoch.time_gps_ns > 0 && epoch.time_gps_ns < 4'600'000'000'000'000'000);
  Require(epoch.signals.size() <= 255);
  for (const lodemark::SignalObservation& s : epoch.signals) {
    Require(s.satellite.number >= 1 &&
            s.satellite.number <= lodemark::LargestSatelliteNumber(s.satellite.system));
    Require(s.present != 0);
    Require(!s.Has(lodemark::kHasPseudorange) ||
            (s.pseudorange_m >= 1e6 && s.pseudorange_m <= 1e9 && s.pseudorange_sigma_m > 0.0));
    Require(std::isfinite(s.carrier_phase_cycles) && std::isfinite(s.doppler_hz));
    Require(std::isfinite(s.carrier_phase_sigma_m) && std::isfinite(s.range_rate_sigma_mps));
    Require(s.cn0_dbhz >= 0.0 && s.cn0_dbhz <= 80.0);
  }
}

void ReadAll(const std::string& bytes) {
  auto reader = lodemark::UbxReader::FromSource(lodemark::TextSource::FromMemory("input", bytes));
  lodemark::UbxRecord record;
  while (reader.Next(&record)) {
    if (const auto* epoch = std::get_if<lodemark::ObservationEpoch>(&record)) Check(*epoch);
    if (const auto* message = std::get_if<lodemark::LoggedNavigationMessage>(&record)) {
      Require(message->svid >= 1 && message->svid <= 255);
      Require(message->bytes.size() >= 11 && message->bytes.size() <= 40);
    }
  }
  Require(reader.message_counts().size() <= 260);
  Require(reader.report().problems.size() <= lodemark::ReadReport::kKeptProblems);
}

std::string WithGoodChecksums(std::string bytes) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  for (std::size_t i = 0; i + 8 <= bytes.size();) {
    const std::size_t length = at(i + 4) | std::size_t{at(i + 5)} << 8;
    if (at(i) != 0xB5 || at(i + 1) != 0x62 || i + 8 + length > bytes.size()) {
      ++i;
      continue;
    }
    unsigned a = 0;
    unsigned b = 0;
    for (std::size_t k = i + 2; k < i + 6 + length; ++k) {
      a += at(k);
      b += a;
    }
    bytes[i + 6 + length] = static_cast<char>(a);
    bytes[i + 7 + length] = static_cast<char>(b);
    i += 8 + length;
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes;
  if (size > 0) bytes.assign(reinterpret_cast<const char*>(data), size);
  ReadAll(bytes);
  ReadAll(WithGoodChecksums(bytes));
  return 0;
}
