// Buildings around a receiver, and whether the straight path to a point or a satellite is free of
// them.
//
// Everything is in one east-north-up frame, in metres. The exact clip of a line against convex
// parts follows Cyrus and Beck (1978), "Generalized two- and three-dimensional clipping"; a tree of
// boxes over the parts finds those that are worth it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace lodemark {

// A convex part of a building: walls straight up over its footprint, from the base to a flat roof.
struct BuildingPrism {
  std::uint32_t building = 0;              // parts with the same number are one building
  std::vector<Eigen::Vector2d> footprint;  // east, north; convex, counterclockwise
  double base_m = 0.0;                     // up
  double top_m = 0.0;
  double top_sigma_m = 0.0;  // 1 sigma of the roof's height
  // Open beneath, as a passage or a bridge is. Else it stands on the ground, and what would pass
  // below its base is blocked too: the ground's height is never known so well.
  bool raised = false;
};

// From a place straight to a point, or towards something at infinity. The direction has unit
// length.
struct SightPath {
  Eigen::Vector3d from_in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double length_m = std::numeric_limits<double>::infinity();

  // Of two places that coincide the path has no length.
  static SightPath To(const Eigen::Vector3d& from_in_enu_m, const Eigen::Vector3d& to_in_enu_m);
  static SightPath Towards(const Eigen::Vector3d& from_in_enu_m, const Eigen::Vector3d& direction);

  Eigen::Vector3d At(double distance_m) const { return from_in_enu_m + distance_m * direction; }
};

// The unit vector to what is seen at an azimuth (clockwise from north) and elevation.
Eigen::Vector3d DirectionFromAngles(double azimuth_rad, double elevation_rad);

// Which part stands in the way, and how far along the path it begins. 0: the path starts in it.
struct Blocker {
  std::size_t part = 0;
  double distance_m = 0.0;
};

// Along a line, from where it enters a convex part to where it leaves; enter >= exit if it misses.
struct Chord {
  double enter_m = -std::numeric_limits<double>::infinity();
  double exit_m = std::numeric_limits<double>::infinity();
};

class BuildingScene {
 public:
  BuildingScene() = default;

  // kInvalidArgument, naming the part by its place in the list, if a footprint is not convex and
  // counterclockwise, a number is not finite, or a roof is not above its base.
  static Result<BuildingScene> Make(std::span<const BuildingPrism> parts);

  std::size_t part_count() const { return parts_.size(); }

  // Of part 0 .. part_count() - 1, in the order they were given.
  std::uint32_t building(std::size_t part) const { return parts_[part].building; }
  std::span<const Eigen::Vector2d> footprint(std::size_t part) const;
  double base_m(std::size_t part) const { return parts_[part].base_m; }
  double top_m(std::size_t part) const { return parts_[part].top_m; }
  double top_sigma_m(std::size_t part) const { return parts_[part].top_sigma_m; }

  // Where it blocks from: its base if it is raised, else far below.
  double bottom_m(std::size_t part) const { return parts_[part].bottom_m; }

  // Roofs and walls count as they are given, without their sigmas. A path that only touches, or
  // runs through less than a micrometre, is free; one that runs along a wall is not. Ignores the
  // part without_part, if there is one of that number. Allocates nothing.
  static constexpr std::size_t kNoPart = std::numeric_limits<std::size_t>::max();
  bool IsFree(const SightPath& path, std::size_t without_part = kNoPart) const;
  // The first part in the way.
  std::optional<Blocker> FirstBlocker(const SightPath& path) const;
  // Whether some part holds the point, walls and roof included.
  bool IsInside(const Eigen::Vector3d& point_in_enu_m) const;

  // The line of the path against one part whose roof is higher by raise_m than given.
  Chord ClipLine(std::size_t part, const Eigen::Vector3d& from_in_enu_m,
                 const Eigen::Vector3d& direction, double raise_m = 0.0) const;

  // Calls visit(part) for all parts whose boxes the path comes as near to as a distance; possibly
  // for others. Roofs are raised by sigmas times their sigma first. Stops when visit gives false.
  struct Reach {
    double distance_m = 0.0;
    double sigmas = 0.0;
  };
  template <typename Visit>
  void VisitNear(const SightPath& path, const Reach& reach, Visit visit) const;

  // How far along the path, within that reach, any building can be; 0 if none is near.
  double FarthestNear(const SightPath& path, const Reach& reach) const;

 private:
  struct Box {
    Eigen::Vector3d least = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector3d greatest = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
    double largest_top_sigma_m = 0.0;
  };
  // Outside of the wall is normal_east * east + normal_north * north > offset_m.
  struct Wall {
    double normal_east = 0.0;
    double normal_north = 0.0;
    double offset_m = 0.0;
  };
  struct Part {
    double base_m = 0.0;
    double bottom_m = 0.0;
    double top_m = 0.0;
    double top_sigma_m = 0.0;
    std::uint32_t first_wall = 0;
    std::uint32_t wall_count = 0;
    std::uint32_t building = 0;
  };
  // Depth first: the next node is the first child, the one after all below it is at after.
  struct Node {
    Box box;
    std::uint32_t after = 0;
    std::uint32_t first = 0;  // of its entries in leaves_
    std::uint32_t count = 0;  // 0: not a leaf
  };
  // A path ready for many boxes.
  struct BoxRay {
    explicit BoxRay(const SightPath& path);
    // The stretch within a box that is larger by a distance to all sides, from least_m on.
    bool Meets(const Box& box, const Reach& reach, Chord* stretch) const;
    Eigen::Vector3d from;
    Eigen::Vector3d inverse;
    double length_m;
  };

  Box BoxOf(std::size_t part) const;
  void Grow(std::span<std::uint32_t> parts, std::span<const Box> boxes, std::uint32_t first);
  template <typename Visit>
  void Walk(const SightPath& path, const Reach& reach, Visit visit) const;

  std::vector<Part> parts_;
  std::vector<Wall> walls_;
  std::vector<Eigen::Vector2d> corners_;  // wall i goes from corner i to the next of its part
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaves_;  // parts in the order of the tree
};

// Visits the leaves whose boxes the path meets.
template <typename Visit>
void BuildingScene::Walk(const SightPath& path, const Reach& reach, Visit visit) const {
  const BoxRay ray(path);
  std::size_t at = 0;
  while (at < nodes_.size()) {
    const Node& node = nodes_[at];
    Chord stretch;
    if (!ray.Meets(node.box, reach, &stretch)) {
      at = node.after;
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (!visit(static_cast<std::size_t>(leaves_[node.first + i]))) return;
    }
    ++at;
  }
}

template <typename Visit>
void BuildingScene::VisitNear(const SightPath& path, const Reach& reach, Visit visit) const {
  Walk(path, reach, visit);
}

}  // namespace lodemark
