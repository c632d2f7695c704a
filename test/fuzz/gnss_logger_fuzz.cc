// Any bytes as a GnssLogger text: whatever is taken is finite and within 64-bit arithmetic.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "core/logs/gnss_logger.h"

namespace {

constexpr std::int64_t kHalf = 4'611'686'018'427'387'904;  // 2^62

void Require(bool condition) {
  if (!condition) std::abort();
}

bool Fits(std::int64_t time_ns) { return time_ns > -kHalf && time_ns < kHalf; }

void Check(const lodemark::AndroidEpoch& epoch) {
  Require(!epoch.measurements.empty() && epoch.measurements.size() <= 1024);
  const lodemark::AndroidClock& clock = epoch.clock;
  Require(Fits(clock.time_ns) && Fits(clock.full_bias_ns) && Fits(clock.elapsed_realtime_ns));
  Require(std::isfinite(clock.bias_ns) && std::isfinite(clock.drift_nsps));
  for (const lodemark::AndroidMeasurement& m : epoch.measurements) {
    Require(m.svid >= 1 && m.svid <= 255 && Fits(m.received_sv_time_ns));
    Require(std::isfinite(m.time_offset_ns) && std::isfinite(m.cn0_dbhz));
    Require(std::isfinite(m.pseudorange_rate_mps) && std::isfinite(m.accumulated_delta_range_m));
    Require(m.code_type[sizeof m.code_type - 1] == '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  auto reader =
      lodemark::GnssLoggerReader::FromLines(lodemark::LineReader::FromMemory("input", bytes));
  if (!reader) return 0;
  lodemark::GnssLoggerRecord record;
  while (reader->Next(&record)) {
    if (const auto* epoch = std::get_if<lodemark::AndroidEpoch>(&record)) Check(*epoch);
    if (const auto* sensor = std::get_if<lodemark::LoggedSensor>(&record)) {
      for (const double value : sensor->values) Require(std::isfinite(value));
    }
    if (const auto* message = std::get_if<lodemark::LoggedNavigationMessage>(&record)) {
      Require(!message->bytes.empty() && message->bytes.size() <= 256);
    }
  }
  Require(reader->row_counts().size() <= 80);
  Require(reader->report().problems.size() <= lodemark::ReadReport::kKeptProblems);
  return 0;
}
