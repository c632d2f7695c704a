// What there is to photograph: buildings, trees, the ground, the light of a day.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace lodemark {

// What a building's walls are made of and look like.
enum class FacadeKind : std::uint8_t {
  kBrick,
  kStone,
  kPlaster,
  kTiles,     // small tiles, the same window everywhere
  kGlass,     // a curtain of panes, repetitive
  kConcrete,  // panels with next to nothing on them
  kFoliage,   // overgrown
  kShops,     // signs and posters
  kBus,       // for occluders
};

// "brick", "stone", "plaster", "tiles", "glass", "concrete", "foliage", "shops".
std::optional<FacadeKind> FacadeKindOf(std::string_view name);

// An upright prism.
struct Building {
  std::vector<Eigen::Vector2d> footprint_m;  // east, north; counter-clockwise, no corner twice
  double base_m = 0.0;                       // up
  double height_m = 15.0;
  FacadeKind facade = FacadeKind::kPlaster;
  std::uint64_t seed = 1;
};

struct Tree {
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
  double height_m = 8.0;
  std::uint64_t seed = 1;
};

enum class GroundKind : std::uint8_t { kPaving, kAsphalt, kGrass };

// "paving", "asphalt", "grass".
std::optional<GroundKind> GroundKindOf(std::string_view name);

// In a local frame of east, north, up in metres; the ground lies at up 0.
struct Scene {
  std::vector<Building> buildings;
  std::vector<Tree> trees;
  GroundKind ground = GroundKind::kPaving;
  std::uint64_t seed = 1;
};

// The light, and what changes from one day to another.
struct Daylight {
  double sun_azimuth_rad = 2.4;  // clockwise from north
  double sun_elevation_rad = 0.7;
  double cloud = 0.3;   // 0 clear .. 1 overcast, no shadows
  double winter = 0.0;  // 0 all leaves .. 1 none
  // Of blinds, posters, clouds: another seed is another day.
  std::uint64_t seed = 1;
};

}  // namespace lodemark
