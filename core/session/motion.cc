#include "core/session/motion.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// A velocity that is older than this is none any more.
constexpr double kVelocityLasts_s = 3.0;

// 1 sigma an axis, east, north, up: of a velocity nobody knows, and of how it changes in a second.
const Eigen::Vector3d kAnyVelocity_mps(2.0, 2.0, 0.5);
const Eigen::Vector3d kChange_mps2(1.0, 1.0, 0.3);

double Seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

}  // namespace

void Motion::Learn(const SessionEstimate& estimate) {
  if (estimate.status != EstimateStatus::kFix || !estimate.has_velocity) return;
  has_velocity_ = true;
  time_ns_ = estimate.time_ns;
  velocity_in_ecef_mps_ =
      EnuFromEcefRotation(estimate.position).transpose() * estimate.velocity_enu_mps;
  covariance_enu_m2ps2_ = estimate.velocity_covariance_enu_m2ps2;
}

Displacement Motion::Between(std::int64_t from_ns, std::int64_t to_ns) const {
  const double seconds = Seconds(from_ns, to_ns);
  Displacement moved;
  const double age_s =
      std::max(std::abs(Seconds(time_ns_, from_ns)), std::abs(Seconds(time_ns_, to_ns)));
  if (has_velocity_ && age_s < kVelocityLasts_s) {
    moved.in_ecef_m = velocity_in_ecef_mps_ * seconds;
    moved.covariance_enu_m2 = covariance_enu_m2ps2_;
    moved.covariance_enu_m2.diagonal() += (kChange_mps2 * age_s).cwiseAbs2();
  } else {
    moved.covariance_enu_m2.diagonal() = kAnyVelocity_mps.cwiseAbs2();
  }
  moved.covariance_enu_m2 *= seconds * seconds;
  return moved;
}

}  // namespace lodemark
