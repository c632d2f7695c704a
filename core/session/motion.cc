#include "core/session/motion.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// 1 sigma an axis, east, north, up: of a velocity nobody knows, which may be a car's, and of how it
// changes in a second.
const Eigen::Vector3d kAnyVelocity_mps(8.0, 8.0, 1.0);
const Eigen::Vector3d kChange_mps2(1.0, 1.0, 0.3);

// A velocity that is older than this is none any more: by then it is hardly surer.
constexpr double kVelocityLasts_s = 5.0;

// A photograph is mistaken more often than Doppler is, which is therefore kept so long.
constexpr double kDopplerHolds_s = 2.0;

// Two places nearer in time say little about the velocity; farther apart, little about that now.
constexpr double kNearest_s = 0.2;
constexpr double kFarthest_s = 4.0;

double Seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

}  // namespace

Motion::Velocity Motion::At(double age_s) const {
  Velocity velocity;
  if (velocity_ && age_s < kVelocityLasts_s) {
    velocity = *velocity_;
    velocity.covariance_enu_m2ps2.diagonal() += (kChange_mps2 * age_s).cwiseAbs2();
  } else {
    velocity.covariance_enu_m2ps2.diagonal() = kAnyVelocity_mps.cwiseAbs2();
  }
  return velocity;
}

double Motion::AgeAt(std::int64_t time_ns) const {
  return velocity_ ? std::abs(Seconds(velocity_->time_ns, time_ns)) : kVelocityLasts_s;
}

void Motion::Learn(const SessionEstimate& estimate) {
  if (estimate.status != EstimateStatus::kFix || !estimate.has_velocity) return;
  velocity_ =
      Velocity{estimate.time_ns,
               EnuFromEcefRotation(estimate.position).transpose() * estimate.velocity_enu_mps,
               estimate.velocity_covariance_enu_m2ps2, true};
}

void Motion::LearnPlace(std::int64_t time_ns, const Eigen::Vector3d& place_in_ecef,
                        const Eigen::Matrix3d& covariance_enu_m2) {
  const std::optional<Place> before = place_;
  place_ = Place{time_ns, place_in_ecef, covariance_enu_m2};
  if (!before) return;
  const double seconds = Seconds(before->time_ns, time_ns);
  if (seconds < kNearest_s || seconds > kFarthest_s) return;
  if (velocity_ && velocity_->by_doppler && AgeAt(time_ns) < kDopplerHolds_s) return;
  Velocity found;
  found.time_ns = time_ns;
  found.in_ecef_mps = (place_in_ecef - before->in_ecef_m) / seconds;
  found.covariance_enu_m2ps2 =
      (before->covariance_enu_m2 + covariance_enu_m2) / (seconds * seconds);
  // It is that of the middle between the two.
  found.covariance_enu_m2ps2.diagonal() += (0.5 * seconds * kChange_mps2).cwiseAbs2();
  const auto spread = [](const Velocity& velocity) {
    return velocity.covariance_enu_m2ps2.topLeftCorner<2, 2>().trace();
  };
  if (spread(found) < spread(At(AgeAt(time_ns)))) velocity_ = found;
}

Displacement Motion::Between(std::int64_t from_ns, std::int64_t to_ns) const {
  const double seconds = Seconds(from_ns, to_ns);
  const Velocity velocity = At(std::max(AgeAt(from_ns), AgeAt(to_ns)));
  Displacement moved;
  moved.in_ecef_m = velocity.in_ecef_mps * seconds;
  moved.covariance_enu_m2 = velocity.covariance_enu_m2ps2 * (seconds * seconds);
  return moved;
}

void Motion::Forget() {
  velocity_.reset();
  place_.reset();
}

}  // namespace lodemark
