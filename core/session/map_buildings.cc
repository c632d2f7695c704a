#include "core/session/map_buildings.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace lodemark {

Result<BuildingScene> BuildingsOf(const FeatureMap& map) {
  if (map.info().building_parts == 0) return BuildingScene();
  Result<std::vector<BuildingPart>> parts = map.BuildingParts();
  // What version 1 of the format kept of them is of no use.
  if (!parts && parts.error().code == ErrorCode::kUnsupported) return BuildingScene();
  if (!parts) return parts.error();
  std::map<std::string, std::uint32_t> numbers;
  std::uint32_t next = 0;
  std::vector<BuildingPrism> prisms;
  prisms.reserve(parts->size());
  for (BuildingPart& part : *parts) {
    BuildingPrism prism;
    if (part.building.empty()) {
      prism.building = next++;
    } else {
      const auto [found, is_new] = numbers.emplace(std::move(part.building), next);
      if (is_new) ++next;
      prism.building = found->second;
    }
    prism.footprint = std::move(part.footprint_in_enu_m);
    prism.base_m = part.base_m;
    prism.top_m = part.top_m;
    prism.top_sigma_m = part.top_sigma_m;
    prism.raised = part.raised;
    prisms.push_back(std::move(prism));
  }
  Result<BuildingScene> scene = BuildingScene::Make(prisms);
  if (!scene) {
    return Error{ErrorCode::kBadData, "map: its buildings: " + scene.error().message};
  }
  return scene;
}

}  // namespace lodemark
