// Bounds on the position error that hold although any one range may be wrong unnoticed, and the
// dilution of precision.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/fusion/point_problem.h"

namespace lodemark {

// Larger sigma of the horizontal part of a covariance in east, north, up.
double HorizontalSigma(const Eigen::Matrix3d& covariance_m2);

// 0 where none can be stated: the fault of a single range could move the position that way and no
// other range would contradict.
struct ProtectionLevels {
  double horizontal_m = 0.0;
  double vertical_m = 0.0;
};

// Solution separation: for every range, how far the position would move without it, plus the
// quantile of the spread that is left then; the largest counts. information: the normal matrix at
// the solution; weights: the information each row put into it; spread_factor (>= 1): how much wider
// the errors are than the information says; risk: probability of a larger error, both ends.
ProtectionLevels SeparationLevels(const PointProblem& problem, const PointMatrix& information,
                                  std::span<const double> weights, double spread_factor,
                                  double risk);

struct DilutionOfPrecision {
  double horizontal = 0.0;
  double vertical = 0.0;
  double position = 0.0;
  double time = 0.0;
};

// Of the rows whose weight is positive, all alike; groups whose bias is known within
// known_bias_m share the pivot's clock. Zeros if the geometry is deficient.
DilutionOfPrecision Dilution(const PointProblem& problem, std::span<const double> weights,
                             double known_bias_m);

}  // namespace lodemark
