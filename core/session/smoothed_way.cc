#include "core/session/smoothed_way.h"

#include <utility>

#include "core/fusion/motion_smoother.h"
#include "core/geo/geodetic.h"
#include "core/session/stated_accuracy.h"
#include "core/session/way_again.h"

namespace lodemark {

SmoothedWay::Moment SmoothedWay::MomentOf(const SessionEstimate& estimate,
                                          const EpochFilter& filter) {
  Moment moment;
  moment.estimate = estimate;
  // What was dropped is of another time than the state.
  moment.carried =
      filter.started() && !filter.steps().empty() && estimate.status != EstimateStatus::kNoData;
  if (moment.carried) {
    moment.step = filter.steps().end() - 1;
    moment.step_ns = filter.heard()[moment.step].time_ns;
    if (estimate.status == EstimateStatus::kFix) {
      moment.ahead_in_ecef_m = estimate.position_in_ecef - filter.position_in_ecef();
      moment.beside_enu_m2 = estimate.covariance_enu_m2 - filter.FilteredCovarianceEnu();
    } else {
      moment.beside_enu_m2 = filter.PositionCovarianceEnu() - filter.FilteredCovarianceEnu();
    }
  }
  return moment;
}

std::size_t SmoothedWay::Note(const SessionEstimate& estimate, const EpochFilter& filter) {
  estimates_.reset();
  moments_.Push(MomentOf(estimate, filter));
  return moments_.end() - 1;
}

void SmoothedWay::NoteAgain(std::size_t number, const SessionEstimate& estimate,
                            const EpochFilter& filter) {
  estimates_.reset();
  if (moments_.Has(number)) moments_[number] = MomentOf(estimate, filter);
}

const std::vector<SessionEstimate>& SmoothedWay::Estimates(const EpochFilter& filter) {
  if (estimates_) return *estimates_;
  const std::vector<MotionState> states = GoAgain(filter.steps().all(), filter.heard().all());
  std::vector<SessionEstimate> estimates;
  estimates.reserve(moments_.all().size());
  for (const Moment& moment : moments_.all()) {
    SessionEstimate estimate = moment.estimate;
    // Where memory ran out, the number may be another's by now.
    if (moment.carried && filter.steps().Has(moment.step) &&
        filter.heard()[moment.step].time_ns == moment.step_ns) {
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
  return estimates_.emplace(std::move(estimates));
}

}  // namespace lodemark
