#include "core/session/photo_sighting.h"

#include <utility>

#include "core/session/photo_attitude.h"
#include "core/session/photo_position.h"
#include "core/session/sight_lines.h"

namespace lodemark {
namespace {

ViewPrior ViewFrom(const PlacePrior& place, const CameraFrame& frame, const EnuFrame& map_frame) {
  ViewPrior view;
  view.position_in_enu_m = map_frame.FromEcef(place.position_in_ecef);
  const Eigen::Matrix3d map_from_local =
      map_frame.enu_from_ecef() *
      EnuFromEcefRotation(GeodeticFromEcef(place.position_in_ecef)).transpose();
  view.position_covariance_m2 =
      map_from_local * place.covariance_enu_m2 * map_from_local.transpose();
  view.heading_rad = frame.heading_rad;
  view.heading_sigma_rad = frame.heading_sigma_rad;
  return view;
}

}  // namespace

Result<PhotoSighting> Sight(const FeatureMap& map, const MapFrame& map_frame,
                            const CameraFrame& frame, const std::optional<PlacePrior>& prior,
                            const SightLines& sights) {
  PhotoSighting sighting(frame.lens, map_frame.frame);
  sighting.frame_sigma_m = map_frame.sigma_m;
  sighting.time_ns = frame.time_ns;
  if (frame.gravity) {
    sighting.attitude.gravity =
        AttitudePriors::Gravity{frame.gravity->up_in_camera, frame.gravity->sigma_rad};
  }
  if (frame.heading_rad) {
    sighting.attitude.heading =
        AttitudePriors::Heading{*frame.heading_rad, frame.heading_sigma_rad};
  }

  PhotoPrior photo;
  photo.resection.gravity = frame.gravity;
  PhotoOptions options;
  if (prior) {
    photo.view = ViewFrom(*prior, frame, sighting.frame);
    if (sights.has_buildings()) {
      options.look_up.may_be_seen = [&sights](const Landmark& landmark) {
        return sights.MayBeSeen(landmark.position_in_enu_m);
      };
    }
  }
  Result<PhotoPosition> found = LocatePhoto(map, frame.image, frame.lens, photo, options);
  if (!found) return found.error();
  const auto has_pose = [](const PhotoPosition& position) {
    return position.pose.verdict == PoseVerdict::kPose ||
           position.pose.verdict == PoseVerdict::kWeak;
  };
  if (prior && !has_pose(*found)) {
    // The prior may be wrong: once more with the whole map.
    photo.view.reset();
    Result<PhotoPosition> again = LocatePhoto(map, frame.image, frame.lens, photo, {});
    if (!again) return again.error();
    if (has_pose(*again)) found = std::move(again);
  }
  DropContradictedHeading(found->pose, &sighting.attitude);
  sighting.pose = std::move(found->pose);
  sighting.matches = std::move(found->matches);
  return sighting;
}

}  // namespace lodemark
