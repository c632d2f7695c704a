#include "core/session/smoothed_way.h"

#include "core/fusion/motion_smoother.h"
#include "core/geo/geodetic.h"
#include "core/session/stated_accuracy.h"

namespace lodemark {

void SmoothedWay::Note(const SessionEstimate& estimate, const EpochFilter& filter) {
  Moment moment;
  moment.estimate = estimate;
  moment.carried = filter.started() && !filter.steps().empty();
  if (moment.carried) {
    moment.step = filter.steps().size() - 1;
    if (estimate.status == EstimateStatus::kFix) {
      moment.ahead_in_ecef_m = estimate.position_in_ecef - filter.position_in_ecef();
      moment.beside_enu_m2 = estimate.covariance_enu_m2 - filter.FilteredCovarianceEnu();
    } else {
      moment.beside_enu_m2 = filter.PositionCovarianceEnu() - filter.FilteredCovarianceEnu();
    }
  }
  moments_.push_back(moment);
}

std::vector<SessionEstimate> SmoothedWay::Estimates(const EpochFilter& filter) const {
  const std::vector<MotionState> states = SmoothMotion(filter.steps());
  std::vector<SessionEstimate> estimates;
  estimates.reserve(moments_.size());
  for (const Moment& moment : moments_) {
    SessionEstimate estimate = moment.estimate;
    if (moment.carried) {
      const MotionState& state = states[moment.step];
      estimate.position_in_ecef = state.mean.head<3>() + moment.ahead_in_ecef_m;
      estimate.position = GeodeticFromEcef(estimate.position_in_ecef);
      const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(estimate.position);
      const auto in_enu = [&](const Eigen::Matrix3d& in_ecef) -> Eigen::Matrix3d {
        return enu_from_ecef * in_ecef * enu_from_ecef.transpose();
      };
      estimate.covariance_enu_m2 =
          in_enu(state.covariance.topLeftCorner<3, 3>()) + moment.beside_enu_m2;
      estimate.has_velocity = true;
      estimate.velocity_enu_mps = enu_from_ecef * state.mean.tail<3>();
      estimate.velocity_covariance_enu_m2ps2 = in_enu(state.covariance.bottomRightCorner<3, 3>());
      StateAccuracy(&estimate);
      if (estimate.accuracy_m <= kWorstCoasted_m) estimate.status = EstimateStatus::kFix;
    }
    estimates.push_back(estimate);
  }
  return estimates;
}

}  // namespace lodemark
