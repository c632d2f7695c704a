// Any bytes as GeoJSON of buildings: read or refused in one sentence, and what was read comes apart
// into convex parts or says why not.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/geo/polygon.h"
#include "tools/mapping/footprints.h"

namespace {

void Require(bool law) {
  if (!law) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = lodemark::ParseFootprints(
      "input", std::string_view(reinterpret_cast<const char*>(data), size), {});
  if (!read) {
    Require(read.error().message.starts_with("input: "));
    Require(read.error().message.find('\n') == std::string::npos);
    return 0;
  }
  Require(!read->buildings.empty());
  for (const lodemark::Footprint& footprint : read->buildings) {
    Require(!footprint.building.empty() && footprint.building.size() <= 204);
    Require(footprint.base_m >= 0.0 && footprint.top_m > footprint.base_m);
    Require(footprint.top_m <= 1'000.0 && footprint.top_sigma_m >= 0.0);
    for (const lodemark::Outline& outline_deg : footprint.outlines_deg) {
      lodemark::Outline outline = outline_deg;
      for (Eigen::Vector2d& corner : outline.outer) corner *= 1e5;
      for (lodemark::Ring& hole : outline.holes) {
        for (Eigen::Vector2d& corner : hole) corner *= 1e5;
      }
      const auto parts = lodemark::ConvexParts(outline);
      if (!parts) {
        Require(!parts.error().message.empty());
        continue;
      }
      for (const lodemark::Ring& part : *parts) Require(lodemark::IsConvexCounterclockwise(part));
    }
  }
  return 0;
}
