// Where a map's frame lies for a fix of today.
#pragma once

#include <optional>
#include <string>

#include "core/geo/geodetic.h"
#include "core/map/feature_map.h"

namespace lodemark {

struct MapFrame {
  EnuFrame frame;        // the map's, moved to where satellites put it
  double sigma_m = 0.0;  // common to all its points, an axis: how sure that is
  std::string remark;    // one sentence where it was moved, or could not be; else empty
};

// Satellites give WGS 84 at the time of the fix; the map states its own datum and epoch. year: of
// the fix, as 2024.5; nothing: unknown, and then the map is taken as it is. A map that names no
// datum is taken for WGS 84.
MapFrame FrameForFix(const MapInfo& info, const std::optional<double>& year);

// The decimal year of a GPS time, to a day.
double YearOfGps(std::int64_t time_gps_ns);

}  // namespace lodemark
