#include "tools/simulator/footprints_text.h"

#include <cstddef>
#include <cstdio>

#include "core/base/units.h"

namespace lodemark {
namespace {

std::string CornerText(const Eigen::Vector2d& corner_m, const EnuFrame& frame) {
  const Geodetic place = GeodeticFromEcef(frame.ToEcef({corner_m.x(), corner_m.y(), 0.0}));
  char text[64];
  std::snprintf(text, sizeof text, "[%.9f,%.9f]", place.longitude_rad * kDegreesPerRadian,
                place.latitude_rad * kDegreesPerRadian);
  return text;
}

}  // namespace

std::string FootprintsText(const std::vector<Building>& buildings, const EnuFrame& frame) {
  std::string text = "{\"type\":\"FeatureCollection\",\"features\":[";
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    const Building& building = buildings[i];
    char properties[128];
    std::snprintf(properties, sizeof properties,
                  "{\"building\":\"yes\",\"height\":%.2f,\"min_height\":%.2f}",
                  building.base_m + building.height_m, building.base_m);
    text += i > 0 ? ",\n" : "\n";
    text += "{\"type\":\"Feature\",\"id\":" + std::to_string(i + 1) +
            ",\"properties\":" + properties +
            ",\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[";
    for (const Eigen::Vector2d& corner : building.footprint_m) {
      text += CornerText(corner, frame) + ",";
    }
    text += CornerText(building.footprint_m.front(), frame) + "]]}}";
  }
  return text + "\n]}\n";
}

}  // namespace lodemark
