// Any bytes as a truth.csv or trajectory.csv: what is read can be written and read again.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/logs/trajectory.h"

namespace {

void Require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  auto lines = lodemark::LineReader::FromMemory("input", bytes);
  lodemark::ReadReport report;
  const auto track = lodemark::ReadTrajectory(&lines, &report);
  if (!track) return 0;

  std::string text = lodemark::TrajectoryHeader();
  for (const lodemark::TrajectoryPoint& point : track->points()) {
    lodemark::AppendTrajectoryRow(point, &text);
    const auto at = track->At(point.time_gps_ns + 1);
    if (at) Require(std::isfinite(*at->latitude_deg) && std::isfinite(*at->longitude_deg));
  }
  auto written = lodemark::LineReader::FromMemory("written", text);
  lodemark::ReadReport again;
  const auto copy = lodemark::ReadTrajectory(&written, &again);
  Require(copy.ok() && again.rows_skipped == 0);
  Require(copy->points().size() == track->points().size());
  return 0;
}
