#include "core/fusion/position_statement.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/geo/geodetic.h"

namespace lodemark {

int PositionStatement::Rank(double sigma_m) const {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(information_pm2, Eigen::EigenvaluesOnly);
  return static_cast<int>((axes.eigenvalues().array() * sigma_m * sigma_m > 1.0).count());
}

void PositionStatement::Moments(double sigma_m, Eigen::Vector3d* offset_enu_m,
                                Eigen::Matrix3d* covariance_m2) const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information_pm2);
  offset_enu_m->setZero();
  covariance_m2->setZero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = axes.eigenvectors().col(i);
    const double information = axes.eigenvalues()[i];
    const bool is_fixed = information * sigma_m * sigma_m > 1.0;
    const double variance_m2 = is_fixed ? 1.0 / information : sigma_m * sigma_m;
    if (is_fixed) *offset_enu_m += variance_m2 * axis.dot(pull_pm) * axis;
    *covariance_m2 += variance_m2 * axis * axis.transpose();
  }
}

// With S the information and M the error's covariance, (S^-1 + M)^-1 = (I + S M)^-1 S, which needs
// no inverse of S.
PositionStatement PositionStatement::WithCommonError(
    const Eigen::Matrix3d& covariance_enu_m2) const {
  const Eigen::Matrix3d shrink =
      (Eigen::Matrix3d::Identity() + information_pm2 * covariance_enu_m2).inverse();
  const Eigen::Matrix3d information = shrink * information_pm2;
  return {around_in_ecef, 0.5 * (information + information.transpose()), shrink * pull_pm};
}

// The axes of two points near by are parallel for this.
PositionStatement Together(const PositionStatement& first, const PositionStatement& second) {
  const Eigen::Vector3d apart_enu_m = EnuFromEcefRotation(GeodeticFromEcef(first.around_in_ecef)) *
                                      (second.around_in_ecef - first.around_in_ecef);
  return {first.around_in_ecef, first.information_pm2 + second.information_pm2,
          first.pull_pm + second.pull_pm + second.information_pm2 * apart_enu_m};
}

}  // namespace lodemark
