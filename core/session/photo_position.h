// Where a photograph was taken: features, look-up, resection, and both once more around the pose.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/camera/gray_image.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/map/feature_map.h"
#include "core/resection/resection.h"
#include "core/resection/sights.h"
#include "core/vision/features.h"
#include "core/vision/look_up.h"

namespace lodemark {

// A pose to look around, in the map's frame.
struct ExpectedPose {
  Rigid3 camera_from_enu;
  double radius_px = 20.0;  // around where each landmark must then appear
};

// What is known before the photograph is looked at; all of it optional.
struct PhotoPrior {
  std::optional<ViewPrior> view;         // narrows what is looked up
  std::optional<ExpectedPose> expected;  // narrows it further
  ResectionPriors resection;             // steers sampling and adjustment
};

struct PhotoOptions {
  DetectorOptions detector;
  LookUpOptions look_up;
  ResectionOptions resection;
  double second_look_radius_px = 12.0;  // around where the first pose shows each landmark
};

struct PhotoPosition {
  ResectedPose pose;                   // its sights are the matches
  std::vector<LandmarkMatch> matches;  // of the last look
  std::size_t features = 0;            // found in the photograph
};

// Sights for Resect, in the order of the matches.
std::vector<LandmarkSight> SightsFrom(const std::vector<LandmarkMatch>& matches);

// One look: where there is an expected pose around it, else as the view prior says.
Result<std::vector<LandmarkMatch>> LookAtMap(const FeatureMap& map, const GrayImage& image,
                                             const Lens& lens, const PhotoPrior& prior,
                                             const PhotoOptions& options);

// Looks, resects, looks again around the pose found and resects again. An expected pose that leads
// nowhere is forgotten. Error if the image, the map or the kind of its descriptors is at fault; a
// photograph of elsewhere is none, but a verdict.
Result<PhotoPosition> LocatePhoto(const FeatureMap& map, const GrayImage& image, const Lens& lens,
                                  const PhotoPrior& prior, const PhotoOptions& options);

}  // namespace lodemark
