// Photographs with surveyed poses and a feature map of what they show.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/lens.h"
#include "core/map/feature_map.h"
#include "core/resection/resection.h"
#include "core/vision/features.h"

namespace lodemark::test {

struct SurveyedPhoto {
  std::string path;
  bool is_query = false;  // the map knows nothing of it
  Eigen::Vector3d camera_in_enu_m = Eigen::Vector3d::Zero();
};

struct PhotoScene {
  std::vector<SurveyedPhoto> photos;
  Lens lens;
  std::unique_ptr<FeatureMap> map;
};

// From a folder with poses.csv, cameras_geodetic.csv, landmarks and their descriptors.
std::optional<PhotoScene> ReadPhotoScene(const std::string& folder);

// Of the photograph in a file; none and a failed test if it cannot be read. The lens that is made
// up for it has the usual field of view.
struct PhotoFeatures {
  Features features;
  int width_px = 0;
  int height_px = 0;
};
PhotoFeatures FeaturesOf(const std::string& path);
Lens UsualLens(int width_px, int height_px);

// What `lodemark map query` does: look up in the whole map, resect, look up around where landmarks
// must be, resect again.
struct Located {
  std::vector<LandmarkSight> first_sights;  // by descriptors alone
  ResectedPose first;
  ResectedPose pose;
};
Located Locate(const FeatureMap& map, const Lens& lens, const Features& features);

}  // namespace lodemark::test
