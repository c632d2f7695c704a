// Visual ranges whose errors are correlated: those of one photograph.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/fusion/position_witness.h"

namespace lodemark {

// The visual pseudolites of Xu et al. (equation 1), with the covariance that they really have: they
// come from one resected pose. Not robust: what is mistaken the resection has left out.
class VisualRangeGroup : public PositionWitness {
 public:
  // points_in_ecef: of the landmarks. covariance_m2: n x n, positive semidefinite: combinations of
  // ranges that it claims to be exact follow from the others, and are left out. Keeps copies.
  void Set(std::span<const Eigen::Vector3d> points_in_ecef, std::span<const double> ranges_m,
           const Eigen::MatrixXd& covariance_m2);

  PositionStatement At(const Eigen::Vector3d& point_in_ecef) override;
  bool Agrees() const override { return true; }
  std::size_t parts() const override { return 0; }
  double WeightOf(std::size_t) const override { return 1.0; }
  PositionStatement Without(std::size_t) const override { return {}; }
  PositionStatement WithoutBoth(std::size_t, std::size_t) const override { return {}; }
  double wrong_probability() const override { return 0.0; }

 private:
  std::vector<Eigen::Vector3d> points_in_ecef_;
  std::vector<double> ranges_m_;
  Eigen::MatrixXd whitener_;  // rows: independent combinations of the ranges, in sigmas
};

}  // namespace lodemark
