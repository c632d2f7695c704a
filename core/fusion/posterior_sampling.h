// Mean and spread of the position over the whole error model of the ranges, by sampling.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/fusion/density_table.h"
#include "core/fusion/point_problem.h"

namespace lodemark {

struct PosteriorMoments {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();  // east, north, up, pivot clock from the state
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double effective_samples = 0.0;
};

// Population Monte Carlo with quasi-random normal points: the first round from a broad normal
// around the present state, each further one from the moments of the one before. Clock differences
// are held at the state. Repeatable: the points are always the same.
class PosteriorSampling {
 public:
  explicit PosteriorSampling(int samples);

  // proposal: covariance of the first round, positive definite.
  PosteriorMoments Run(const PointProblem& problem, const Eigen::Matrix4d& proposal);

 private:
  // What a sample needs of a row.
  struct Line {
    Eigen::Vector3d direction;
    double residual_m = 0.0;  // at the present state
    double clock = 0.0;       // 1 if the pivot clock is in it
  };

  PosteriorMoments Round(const PointProblem& problem, const Eigen::Vector4d& mean,
                         const Eigen::Matrix4d& covariance);

  std::vector<Eigen::Vector4d> normal_points_;
  std::vector<DensityTable> tables_;
  std::vector<Line> lines_;
  std::vector<double> log_weights_;
  std::vector<Eigen::Vector4d> points_;
};

}  // namespace lodemark
