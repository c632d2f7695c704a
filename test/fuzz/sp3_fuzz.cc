// Any bytes as an SP3 file.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/logs/sp3.h"

namespace {

void Require(bool law) {
  if (!law) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  lodemark::LineReader lines = lodemark::LineReader::FromMemory("input", bytes);
  lodemark::ReadReport report;
  const lodemark::Result<lodemark::PreciseOrbits> orbits = lodemark::ReadSp3(&lines, &report);
  if (!orbits) {
    Require(!orbits.error().message.empty());
    return 0;
  }
  std::int64_t count = 0;
  for (const auto& [satellite, samples] : orbits->samples) {
    Require(!samples.empty());
    for (std::size_t i = 0; i < samples.size(); ++i, ++count) {
      const lodemark::PreciseSample& sample = samples[i];
      Require(i == 0 || samples[i - 1].time_gps_ns < sample.time_gps_ns);
      Require(sample.position_in_ecef.norm() > 1e7 && sample.position_in_ecef.norm() < 1e8);
      Require(std::abs(sample.clock_bias_s) <= 1.0 && std::isfinite(sample.position_sigma_m));
    }
  }
  Require(count == report.rows_read);
  return 0;
}
