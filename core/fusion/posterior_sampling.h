// Mean and spread of the position over the whole error model of the ranges, by sampling.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/fusion/density_table.h"
#include "core/fusion/point_problem.h"
#include "core/fusion/weighted_samples.h"

namespace lodemark {

struct PosteriorMoments {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();  // east, north, up, pivot clock from the state
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double effective_samples = 0.0;
};

// Population Monte Carlo with quasi-random points: the first round from a broad density around the
// present state, each further one from the moments of the one before. Clock differences
// are held at the state. Repeatable: the points are always the same.
class PosteriorSampling {
 public:
  explicit PosteriorSampling(int samples);

  // proposal: covariance of the first round, positive definite.
  PosteriorMoments Run(const PointProblem& problem, const Eigen::Matrix4d& proposal);

 private:
  // What the samples need of a row.
  struct Line {
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();  // of the residual by mean's unknowns
    double residual_m = 0.0;                          // at the present state
  };

  PosteriorMoments Round(const PointProblem& problem, const Eigen::Vector4d& mean,
                         const Eigen::Matrix4d& covariance);

  WeightedSamples samples_;                  // of Student's t, of unit covariance
  std::vector<double> inverse_of_proposal_;  // one over their density, the largest being 1
  std::vector<DensityTable> tables_;
  std::vector<Line> lines_;
};

}  // namespace lodemark
