#include "core/session/photo_position.h"

#include <utility>

namespace lodemark {
namespace {

bool IsUsable(PoseVerdict verdict) {
  return verdict == PoseVerdict::kPose || verdict == PoseVerdict::kWeak;
}

Result<Features> Detect(const FeatureMap& map, const GrayImage& image,
                        const PhotoOptions& options) {
  DetectorOptions detector = options.detector;
  detector.kind = map.info().descriptor_kind;
  return DetectFeatures(image, detector);
}

// The pose that some matches give, in place of the one in position.
Status Resect(std::vector<LandmarkMatch> matches, const Lens& lens, const PhotoPrior& prior,
              const PhotoOptions& options, PhotoPosition* position) {
  Result<ResectedPose> pose = Resect(SightsFrom(matches), lens, prior.resection, options.resection);
  if (!pose) return pose.error();
  position->pose = std::move(*pose);
  position->matches = std::move(matches);
  return {};
}

}  // namespace

std::vector<LandmarkSight> SightsFrom(const std::vector<LandmarkMatch>& matches) {
  std::vector<LandmarkSight> sights;
  sights.reserve(matches.size());
  for (const LandmarkMatch& match : matches) {
    LandmarkSight sight;
    sight.pixel = match.pixel;
    sight.pixel_sigma_px = match.pixel_sigma_px;
    sight.landmark_in_enu_m = match.landmark.position_in_enu_m;
    sight.landmark_covariance_m2 = match.landmark.covariance_m2;
    sight.quality = 1.0 - match.ratio;
    sights.push_back(sight);
  }
  return sights;
}

Result<std::vector<LandmarkMatch>> LookAtMap(const FeatureMap& map, const GrayImage& image,
                                             const Lens& lens, const PhotoPrior& prior,
                                             const PhotoOptions& options) {
  Result<Features> features = Detect(map, image, options);
  if (!features) return features.error();
  if (prior.expected) {
    return LookUpGuided(map, *features, lens, prior.expected->camera_from_enu,
                        prior.expected->radius_px, options.look_up);
  }
  return LookUp(map, *features, lens, prior.view, options.look_up);
}

Result<PhotoPosition> LocatePhoto(const FeatureMap& map, const GrayImage& image, const Lens& lens,
                                  const PhotoPrior& prior, const PhotoOptions& options) {
  Result<Features> features = Detect(map, image, options);
  if (!features) return features.error();
  PhotoPosition position;
  position.features = features->keypoints.size();

  const auto look = [&](const std::optional<ExpectedPose>& around) -> Status {
    Result<std::vector<LandmarkMatch>> matches =
        around ? LookUpGuided(map, *features, lens, around->camera_from_enu, around->radius_px,
                              options.look_up)
               : LookUp(map, *features, lens, prior.view, options.look_up);
    if (!matches) return matches.error();
    return Resect(std::move(*matches), lens, prior, options, &position);
  };

  if (prior.expected) {
    if (const Status status = look(prior.expected); !status) return status.error();
  }
  if (!IsUsable(position.pose.verdict)) {
    if (const Status status = look(std::nullopt); !status) return status.error();
  }
  if (!IsUsable(position.pose.verdict)) return position;

  const PhotoPosition first = position;
  const ExpectedPose around = {first.pose.camera_from_enu, options.second_look_radius_px};
  if (const Status status = look(around); !status) return status.error();
  const bool better =
      IsUsable(position.pose.verdict) && position.pose.inliers >= first.pose.inliers;
  return better ? position : first;
}

}  // namespace lodemark
