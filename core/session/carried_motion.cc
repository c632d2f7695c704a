#include "core/session/carried_motion.h"

#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// Two or three seconds until inertial sensors are found out, at the speed of a city.
constexpr double kMisled_m = 15.0;

}  // namespace

Eigen::Vector3d CarriedMotion::position_in_ecef() const {
  return inertial() ? inertial_.filter().state().position_in_ecef : motion_.position_in_ecef();
}

Eigen::Vector3d CarriedMotion::velocity_in_ecef_mps() const {
  return inertial() ? inertial_.filter().state().velocity_in_ecef_mps
                    : motion_.velocity_in_ecef_mps();
}

double CarriedMotion::clock_drift_mps() const {
  return inertial() ? inertial_.filter().clock_drift_mps() : motion_.clock_drift_mps();
}

Eigen::Matrix3d CarriedMotion::PositionCovarianceEnu() const {
  return inertial() ? inertial_.filter().PositionCovarianceEnu() : motion_.PositionCovarianceEnu();
}

Eigen::Matrix3d CarriedMotion::VelocityCovarianceEnu() const {
  return inertial() ? inertial_.filter().VelocityCovarianceEnu() : motion_.VelocityCovarianceEnu();
}

void CarriedMotion::Start(const Eigen::Vector3d& position_in_ecef,
                          const Eigen::Matrix3d& covariance_enu_m2) {
  inertial_.Forget();
  motion_.Start(position_in_ecef, covariance_enu_m2);
}

void CarriedMotion::Stop() {
  inertial_.Forget();
  motion_.Stop();
}

void CarriedMotion::Advance(std::int64_t from_ns, std::int64_t to_ns,
                            std::span<const RangeRateObservation> rates,
                            std::span<const RangeChangeObservation> changes,
                            const MotionModel& model, MotionVerdicts* verdicts) {
  if (inertial()) {
    MotionState before;
    const InertialState& state = inertial_.filter().state();
    before.mean << state.position_in_ecef, state.velocity_in_ecef_mps;
    before.covariance = inertial_.filter().covariance().topLeftCorner<6, 6>();
    const Eigen::Matrix3d place_m2 = inertial_.filter().PositionCovarianceEnu();
    const bool reached = inertial_.Advance(from_ns, to_ns, rates, changes, &barometer_, verdicts);
    if (reached && inertial()) return;
    // Back to what moves by itself, from where it was. What was proven wrong has misled it for some
    // seconds, above all in its velocity.
    inertial_.Forget();
    if (reached) {
      motion_.Start(before.mean.head<3>(),
                    place_m2 + kMisled_m * kMisled_m * Eigen::Matrix3d::Identity());
    } else {
      motion_.Start(before);
    }
  }
  const double seconds = 1e-9 * static_cast<double>(to_ns - from_ns);
  const std::optional<Rise> rise =
      barometer_.RiseBetween(from_ns, to_ns, GeodeticFromEcef(motion_.position_in_ecef()).height_m,
                             motion_.velocity_in_ecef_mps().norm());
  motion_.Advance(seconds, rates, changes, model, verdicts, rise);
  if (!motion_.started()) return;
  if (rise) barometer_.Learn(seconds, rise->rise_m, *verdicts->rise_square);
  inertial_.Note(to_ns, motion_, verdicts->rates_agree || verdicts->changes_agree);
}

PositionStatement CarriedMotion::Place() const {
  return inertial() ? inertial_.filter().Place() : motion_.Place();
}

void CarriedMotion::Hear(const PositionStatement& said) {
  if (inertial()) {
    inertial_.filter().Hear(said);
  } else {
    motion_.Hear(said);
  }
}

}  // namespace lodemark
