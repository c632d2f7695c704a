#include "core/sightline/building_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geo/polygon.h"

namespace lodemark {
namespace {

constexpr double kGraze_m = 1e-6;
constexpr double kFoundation_m = 1000.0;  // below the base of what stands on the ground
constexpr std::size_t kLeafParts = 3;
// A component of a direction below this is taken as this: its inverse times any length is finite.
constexpr double kLeastComponent = 1e-200;
constexpr double kLongest_m = 1e30;

const char* WrongWith(const BuildingPrism& part) {
  if (!std::isfinite(part.base_m) || !std::isfinite(part.top_m)) return "a height is not finite";
  if (!(part.top_m > part.base_m)) return "the roof is not above the base";
  if (!(part.top_sigma_m >= 0.0) || !std::isfinite(part.top_sigma_m)) {
    return "the sigma of the roof is negative or not finite";
  }
  for (const Eigen::Vector2d& corner : part.footprint) {
    if (!corner.allFinite()) return "a corner is not finite";
  }
  if (!IsConvexCounterclockwise(part.footprint)) {
    return "the footprint is not convex and counterclockwise";
  }
  return nullptr;
}

}  // namespace

SightPath SightPath::To(const Eigen::Vector3d& from_in_enu_m, const Eigen::Vector3d& to_in_enu_m) {
  const Eigen::Vector3d way_m = to_in_enu_m - from_in_enu_m;
  const double length_m = way_m.norm();
  if (!(length_m > 0.0)) return {from_in_enu_m, Eigen::Vector3d::UnitZ(), 0.0};
  return {from_in_enu_m, way_m / length_m, length_m};
}

SightPath SightPath::Towards(const Eigen::Vector3d& from_in_enu_m,
                             const Eigen::Vector3d& direction) {
  return {from_in_enu_m, direction.normalized(), std::numeric_limits<double>::infinity()};
}

Eigen::Vector3d DirectionFromAngles(double azimuth_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  return {level * std::sin(azimuth_rad), level * std::cos(azimuth_rad), std::sin(elevation_rad)};
}

BuildingScene::BoxRay::BoxRay(const SightPath& path)
    : from(path.from_in_enu_m), length_m(std::min(path.length_m, kLongest_m)) {
  for (int axis = 0; axis < 3; ++axis) {
    const double component = path.direction[axis];
    inverse[axis] = 1.0 / (std::abs(component) < kLeastComponent ? kLeastComponent : component);
  }
}

bool BuildingScene::BoxRay::Meets(const Box& box, const Reach& reach, Chord* stretch) const {
  double enter_m = 0.0;
  double exit_m = length_m;
  for (int axis = 0; axis < 3; ++axis) {
    const double raise_m = axis == 2 ? reach.sigmas * box.largest_top_sigma_m : 0.0;
    const double one_m = (box.least[axis] - reach.distance_m - from[axis]) * inverse[axis];
    const double other_m =
        (box.greatest[axis] + raise_m + reach.distance_m - from[axis]) * inverse[axis];
    enter_m = std::max(enter_m, std::min(one_m, other_m));
    exit_m = std::min(exit_m, std::max(one_m, other_m));
  }
  stretch->enter_m = enter_m;
  stretch->exit_m = exit_m;
  return enter_m <= exit_m;
}

Result<BuildingScene> BuildingScene::Make(std::span<const BuildingPrism> parts) {
  if (parts.size() > std::numeric_limits<std::uint32_t>::max() / 4) {
    return Error{ErrorCode::kInvalidArgument, "too many parts of buildings"};
  }
  BuildingScene scene;
  scene.parts_.reserve(parts.size());
  for (const BuildingPrism& prism : parts) {
    if (const char* wrong = WrongWith(prism)) {
      return Error{ErrorCode::kInvalidArgument,
                   "building part " + std::to_string(scene.parts_.size()) + ": " + wrong};
    }
    Part part;
    part.base_m = prism.base_m;
    part.bottom_m = prism.raised ? prism.base_m : prism.base_m - kFoundation_m;
    part.top_m = prism.top_m;
    part.top_sigma_m = prism.top_sigma_m;
    part.building = prism.building;
    part.first_wall = static_cast<std::uint32_t>(scene.walls_.size());
    part.wall_count = static_cast<std::uint32_t>(prism.footprint.size());
    for (std::size_t i = 0; i < prism.footprint.size(); ++i) {
      const Eigen::Vector2d& corner = prism.footprint[i];
      const Eigen::Vector2d edge = prism.footprint[(i + 1) % prism.footprint.size()] - corner;
      // Going counterclockwise, the outside is to the right.
      const Eigen::Vector2d normal = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
      scene.walls_.push_back({normal.x(), normal.y(), normal.dot(corner)});
      scene.corners_.push_back(corner);
    }
    scene.parts_.push_back(part);
  }
  std::vector<Box> boxes;
  boxes.reserve(scene.parts_.size());
  scene.leaves_.reserve(scene.parts_.size());
  for (std::size_t i = 0; i < scene.parts_.size(); ++i) {
    boxes.push_back(scene.BoxOf(i));
    scene.leaves_.push_back(static_cast<std::uint32_t>(i));
  }
  if (!boxes.empty()) scene.Grow(scene.leaves_, boxes, 0);
  return scene;
}

std::span<const Eigen::Vector2d> BuildingScene::footprint(std::size_t part) const {
  return {corners_.data() + parts_[part].first_wall, parts_[part].wall_count};
}

BuildingScene::Box BuildingScene::BoxOf(std::size_t part) const {
  Box box;
  for (const Eigen::Vector2d& corner : footprint(part)) {
    box.least.head<2>() = box.least.head<2>().cwiseMin(corner);
    box.greatest.head<2>() = box.greatest.head<2>().cwiseMax(corner);
  }
  box.least.z() = parts_[part].bottom_m;
  box.greatest.z() = parts_[part].top_m;
  box.largest_top_sigma_m = parts_[part].top_sigma_m;
  return box;
}

// Halves the parts by their middles along the longer side, until few are left. As deep as the
// logarithm of their number.
void BuildingScene::Grow(std::span<std::uint32_t> parts, std::span<const Box> boxes,
                         std::uint32_t first) {
  Node node;
  Box middles;
  for (const std::uint32_t part : parts) {
    const Box& box = boxes[part];
    node.box.least = node.box.least.cwiseMin(box.least);
    node.box.greatest = node.box.greatest.cwiseMax(box.greatest);
    node.box.largest_top_sigma_m = std::max(node.box.largest_top_sigma_m, box.largest_top_sigma_m);
    const Eigen::Vector3d middle = 0.5 * (box.least + box.greatest);
    middles.least = middles.least.cwiseMin(middle);
    middles.greatest = middles.greatest.cwiseMax(middle);
  }
  node.first = first;
  node.count = parts.size() <= kLeafParts ? static_cast<std::uint32_t>(parts.size()) : 0;
  const std::size_t at = nodes_.size();
  nodes_.push_back(node);
  if (node.count == 0) {
    int axis = 0;
    (middles.greatest - middles.least).maxCoeff(&axis);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const double middle_a = boxes[a].least[axis] + boxes[a].greatest[axis];
      const double middle_b = boxes[b].least[axis] + boxes[b].greatest[axis];
      return middle_a != middle_b ? middle_a < middle_b : a < b;
    };
    const std::size_t half = parts.size() / 2;
    std::nth_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(half), parts.end(),
                     before);
    Grow(parts.first(half), boxes, first);
    Grow(parts.subspan(half), boxes, first + static_cast<std::uint32_t>(half));
  }
  nodes_[at].after = static_cast<std::uint32_t>(nodes_.size());
}

Chord BuildingScene::ClipLine(std::size_t part, const Eigen::Vector3d& from_in_enu_m,
                              const Eigen::Vector3d& direction, double raise_m) const {
  const Part& prism = parts_[part];
  Chord chord;
  // Inside is where distance + t * speed <= 0.
  const auto clip = [&chord](double distance_m, double speed) {
    if (speed > 0.0) {
      chord.exit_m = std::min(chord.exit_m, -distance_m / speed);
    } else if (speed < 0.0) {
      chord.enter_m = std::max(chord.enter_m, -distance_m / speed);
    } else if (distance_m > 0.0) {
      chord.enter_m = std::numeric_limits<double>::infinity();
    }
  };
  const double east_m = from_in_enu_m.x();
  const double north_m = from_in_enu_m.y();
  clip(from_in_enu_m.z() - prism.top_m - raise_m, direction.z());
  clip(prism.bottom_m - from_in_enu_m.z(), -direction.z());
  const Wall* const walls = walls_.data() + prism.first_wall;
  for (std::uint32_t i = 0; i < prism.wall_count; ++i) {
    const Wall& wall = walls[i];
    clip(wall.normal_east * east_m + wall.normal_north * north_m - wall.offset_m,
         wall.normal_east * direction.x() + wall.normal_north * direction.y());
  }
  return chord;
}

bool BuildingScene::IsFree(const SightPath& path, std::size_t without_part) const {
  bool is_free = true;
  Walk(path, {}, [&](std::size_t part) {
    if (part == without_part) return true;
    const Chord chord = ClipLine(part, path.from_in_enu_m, path.direction);
    is_free = std::min(chord.exit_m, path.length_m) - std::max(chord.enter_m, 0.0) <= kGraze_m;
    return is_free;
  });
  return is_free;
}

std::optional<Blocker> BuildingScene::FirstBlocker(const SightPath& path) const {
  std::optional<Blocker> first;
  Walk(path, {}, [&](std::size_t part) {
    const Chord chord = ClipLine(part, path.from_in_enu_m, path.direction);
    const double enter_m = std::max(chord.enter_m, 0.0);
    if (std::min(chord.exit_m, path.length_m) - enter_m <= kGraze_m) return true;
    // Of parts that begin at the same distance the first by number, whatever the tree's order.
    if (!first || enter_m < first->distance_m ||
        (enter_m == first->distance_m && part < first->part)) {
      first = Blocker{part, enter_m};
    }
    return true;
  });
  return first;
}

bool BuildingScene::IsInside(const Eigen::Vector3d& point_in_enu_m) const {
  bool is_inside = false;
  Walk({point_in_enu_m, Eigen::Vector3d::UnitZ(), 0.0}, {}, [&](std::size_t part) {
    const Chord chord = ClipLine(part, point_in_enu_m, Eigen::Vector3d::UnitZ());
    is_inside = chord.enter_m <= 0.0 && chord.exit_m >= 0.0;
    return !is_inside;
  });
  return is_inside;
}

double BuildingScene::FarthestNear(const SightPath& path, const Reach& reach) const {
  if (nodes_.empty()) return 0.0;
  Chord stretch;
  return BoxRay(path).Meets(nodes_.front().box, reach, &stretch) ? stretch.exit_m : 0.0;
}

}  // namespace lodemark
