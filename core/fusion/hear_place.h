// What a statement about the position changes in a state that holds it.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "core/fusion/position_statement.h"

namespace lodemark {

// said: independent, around the position of the state. The first three errors are the position's,
// earth-fixed. Shrinks the covariance, and gives what is to be added to the state.
template <int kErrors>
Eigen::Matrix<double, kErrors, 1> HearPlace(const PositionStatement& said,
                                            const Eigen::Matrix3d& enu_from_ecef,
                                            Eigen::Matrix<double, kErrors, kErrors>* covariance) {
  const Eigen::Matrix3d information =
      enu_from_ecef.transpose() * said.information_pm2 * enu_from_ecef;
  const Eigen::Matrix<double, kErrors, 3> cross = covariance->template leftCols<3>();
  // (I + L P)^-1 L is the inverse of the innovation's covariance P + L^-1, L deficient or not.
  const Eigen::Matrix3d shrink =
      (Eigen::Matrix3d::Identity() + information * covariance->template topLeftCorner<3, 3>())
          .inverse();
  const Eigen::Matrix<double, kErrors, kErrors> after =
      *covariance - cross * (shrink * information) * cross.transpose();
  *covariance = 0.5 * (after + after.transpose());
  return cross * (shrink * (enu_from_ecef.transpose() * said.pull_pm));
}

}  // namespace lodemark
