// LookUpGuided of look_up.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "core/vision/keypoint_grid.h"
#include "core/vision/look_up.h"
#include "core/vision/unique_matches.h"

namespace lodemark {
namespace {

// Beyond, a landmark is too small a thing to be told from its surroundings.
constexpr double kFarthest_m = 2000.0;

// Where a landmark must appear, and from where it is looked at.
struct Prediction {
  std::uint32_t id = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3f direction_to_camera = Eigen::Vector3f::Zero();
  float distance_m = 0.0F;
};

// Ascending by id.
Result<std::vector<Prediction>> Predict(const FeatureMap& map, const Lens& lens,
                                        const Rigid3& camera_from_enu, double radius_px,
                                        const LookUpOptions& options) {
  const Eigen::Vector3d camera_in_enu_m =
      camera_from_enu.rotation().conjugate() * -camera_from_enu.translation();
  Result<std::vector<Landmark>> landmarks = map.LandmarksWithin(camera_in_enu_m, kFarthest_m);
  if (!landmarks) return landmarks.error();
  const double right_px = lens.parameters().width_px - 0.5 + radius_px;
  const double bottom_px = lens.parameters().height_px - 0.5 + radius_px;
  std::vector<Prediction> predictions;
  for (const Landmark& landmark : *landmarks) {
    const std::optional<Eigen::Vector2d> pixel =
        lens.Project(camera_from_enu * landmark.position_in_enu_m);
    if (!pixel || pixel->x() < -0.5 - radius_px || pixel->y() < -0.5 - radius_px ||
        pixel->x() > right_px || pixel->y() > bottom_px) {
      continue;
    }
    const Eigen::Vector3d to_camera_m = camera_in_enu_m - landmark.position_in_enu_m;
    const double distance_m = to_camera_m.norm();
    if (!(distance_m > 0.0)) continue;
    if (options.may_be_seen && !options.may_be_seen(landmark)) continue;
    const Eigen::Vector3d direction = to_camera_m / distance_m;
    predictions.push_back(
        {landmark.id, *pixel, direction.cast<float>(), static_cast<float>(distance_m)});
  }
  std::sort(predictions.begin(), predictions.end(),
            [](const Prediction& a, const Prediction& b) { return a.id < b.id; });
  return predictions;
}

// Whether a descriptor noted from there can be what is seen from here.
bool CanLookAlike(const DescriptorOrigin& origin, const Prediction& prediction,
                  const SearchScope& limits, float least_cosine) {
  if (origin.direction_to_camera.squaredNorm() > 0.25F &&
      origin.direction_to_camera.dot(prediction.direction_to_camera) < least_cosine) {
    return false;
  }
  return !(origin.distance_m > 0.0F) ||
         (origin.distance_m <= limits.largest_zoom * prediction.distance_m &&
          prediction.distance_m <= limits.largest_zoom * origin.distance_m);
}

// Takes another landmark's distance into account; several descriptors of one count once.
void Consider(std::uint32_t id, std::uint32_t distance, NearestLandmarks* nearest) {
  if (id == nearest->landmark_id) {
    nearest->distance = std::min(nearest->distance, distance);
  } else if (distance < nearest->distance ||
             (distance == nearest->distance && id < nearest->landmark_id)) {
    nearest->second_landmark_id = nearest->landmark_id;
    nearest->second_distance = nearest->distance;
    nearest->landmark_id = id;
    nearest->distance = distance;
  } else if (distance < nearest->second_distance) {
    nearest->second_landmark_id = id;
    nearest->second_distance = distance;
  }
}

}  // namespace

Result<std::vector<LandmarkMatch>> LookUpGuided(const FeatureMap& map, const Features& features,
                                                const Lens& lens, const Rigid3& camera_from_enu,
                                                double radius_px, const LookUpOptions& options) {
  if (const Status status = CheckFeatures(map, features); !status) return status.error();
  if (!(radius_px > 0.0) || !std::isfinite(radius_px) ||
      !camera_from_enu.translation().allFinite() ||
      !camera_from_enu.rotation().coeffs().allFinite()) {
    return Error{
        ErrorCode::kInvalidArgument,
        "guided look-up: the radius or the pose is not finite, or the radius not positive"};
  }
  const Result<std::vector<Prediction>> predictions =
      Predict(map, lens, camera_from_enu, radius_px, options);
  if (!predictions) return predictions.error();
  if (predictions->empty() || features.keypoints.empty()) return std::vector<LandmarkMatch>{};

  const KeypointGrid grid(features.keypoints, radius_px);
  const SearchScope limits;
  const float least_cosine = std::cos(limits.widest_turn_rad);
  const std::size_t length = DescriptorBytes(features.kind);
  const bool is_orb = features.kind == DescriptorKind::kOrb;
  std::vector<NearestLandmarks> nearest(features.keypoints.size());

  const DescriptorSearch search(map.quantizer(), features.descriptors, options.search);
  const Status visited = map.VisitLists(search.lists(), [&](int, const DescriptorListView& view) {
    for (std::size_t i = 0; i < view.size(); ++i) {
      const std::uint32_t id = view.landmark_id(i);
      const auto prediction =
          std::lower_bound(predictions->begin(), predictions->end(), id,
                           [](const Prediction& p, std::uint32_t wanted) { return p.id < wanted; });
      if (prediction == predictions->end() || prediction->id != id) continue;
      if (!CanLookAlike(view.origin(i), *prediction, limits, least_cosine)) continue;
      const std::uint8_t* const seen = view.descriptor(i);
      grid.ForEachNear(prediction->pixel, [&](std::uint32_t feature) {
        const std::uint8_t* const looks = features.descriptors.data() + feature * length;
        const std::uint32_t distance =
            is_orb ? HammingDistance(looks, seen) : SquaredDistance(looks, seen);
        Consider(id, distance, &nearest[feature]);
      });
    }
  });
  if (!visited) return visited.error();

  std::vector<MatchCandidate> candidates;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const std::optional<double> ratio =
        AcceptedRatio(features.kind, nearest[i], options.largest_ratio);
    if (!ratio) continue;
    candidates.push_back(
        {static_cast<std::uint32_t>(i), nearest[i].landmark_id, nearest[i].distance, *ratio});
  }
  return UniqueMatches(map, features, std::move(candidates));
}

}  // namespace lodemark
