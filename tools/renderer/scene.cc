#include "tools/renderer/scene.h"

#include <utility>

namespace lodemark {

std::optional<FacadeKind> FacadeKindOf(std::string_view name) {
  constexpr std::pair<std::string_view, FacadeKind> kNames[] = {
      {"brick", FacadeKind::kBrick},     {"stone", FacadeKind::kStone},
      {"plaster", FacadeKind::kPlaster}, {"tiles", FacadeKind::kTiles},
      {"glass", FacadeKind::kGlass},     {"concrete", FacadeKind::kConcrete},
      {"foliage", FacadeKind::kFoliage}, {"shops", FacadeKind::kShops},
  };
  for (const auto& [known, kind] : kNames) {
    if (known == name) return kind;
  }
  return std::nullopt;
}

std::optional<GroundKind> GroundKindOf(std::string_view name) {
  if (name == "paving") return GroundKind::kPaving;
  if (name == "asphalt") return GroundKind::kAsphalt;
  if (name == "grass") return GroundKind::kGrass;
  return std::nullopt;
}

}  // namespace lodemark
