// What a photograph showed of the map, kept for the adjustments it takes part in.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/camera/lens.h"
#include "core/fusion/bearing_group.h"
#include "core/geo/geodetic.h"
#include "core/map/feature_map.h"
#include "core/resection/resection.h"
#include "core/session/map_frame.h"
#include "core/session/session.h"
#include "core/vision/look_up.h"

namespace lodemark {

class SightLines;

struct PhotoSighting {
  PhotoSighting(const Lens& its_lens, const EnuFrame& map_frame)
      : lens(its_lens), frame(map_frame) {}

  std::int64_t time_ns = 0;
  Lens lens;
  AttitudePriors attitude;
  EnuFrame frame;                      // of the map, where satellites put it
  double frame_sigma_m = 0.0;          // of that, an axis; common to all landmarks
  ResectedPose pose;                   // its sights are the matches
  std::vector<LandmarkMatch> matches;  // of the last look

  bool HasPose() const {
    return pose.verdict == PoseVerdict::kPose || pose.verdict == PoseVerdict::kWeak;
  }
  // Too few landmarks for a pose that is more than chance, but how the camera was held is known.
  // Where more agree no better than chance, the photograph is of another place.
  static constexpr std::size_t kMostLines = 8;
  bool HasLines() const {
    return !HasPose() && !matches.empty() && matches.size() <= kMostLines && attitude.gravity &&
           attitude.heading;
  }
};

// What is believed of the position before the look-up.
struct PlacePrior {
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
};

// Looks the photograph up, where it can be by the prior, and resects it. The prior narrows what is
// asked of the map and nothing else: what comes out does not repeat it. A photograph of elsewhere
// is no error. image: that of the frame. What walls hide from the prior is not looked up at first;
// sights: standing there, or saying nothing.
Result<PhotoSighting> Sight(const FeatureMap& map, const MapFrame& map_frame,
                            const CameraFrame& frame, const std::optional<PlacePrior>& prior,
                            const SightLines& sights);

}  // namespace lodemark
