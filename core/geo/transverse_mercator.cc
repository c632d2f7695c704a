#include "core/geo/transverse_mercator.h"

#include <GeographicLib/TransverseMercator.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kEquatorRadius_m = 6'378'137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
// From the central meridian, beyond which the series of the projection loses its millimetres.
constexpr double kWidestEasting_m = 9.0e6;
constexpr double kLongestNorthing_m = 1.0002e7;  // a quarter of a meridian

bool ParseWhole(std::string_view text, double* value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, *value);
  return error == std::errc() && stop == end && std::isfinite(*value);
}

std::optional<TransverseMercatorGrid> UtmByZone(std::string_view text) {
  if (text.size() < 2 || text.size() > 3) return std::nullopt;
  const char hemisphere = text.back();
  int zone = 0;
  const char* const end = text.data() + text.size() - 1;
  const auto [stop, error] = std::from_chars(text.data(), end, zone);
  if (error != std::errc() || stop != end || zone < 1 || zone > 60) return std::nullopt;
  if (hemisphere != 'N' && hemisphere != 'S' && hemisphere != 'n' && hemisphere != 's') {
    return std::nullopt;
  }
  const bool south = hemisphere == 'S' || hemisphere == 's';
  return TransverseMercatorGrid{(6.0 * zone - 183.0) * kRadiansPerDegree, 0.9996, 500'000.0,
                                south ? 10'000'000.0 : 0.0};
}

std::optional<TransverseMercatorGrid> ByNumbers(std::string_view text) {
  std::array<double, 4> numbers = {0.0, 1.0, 500'000.0, 0.0};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = text.find(',');
    if (!ParseWhole(text.substr(0, comma), &numbers[i])) return std::nullopt;
    if (comma == std::string_view::npos) break;
    if (i + 1 == numbers.size()) return std::nullopt;
    text.remove_prefix(comma + 1);
  }
  const bool sound = std::abs(numbers[0]) <= 360.0 && numbers[1] > 0.9 && numbers[1] < 1.1 &&
                     std::abs(numbers[2]) < 1e8 && std::abs(numbers[3]) < 1e8;
  if (!sound) return std::nullopt;
  return TransverseMercatorGrid{numbers[0] * kRadiansPerDegree, numbers[1], numbers[2], numbers[3]};
}

GeographicLib::TransverseMercator Projection(const TransverseMercatorGrid& grid) {
  return {kEquatorRadius_m, kFlattening, grid.central_scale};
}

}  // namespace

std::optional<TransverseMercatorGrid> GridByName(std::string_view name) {
  if (name.starts_with("tm:")) return ByNumbers(name.substr(3));
  if (name.starts_with("utm") || name.starts_with("UTM")) name.remove_prefix(3);
  return UtmByZone(name);
}

std::optional<Geodetic> GeodeticFromGrid(const TransverseMercatorGrid& grid, double easting_m,
                                         double northing_m, double height_m) {
  const double x = easting_m - grid.false_easting_m;
  const double y = northing_m - grid.false_northing_m;
  if (!(std::abs(x) < kWidestEasting_m) || !(std::abs(y) < kLongestNorthing_m)) {
    return std::nullopt;
  }
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  Projection(grid).Reverse(grid.central_meridian_rad * kDegreesPerRadian, x, y, latitude_deg,
                           longitude_deg);
  if (!std::isfinite(latitude_deg) || !std::isfinite(longitude_deg)) return std::nullopt;
  return Geodetic{latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, height_m};
}

Eigen::Vector3d GridFromGeodetic(const TransverseMercatorGrid& grid, const Geodetic& place) {
  Eigen::Vector3d at(0.0, 0.0, place.height_m);
  Projection(grid).Forward(grid.central_meridian_rad * kDegreesPerRadian,
                           place.latitude_rad * kDegreesPerRadian,
                           place.longitude_rad * kDegreesPerRadian, at.x(), at.y());
  at.x() += grid.false_easting_m;
  at.y() += grid.false_northing_m;
  return at;
}

}  // namespace lodemark
