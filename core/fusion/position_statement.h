// What anything but independent ranges says about the position: a photograph, a filter, a person.
#pragma once

#include <Eigen/Core>

namespace lodemark {

// Half the quadratic form of a normal density, around a point. The information may be deficient:
// what it does not know it does not claim.
struct PositionStatement {
  Eigen::Vector3d around_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information_pm2 = Eigen::Matrix3d::Zero();  // by east, north, up there
  // information * (stated position - around), by east, north, up.
  Eigen::Vector3d pull_pm = Eigen::Vector3d::Zero();

  // -log density, up to a constant, at an offset from around in east, north, up.
  double CostAt(const Eigen::Vector3d& offset_enu_m) const {
    return 0.5 * offset_enu_m.dot(information_pm2 * offset_enu_m) - pull_pm.dot(offset_enu_m);
  }
  // Directions that it fixes to within sigma_m.
  int Rank(double sigma_m) const;
  // Stated position as an offset from around, and its covariance, within the directions that it
  // fixes to within sigma_m; nothing (0, and sigma_m squared) along the others.
  void Moments(double sigma_m, Eigen::Vector3d* offset_enu_m, Eigen::Matrix3d* covariance_m2) const;

  // The same statement if all of it may be displaced by an error that it does not know of.
  PositionStatement WithCommonError(const Eigen::Matrix3d& covariance_enu_m2) const;
};

// What two independent statements say, around the point of the first.
PositionStatement Together(const PositionStatement& first, const PositionStatement& second);

}  // namespace lodemark
