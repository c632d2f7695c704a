// Errors of positions against a truth, summed up as the tables of docs/experiments.md show them.
#pragma once

#include <Eigen/Core>

namespace lodemark {

struct PositionError {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();  // as stated
  Eigen::Matrix3d bound_enu_m2 = Eigen::Matrix3d::Zero();       // not finite: none
};

class ErrorStatistics {
 public:
  void Add(const PositionError& error);
  void AddUnanswered() { ++asked_; }

  int answered() const { return answered_; }
  double answered_share() const;
  Eigen::Vector3d rmse_enu_m() const;
  double rmse_m() const { return rmse_enu_m().norm(); }
  double nees() const;       // mean squared error in the units of the covariance, over 3
  double within_68() const;  // share of the errors inside the ellipsoid that holds 68 %
  double bound_m() const;    // root of the mean trace, where there is a bound

 private:
  int asked_ = 0;
  int answered_ = 0;
  int inside_ = 0;
  int bounded_ = 0;
  double squares_ = 0.0;
  double traces_m2_ = 0.0;
  Eigen::Vector3d squares_m2_ = Eigen::Vector3d::Zero();
};

}  // namespace lodemark
