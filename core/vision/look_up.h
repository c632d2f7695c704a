// Looks the features of a photograph up in a map.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/map/feature_map.h"
#include "core/vision/features.h"

namespace lodemark {

// What is known of the camera before the photograph is looked at, in the map's frame.
struct ViewPrior {
  Eigen::Vector3d position_in_enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d position_covariance_m2 = Eigen::Matrix3d::Zero();
  // Where the optical axis points, clockwise from north; one needs the other.
  std::optional<double> heading_rad;
  double heading_sigma_rad = 0.0;
  double farthest_m = 1000.0;  // landmarks beyond are not asked
};

struct LookUpOptions {
  double largest_ratio = 0.8;  // nearest to second nearest landmark, as Lowe (2004) section 7.1
  SearchOptions search;
  // With a prior or around a pose, others are hidden, by walls for example; empty: none are.
  std::function<bool(const Landmark& landmark)> may_be_seen;
};

// A feature of the photograph that is taken for a landmark.
struct LandmarkMatch {
  std::uint32_t feature = 0;  // index into Features
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double pixel_sigma_px = 1.0;  // as its size suggests, and how much it looks like the landmark
  Landmark landmark;
  double ratio = 1.0;  // of the distances, nearest to second nearest: smaller is surer
};

// Best first; no feature and no landmark twice. Error if the features are not of the map's kind or
// the map is damaged. Without a prior the whole map is asked, with one only what can be in view.
Result<std::vector<LandmarkMatch>> LookUp(const FeatureMap& map, const Features& features,
                                          const Lens& lens, const std::optional<ViewPrior>& prior,
                                          const LookUpOptions& options);

// Once the pose is nearly known: looks for each landmark only where it must appear, within
// radius_px, and therefore finds more, and none from elsewhere. Same rules otherwise.
Result<std::vector<LandmarkMatch>> LookUpGuided(const FeatureMap& map, const Features& features,
                                                const Lens& lens, const Rigid3& camera_from_enu,
                                                double radius_px, const LookUpOptions& options);

}  // namespace lodemark
