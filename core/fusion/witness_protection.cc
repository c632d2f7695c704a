#include "core/fusion/witness_protection.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/adjustment/distributions.h"
#include "core/fusion/protection.h"

namespace lodemark {
namespace {

// A part without which a direction would be known worse by such a factor cannot be checked there.
constexpr double kUnchecked = 1e3;

}  // namespace

void WidenByParts(const PositionWitness& witness, const PositionStatement& statement, double risk,
                  PointEstimate* estimate) {
  if (witness.parts() == 0) return;
  double& horizontal_m = estimate->protection_level_m;
  double& vertical_m = estimate->vertical_protection_level_m;
  const Eigen::Matrix3d rest = estimate->information_pm2 - statement.information_pm2;
  const double quantile =
      -NormalQuantile(0.5 * risk / (static_cast<double>(witness.parts()) + 1.0));
  const double spread = HorizontalSigma(estimate->covariance_enu_m2);
  const double up_m = std::sqrt(estimate->covariance_enu_m2(2, 2));
  bool seen_horizontal = horizontal_m > 0.0;
  bool seen_vertical = vertical_m > 0.0;
  horizontal_m = std::max(horizontal_m, quantile * spread);
  vertical_m = std::max(vertical_m, quantile * up_m);
  for (std::size_t i = 0; i < witness.parts(); ++i) {
    if (witness.WeightOf(i) < 1e-3) continue;
    const PositionStatement without = witness.Without(i);
    const Eigen::LLT<Eigen::Matrix3d> factor(rest + without.information_pm2);
    if (factor.info() != Eigen::Success) {
      seen_horizontal = false;
      seen_vertical = false;
      break;
    }
    const Eigen::Matrix3d covariance_m2 = factor.solve(Eigen::Matrix3d::Identity());
    // At the solution the pulls of ranges and witness cancel.
    const Eigen::Vector3d shift_m =
        factor.solve(Eigen::Vector3d(without.pull_pm - statement.pull_pm));
    const double horizontal_sigma_m = HorizontalSigma(covariance_m2);
    const double up_sigma_m = std::sqrt(covariance_m2(2, 2));
    if (!(horizontal_sigma_m < kUnchecked * spread)) seen_horizontal = false;
    if (!(up_sigma_m < kUnchecked * up_m)) seen_vertical = false;
    horizontal_m = std::max(horizontal_m, shift_m.head<2>().norm() + quantile * horizontal_sigma_m);
    vertical_m = std::max(vertical_m, std::abs(shift_m.z()) + quantile * up_sigma_m);
  }
  if (!seen_horizontal) horizontal_m = 0.0;
  if (!seen_vertical) vertical_m = 0.0;
}

}  // namespace lodemark
