#include "core/session/sight_lines.h"

#include <utility>

#include "core/sightline/ground.h"

namespace lodemark {
namespace {

// How far in front of a landmark walls stop to count.
constexpr double kLandmarkMargin_m = 5.0;

// Of the 128 paths to a hidden landmark at most one gets through.
constexpr double kHidden = 1.5 / static_cast<double>(UncertainViewpoint::kPoints);

constexpr double kLightWavelength_m = 0.0;

// Whoever is outside of all buildings with less than this is not where the map has it.
constexpr double kLeastOutdoors = 0.1;

}  // namespace

void SightLines::Use(BuildingScene scene) {
  scene_ = std::move(scene);
  stands_ = false;
}

void SightLines::Stand(const EnuFrame& map_frame, const std::optional<PlacePrior>& place) {
  answers_.clear();
  stands_ = place.has_value() && has_buildings();
  if (!stands_) return;
  place_in_enu_m_ = NotBelowGround(scene_, map_frame.FromEcef(place->position_in_ecef));
  map_from_local_ = map_frame.enu_from_ecef() *
                    EnuFromEcefRotation(GeodeticFromEcef(place->position_in_ecef)).transpose();
  viewpoint_.Stand(place_in_enu_m_,
                   map_from_local_ * place->covariance_enu_m2 * map_from_local_.transpose());
  stands_ = viewpoint_.outdoors() >= kLeastOutdoors;
}

std::optional<double> SightLines::ProbabilityOfSight(SatelliteId satellite, const LookAngles& look,
                                                     double wavelength_m) {
  if (!stands_) return std::nullopt;
  // The signals of a satellite differ in their wavelengths by less than matters.
  for (const Answer& answer : answers_) {
    if (answer.satellite == satellite) return answer.probability;
  }
  const Eigen::Vector3d direction =
      map_from_local_ * DirectionFromAngles(look.azimuth_rad, look.elevation_rad);
  answers_.push_back({satellite, viewpoint_.Towards(direction, wavelength_m).probability});
  return answers_.back().probability;
}

bool SightLines::MayBeSeen(const Eigen::Vector3d& point_in_enu_m) const {
  if (!stands_) return true;
  // Most are seen from the middle of where the receiver can be, which is quickly found.
  SightPath path = SightPath::To(place_in_enu_m_, point_in_enu_m);
  path.length_m -= kLandmarkMargin_m;
  if (path.length_m <= 0.0 || scene_.IsFree(path)) return true;
  return viewpoint_.To(point_in_enu_m, kLightWavelength_m, kLandmarkMargin_m).probability > kHidden;
}

}  // namespace lodemark
