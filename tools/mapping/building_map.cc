#include "tools/mapping/building_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/geo/polygon.h"
#include "tools/mapping/whole_file.h"

namespace lodemark {
namespace {

constexpr double kFarthest_m = 99'000.0;
// Parts that cover this share of an outline describe the building better than the outline.
constexpr double kCoveredShare = 0.6;

// A footprint in the map's frame.
struct Placed {
  const Footprint* footprint = nullptr;
  std::vector<Outline> outlines;
  double ground_up_m = 0.0;  // the plane of east and north leaves the ellipsoid with distance
  Eigen::Vector2d least = Eigen::Vector2d::Zero();
  Eigen::Vector2d greatest = Eigen::Vector2d::Zero();
  double area_m2 = 0.0;
};

Result<Footprints> ReadFootprints(const BuildingInput& input) {
  const Result<std::string> text = ReadWholeFile(input.footprints, kLargestFootprintFile_bytes);
  if (!text) return text.error();
  return ParseFootprints(input.footprints, *text, input.heights);
}

Geodetic OnGround(const Eigen::Vector2d& place_deg, double ground_m) {
  return {place_deg.y() * kRadiansPerDegree, place_deg.x() * kRadiansPerDegree, ground_m};
}

Result<Placed> Place(const Footprint& footprint, const std::string& file, const EnuFrame& frame,
                     double ground_m) {
  Placed placed;
  placed.footprint = &footprint;
  double up_m = 0.0;
  double corners = 0.0;
  bool far = false;
  const auto place = [&](const Ring& ring_deg) {
    Ring ring;
    ring.reserve(ring_deg.size());
    for (const Eigen::Vector2d& corner_deg : ring_deg) {
      const Eigen::Vector3d point =
          frame.FromEcef(EcefFromGeodetic(OnGround(corner_deg, ground_m)));
      far = far || !(point.norm() < kFarthest_m);
      up_m += point.z();
      corners += 1.0;
      ring.emplace_back(point.x(), point.y());
    }
    return ring;
  };
  for (const Outline& outline_deg : footprint.outlines_deg) {
    Outline outline;
    outline.outer = place(outline_deg.outer);
    for (const Ring& hole : outline_deg.holes) outline.holes.push_back(place(hole));
    placed.area_m2 += AreaOf(outline);
    placed.outlines.push_back(std::move(outline));
  }
  if (far) {
    return Error{ErrorCode::kBadData, file + ": feature " + std::to_string(footprint.feature) +
                                          " (" + footprint.building +
                                          "): lies 100 km or more from the map's origin"};
  }
  placed.ground_up_m = up_m / corners;
  placed.least = placed.greatest = placed.outlines.front().outer.front();
  for (const Outline& outline : placed.outlines) {
    for (const Eigen::Vector2d& corner : outline.outer) {
      placed.least = placed.least.cwiseMin(corner);
      placed.greatest = placed.greatest.cwiseMax(corner);
    }
  }
  return placed;
}

// Whether building:parts say more about the building of this outline.
bool IsCovered(const Placed& whole, const std::vector<const Placed*>& parts) {
  double covered_m2 = 0.0;
  for (const Placed* part : parts) {
    const Eigen::Vector2d middle = 0.5 * (part->least + part->greatest);
    if ((middle.array() < whole.least.array()).any() ||
        (middle.array() > whole.greatest.array()).any()) {
      continue;
    }
    for (const Outline& outline : whole.outlines) {
      if (!Contains(outline.outer, middle)) continue;
      // Where parts lie above each other they count twice; a tower on a base is no harm.
      covered_m2 += part->area_m2;
      break;
    }
  }
  return covered_m2 >= kCoveredShare * whole.area_m2;
}

Status AddPlaced(const Footprints& footprints, const std::string& file,
                 const std::vector<Placed>& placed, const StageProgress& progress,
                 BuiltMap* built) {
  std::vector<const Placed*> parts;
  for (const Placed& each : placed) {
    if (each.footprint->is_part) parts.push_back(&each);
  }
  std::vector<BuildingPart>& out = built->content.building_parts;
  std::size_t buildings = 0;
  std::size_t replaced = 0;
  std::size_t refused = 0;
  std::string first_refusal;
  std::size_t done = 0;
  for (const Placed& each : placed) {
    if (++done % 256 == 0) {
      progress("Buildings", static_cast<double>(done) / static_cast<double>(placed.size()));
    }
    const Footprint& footprint = *each.footprint;
    if (!footprint.is_part && !parts.empty() && IsCovered(each, parts)) {
      ++replaced;
      continue;
    }
    bool any = false;
    for (const Outline& outline : each.outlines) {
      Result<std::vector<Ring>> convex = ConvexParts(outline);
      if (!convex) {
        if (refused++ == 0) {
          first_refusal = file + ": feature " + std::to_string(footprint.feature) + " (" +
                          footprint.building + "): an outline passed over that " +
                          convex.error().message;
        }
        continue;
      }
      any = true;
      for (Ring& ring : *convex) {
        BuildingPart part;
        part.id = static_cast<std::uint32_t>(out.size() + 1);
        part.building = footprint.building;
        part.footprint_in_enu_m = std::move(ring);
        part.base_m = each.ground_up_m + footprint.base_m;
        part.top_m = each.ground_up_m + footprint.top_m;
        part.top_sigma_m = footprint.top_sigma_m;
        part.raised = footprint.base_m > 0.0;
        out.push_back(std::move(part));
      }
    }
    if (any) ++buildings;
  }
  progress("Buildings", 1.0);
  if (out.empty()) {
    return Error{ErrorCode::kBadData,
                 refused > 0 ? first_refusal : file + ": holds no footprint of a building"};
  }
  built->buildings = buildings;
  for (const std::string& note : footprints.notes) built->notes.push_back(note);
  if (replaced > 0) {
    built->notes.push_back(file + ": " + std::to_string(replaced) +
                           " outlines passed over whose building:parts are there");
  }
  if (refused > 0) {
    built->notes.push_back(first_refusal +
                           (refused > 1 ? ", and " + std::to_string(refused - 1) + " more" : ""));
  }
  if (footprints.without_height > 0) {
    built->notes.push_back(file + ": " + std::to_string(footprints.without_height) + " of " +
                           std::to_string(footprints.buildings.size()) +
                           " buildings have no height and got the default");
  }
  return {};
}

Status AddFootprints(const Footprints& footprints, const BuildingInput& input, double ground_m,
                     const StageProgress& progress, BuiltMap* built) {
  const EnuFrame frame(built->info.origin);
  std::vector<Placed> placed;
  placed.reserve(footprints.buildings.size());
  for (const Footprint& footprint : footprints.buildings) {
    Result<Placed> each = Place(footprint, input.footprints, frame, ground_m);
    if (!each) return each.error();
    placed.push_back(*std::move(each));
  }
  return AddPlaced(footprints, input.footprints, placed, progress, built);
}

}  // namespace

Status AddBuildings(const BuildingInput& input, const StageProgress& progress, BuiltMap* built) {
  if (built->info.datum == "local") {
    return Error{ErrorCode::kInvalidArgument,
                 "--local: buildings lie on the earth, so the map has to as well"};
  }
  const Result<Footprints> footprints = ReadFootprints(input);
  if (!footprints) return footprints.error();
  return AddFootprints(*footprints, input, input.ground_m.value_or(built->info.origin.height_m),
                       progress, built);
}

Result<BuiltMap> BuildBuildingMap(const BuildingInput& input, const FrameOptions& frame,
                                  const MapLabels& labels, const StageProgress& progress) {
  if (frame.local) {
    return Error{ErrorCode::kInvalidArgument,
                 "--local: buildings lie on the earth, so the map has to as well"};
  }
  if (!frame.origin && !input.ground_m) {
    return Error{ErrorCode::kInvalidArgument,
                 "say how high the ground lies above the ellipsoid: --ground HEIGHT, or --origin "
                 "LATITUDE,LONGITUDE,HEIGHT"};
  }
  const Result<Footprints> footprints = ReadFootprints(input);
  if (!footprints) return footprints.error();
  Geodetic origin;
  double ground_m = 0.0;
  if (frame.origin) {
    origin = *frame.origin;
    ground_m = input.ground_m.value_or(origin.height_m);
  } else {
    ground_m = *input.ground_m;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Footprint& footprint : footprints->buildings) {
      middle += EcefFromGeodetic(OnGround(footprint.outlines_deg.front().outer.front(), ground_m)) /
                static_cast<double>(footprints->buildings.size());
    }
    // A middle of places on a curved earth lies below them.
    origin = GeodeticFromEcef(middle);
    origin.height_m = ground_m;
  }
  BuiltMap built;
  built.info.origin = origin;
  built.info.datum = labels.datum;
  built.info.epoch_year = labels.epoch_year;
  const Status status = AddFootprints(*footprints, input, ground_m, progress, &built);
  if (!status) return status.error();
  return built;
}

}  // namespace lodemark
