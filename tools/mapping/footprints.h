// Footprints of buildings from GeoJSON (RFC 7946) with the tags of OpenStreetMap.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/geo/convex_parts.h"

namespace lodemark {

// How high a building is when its tags say otherwise, or nothing.
struct HeightRules {
  double default_m = 10.0;       // without height and levels: three storeys
  double default_sigma_m = 5.0;  // ... give or take
  double level_m = 3.0;          // a storey, as OpenStreetMap's Simple 3D Buildings has it
  double given_sigma_m = 1.0;    // of a height that is tagged
  double levels_sigma_m = 2.0;   // of one counted in levels, and in quadrature
  double levels_share = 0.1;     // this share of the height
};

struct Footprint {
  std::string building;               // name or id, plain text
  std::size_t feature = 0;            // its number in the file, from 1
  std::vector<Outline> outlines_deg;  // longitude, latitude
  double base_m = 0.0;                // above the ground
  double top_m = 0.0;
  double top_sigma_m = 0.0;
  bool is_part = false;  // building:part: of a building that may have an outline of its own
};

struct Footprints {
  std::vector<Footprint> buildings;
  std::size_t without_height = 0;  // which got the default
  std::vector<std::string> notes;  // sentences on what was passed over
};

constexpr std::size_t kLargestFootprintFile_bytes = std::size_t{256} << 20;

// Polygons and MultiPolygons with their height, building:levels, min_height, building:min_level;
// what is tagged as no building, and other geometry, is passed over. kBadData, with one sentence
// that names file and feature, for what is no GeoJSON, or a ring or a height that cannot be.
Result<Footprints> ParseFootprints(const std::string& name, std::string_view text,
                                   const HeightRules& rules);

// "12", "12.5 m", "40 ft", "40'6\"" in metres; empty if it is none of these.
std::optional<double> ParseLength_m(std::string_view text);

}  // namespace lodemark
