// How likely satellites and landmarks are in plain sight among the buildings of a map, from where
// the receiver was believed to be before it measured them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/geo/geodetic.h"
#include "core/session/photo_sighting.h"
#include "core/session/sight_source.h"
#include "core/sightline/building_scene.h"
#include "core/sightline/sight_chance.h"

namespace lodemark {

// Allocates only while the number of satellites grows.
class SightLines : public SightSource {
 public:
  SightLines() : viewpoint_(&scene_) {}
  SightLines(const SightLines&) = delete;
  SightLines& operator=(const SightLines&) = delete;

  // Takes the place of all buildings so far; an empty scene: none.
  void Use(BuildingScene scene);
  bool has_buildings() const { return scene_.part_count() > 0; }

  // Looks from there until told otherwise; without a place, or buildings, there is nothing to say.
  void Stand(const EnuFrame& map_frame, const std::optional<PlacePrior>& place);

  std::optional<double> ProbabilityOfSight(SatelliteId satellite, const LookAngles& look,
                                           double wavelength_m) override;

  // False where walls hide the point from all of where the receiver can be. A landmark lies on a
  // wall, and neither is where it is to the centimetre: what is behind less than 5 m counts as in
  // sight.
  bool MayBeSeen(const Eigen::Vector3d& point_in_enu_m) const;

 private:
  struct Answer {
    SatelliteId satellite;
    double probability = 1.0;
  };

  BuildingScene scene_;
  UncertainViewpoint viewpoint_;
  bool stands_ = false;
  Eigen::Vector3d place_in_enu_m_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d map_from_local_ = Eigen::Matrix3d::Identity();
  std::vector<Answer> answers_;  // from this place
};

}  // namespace lodemark
