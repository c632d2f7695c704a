// How likely the path to a satellite or a landmark is free, when the receiver's place, the roofs
// and the width of the wave leave doubt.
//
// The probability is the expected share of the path's first Fresnel zone that no building covers:
//
//   P = E[ 1{the path from place + u, moved across by f * radius on its way, meets no part} ]
//
// u is Gaussian with the receiver's covariance; f is uniform over the unit disc, and the radius is
// the first Fresnel zone's (fresnel_zone.h) at each distance; each building's roofs are higher or
// lower by a common Gaussian times their sigmas. A path that grazes an edge has P = 1/2, where the
// field behind a knife edge is half the free one (ITU-R P.526-15, 4.1: 6 dB); elsewhere the clear
// share of the zone differs from that field's amplitude by less than 0.2. Given that the receiver
// stands outdoors, places inside buildings count as impossible.
//
// The expectation is taken over 128 fixed points: R. Roberts's sequence of 2018 ("The unreasonable
// effectiveness of quasirandom sequences") in six dimensions, its Gaussians by Box and Muller, in
// pairs mirrored at the middle and scaled to unit covariance. Parts are looked at only where the
// whole volume that the points can reach meets them, which libccd decides (sight_volume.h).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "core/sightline/building_scene.h"

namespace lodemark {

struct SightChance {
  double probability = 1.0;         // that the path is free: 0 .. 1, in steps of 1/128 or more
  std::optional<std::size_t> part;  // that blocks: the first on the mean path, else a likely one
};

// A receiver's uncertain place, asked about many directions. Allocates nothing; the work is bounded
// by the number of parts near the path. The scene must outlive the object.
class UncertainViewpoint {
 public:
  static constexpr std::size_t kPoints = 128;

  // Stands at the scene's origin, with certainty.
  explicit UncertainViewpoint(const BuildingScene* scene);

  // covariance_m2: east-north-up, finite; what is negative in it counts as zero.
  void Stand(const Eigen::Vector3d& place_in_enu_m, const Eigen::Matrix3d& covariance_m2);

  // Which share of the receiver's distribution is outside of all buildings. If none is, the
  // receiver is taken to be indoors: nothing is in sight through walls.
  double outdoors() const { return outdoors_; }

  // To a satellite: a direction of unit length.
  SightChance Towards(const Eigen::Vector3d& direction, double wavelength_m) const;
  // To a point, but for the last stretch of margin_m before it: a landmark lies on the very wall
  // that would block the path.
  SightChance To(const Eigen::Vector3d& point_in_enu_m, double wavelength_m, double margin_m) const;

 private:
  struct Point {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  // standard Gaussian
    double roof = 0.0;                                // standard Gaussian
    Eigen::Vector2d disc = Eigen::Vector2d::Zero();   // uniform in the unit disc
  };
  struct Target;
  struct Knot;
  struct Bundle;

  void MakePoints();
  SightChance Ask(const Target& target) const;
  bool Block(std::size_t part, const Target& target, Bundle* bundle) const;

  const BuildingScene* scene_;
  std::array<Point, kPoints> points_;
  std::array<Eigen::Vector3d, kPoints> starts_in_enu_m_;
  std::array<bool, kPoints> indoors_ = {};
  Eigen::Vector3d place_in_enu_m_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d reach_m_ = Eigen::Matrix3d::Zero();  // root of the covariance, for all points
  double farthest_point_ = 0.0;                        // in sigmas
  double highest_roof_ = 0.0;                          // in sigmas
  double outdoors_ = 1.0;
};

}  // namespace lodemark
