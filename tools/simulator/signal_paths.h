// How a satellite's signal comes to the phone between buildings: straight, off a wall, both, or not
// at all.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/sightline/building_scene.h"
#include "core/sightline/sight_chance.h"
#include "tools/renderer/scene.h"

namespace lodemark {

// Amplitudes are of the open sky's signal: 0 none, 1 all.
struct SignalPaths {
  double direct = 1.0;
  double reflected = 0.0;
  double extra_path_m = 0.0;    // of the reflection, against the straight way
  double extra_rate_mps = 0.0;  // how fast that grows, as the phone moves
};

// What a receiver makes of them. Where the reflection is at least twice as strong as the direct
// signal, it is what is tracked: late by its whole extra path. Else both are tracked as one, and
// the code errs by the envelope of a correlator whose early and late are a fifth of a chip apart
// (Braasch 1996, "Multipath Effects", in Global Positioning System: Theory and Applications I).
struct ReceivedPaths {
  double gain_db = 0.0;
  double code_error_m = 0.0;
  double rate_error_mps = 0.0;
  double phase_error_m = 0.0;
  bool is_reflection = false;
};

ReceivedPaths Receive(const SignalPaths& paths, double wavelength_m, double chip_m);

// The buildings of a scene, asked for paths to satellites. A direct path has the amplitude of the
// clear share of its first Fresnel zone: 6 dB less where it grazes an edge (ITU-R P.526-15, 4.1),
// and 30 dB where it is covered. A wall returns what its facade does: glass most, foliage next to
// nothing.
class SignalSurroundings {
 public:
  // Open sky.
  SignalSurroundings() = default;

  // kBadData, in words that follow the building's number, if a footprint has no convex parts.
  static Result<SignalSurroundings> Make(const std::vector<Building>& buildings);

  bool empty() const { return scene_.part_count() == 0; }
  bool IsIndoors(const Eigen::Vector3d& place_in_enu) const {
    return scene_.IsInside(place_in_enu);
  }

  // direction: to the satellite, of unit length, east-north-up.
  SignalPaths To(const Eigen::Vector3d& place_in_enu, const Eigen::Vector3d& velocity_in_enu,
                 const Eigen::Vector3d& direction, double wavelength_m) const;

 private:
  BuildingScene scene_;
  std::vector<double> wall_gain_;  // amplitude off a wall, for each part
};

}  // namespace lodemark
