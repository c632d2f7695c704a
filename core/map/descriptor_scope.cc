#include "core/map/descriptor_scope.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodemark {
namespace {

constexpr float kSigmas = 3.0F;  // so far off the camera may be

}  // namespace

void DescriptorScope::Enter(const SearchScope& scope, const DescriptorListView& view) {
  scope_ = &scope;
  view_ = &view;
  limited_ = !scope.allowed_landmarks.empty() || !scope.landmark_positions_m.empty();
  if (!limited_) return;
  const float turn_rad = std::clamp(scope.widest_turn_rad, 0.0F, std::numbers::pi_v<float>);
  cos_widest_turn_ = std::cos(turn_rad);
  sin_widest_turn_ = std::sin(turn_rad);
  answers_.assign(view.size(), kUnknown);
}

// Comparisons are written so that what is not a number admits.
bool DescriptorScope::Ask(std::size_t i) const {
  const std::uint32_t landmark = view_->landmark_id(i);
  const auto allowed = scope_->allowed_landmarks;
  if (!allowed.empty() && (landmark >= allowed.size() || allowed[landmark] == 0)) return false;
  if (landmark >= scope_->landmark_positions_m.size()) return true;

  const DescriptorOrigin origin = view_->origin(i);
  const Eigen::Vector3f to_camera =
      scope_->camera_in_enu_m - scope_->landmark_positions_m[landmark];
  const float distance_m = to_camera.norm();
  const float slack_m = kSigmas * scope_->camera_sigma_m;
  if (origin.distance_m > 0.0F) {
    const float largest_m = origin.distance_m * scope_->largest_zoom;
    if (distance_m - slack_m > largest_m) return false;
    if ((distance_m + slack_m) * scope_->largest_zoom < origin.distance_m) return false;
  }
  if (origin.direction_to_camera.isZero()) return true;
  // The camera lies in a ball, seen from the landmark as a cone of this half angle.
  const float sin_ball = slack_m / distance_m;
  if (!(sin_ball < 1.0F)) return true;
  const float cos_ball = std::sqrt(1.0F - sin_ball * sin_ball);
  if (cos_widest_turn_ <= -cos_ball) return true;  // both angles together pass a half turn
  const float cos_limit = cos_widest_turn_ * cos_ball - sin_widest_turn_ * sin_ball;
  return !(to_camera.dot(origin.direction_to_camera) < cos_limit * distance_m);
}

}  // namespace lodemark
