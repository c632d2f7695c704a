#include "core/vision/view_scope.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/units.h"

namespace lodemark {
namespace {

// Photographs of places are taken within this of level. The heading says nothing about it.
constexpr double kSteepest_rad = 30.0 * kRadiansPerDegree;

// What is known with a sigma is taken to be within three.
constexpr double kSigmas = 3.0;

// A table of ids may be this much larger than the landmarks need, and somewhat more.
constexpr std::int64_t kIdsPerLandmark = 32;
constexpr std::int64_t kIdsToSpare = 1'000'000;

Error BadPrior(const char* message) {
  return {ErrorCode::kInvalidArgument, std::string("view prior: ") + message};
}

// Largest standard deviation of the position in any direction.
Result<double> PositionSigma(const ViewPrior& prior) {
  if (!prior.position_in_enu_m.allFinite()) return BadPrior("position is not finite");
  const Eigen::Matrix3d& covariance = prior.position_covariance_m2;
  if (!covariance.allFinite()) return BadPrior("covariance is not finite");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d variances_m2 = solver.eigenvalues();  // ascending
  if (variances_m2[0] < -1e-9 * std::max(1.0, variances_m2[2])) {
    return BadPrior("covariance is not positive semidefinite");
  }
  return std::sqrt(std::max(0.0, variances_m2[2]));
}

// Largest difference between the heading and the azimuth of what the image shows: the cone of view
// reaches further round the vertical the more it is tilted.
double AzimuthReach(const Lens& lens) {
  const double half_field_rad = HalfFieldOfView(lens);
  if (half_field_rad + kSteepest_rad >= 0.5 * kPi) return kPi;  // the zenith may be in view
  return std::asin(std::sin(half_field_rad) / std::cos(kSteepest_rad));
}

}  // namespace

double HalfFieldOfView(const Lens& lens) {
  const double right_px = lens.parameters().width_px - 0.5;
  const double bottom_px = lens.parameters().height_px - 0.5;
  double widest_rad = 0.0;
  for (const double x_px : {-0.5, right_px}) {
    for (const double y_px : {-0.5, bottom_px}) {
      const std::optional<Eigen::Vector3d> direction = lens.Unproject({x_px, y_px});
      if (!direction) return kPi;
      widest_rad = std::max(widest_rad, std::acos(std::clamp(direction->z(), -1.0, 1.0)));
    }
  }
  return widest_rad;
}

Result<ViewScope> ViewScope::Empty(const FeatureMap& map) {
  const std::int64_t limit = map.landmark_id_limit();
  if (limit > map.info().landmarks * kIdsPerLandmark + kIdsToSpare) {
    return Error{ErrorCode::kUnsupported,
                 "map: its landmarks' ids are too far apart to be looked up by place"};
  }
  ViewScope scope;
  scope.allowed_.resize(static_cast<std::size_t>(limit));
  scope.positions_m_.resize(static_cast<std::size_t>(limit), Eigen::Vector3f::Zero());
  return scope;
}

Result<ViewScope> ViewScope::Of(const FeatureMap& map, const Lens& lens, const ViewPrior& prior,
                                const LookUpOptions& options) {
  const Result<double> sigma_m = PositionSigma(prior);
  if (!sigma_m) return sigma_m.error();
  if (!(prior.farthest_m > 0.0)) return BadPrior("the farthest distance is not positive");
  if (prior.heading_rad && !(std::isfinite(*prior.heading_rad) && prior.heading_sigma_rad >= 0.0)) {
    return BadPrior("the heading is not finite, or its sigma is negative");
  }
  Result<ViewScope> scope = Empty(map);
  if (!scope) return scope;
  scope->camera_in_enu_m_ = prior.position_in_enu_m.cast<float>();
  scope->camera_sigma_m_ = static_cast<float>(*sigma_m);

  const double slack_m = kSigmas * *sigma_m;
  const Result<std::vector<Landmark>> landmarks =
      map.LandmarksWithin(prior.position_in_enu_m, prior.farthest_m + slack_m);
  if (!landmarks) return landmarks.error();
  const double reach_rad = AzimuthReach(lens) + kSigmas * prior.heading_sigma_rad;
  for (const Landmark& landmark : *landmarks) {
    if (prior.heading_rad) {
      const Eigen::Vector2d offset_m =
          (landmark.position_in_enu_m - prior.position_in_enu_m).head<2>();
      const double distance_m = offset_m.norm();
      if (distance_m > slack_m) {
        const double azimuth_rad = std::atan2(offset_m.x(), offset_m.y());
        const double off_rad =
            std::abs(std::remainder(azimuth_rad - *prior.heading_rad, 2.0 * kPi));
        if (off_rad > reach_rad + std::asin(slack_m / distance_m)) continue;
      }
    }
    if (options.may_be_seen && !options.may_be_seen(landmark)) continue;
    scope->Admit(landmark);
  }
  return scope;
}

void ViewScope::Admit(const Landmark& landmark) {
  if (landmark.id >= allowed_.size() || allowed_[landmark.id] != 0) return;
  allowed_[landmark.id] = 1;
  positions_m_[landmark.id] = landmark.position_in_enu_m.cast<float>();
  ++size_;
}

SearchScope ViewScope::search_scope() const {
  SearchScope scope;
  scope.allowed_landmarks = allowed_;
  scope.landmark_positions_m = positions_m_;
  scope.camera_in_enu_m = camera_in_enu_m_;
  scope.camera_sigma_m = camera_sigma_m_;
  return scope;
}

}  // namespace lodemark
