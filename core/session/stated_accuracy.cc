#include "core/session/stated_accuracy.h"

#include <cmath>

#include "core/session/accuracy.h"

namespace lodemark {

void StateAccuracy(SessionEstimate* estimate) {
  estimate->accuracy_m =
      RadiusOfProbability(estimate->covariance_enu_m2.topLeftCorner<2, 2>(), 0.68);
  estimate->vertical_accuracy_m = kHalfWidth68 * std::sqrt(estimate->covariance_enu_m2(2, 2));
  if (!estimate->has_velocity) return;
  estimate->speed_accuracy_mps =
      RadiusOfProbability(estimate->velocity_covariance_enu_m2ps2.topLeftCorner<2, 2>(), 0.68);
}

}  // namespace lodemark
