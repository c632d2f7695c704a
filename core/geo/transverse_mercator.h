// Eastings and northings of a transverse Mercator grid, as surveyors give them: UTM, Gauss-Krueger.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "core/geo/geodetic.h"

namespace lodemark {

// A grid on the WGS 84 ellipsoid. Those of GRS 80 and CGCS2000 differ from it by less than 0.2 mm
// in a northing.
struct TransverseMercatorGrid {
  double central_meridian_rad = 0.0;
  double central_scale = 1.0;
  double false_easting_m = 500'000.0;
  double false_northing_m = 0.0;
};

// By name: "utm11N" or "11N" (6-degree zone and hemisphere, scale 0.9996), or
// "tm:MERIDIAN_DEG,SCALE,FALSE_EASTING_M,FALSE_NORTHING_M", whose numbers but the first may be left
// out (1, 500000, 0). Nothing for other text or numbers no grid has.
std::optional<TransverseMercatorGrid> GridByName(std::string_view name);

// The height above the ellipsoid passes through. Nothing further than 80 degrees from the central
// meridian's great circle or beyond the poles, where no grid is used.
std::optional<Geodetic> GeodeticFromGrid(const TransverseMercatorGrid& grid, double easting_m,
                                         double northing_m, double height_m);

// East, north, up in the grid: easting, northing, height.
Eigen::Vector3d GridFromGeodetic(const TransverseMercatorGrid& grid, const Geodetic& place);

}  // namespace lodemark
