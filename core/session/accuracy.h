// Radii that hold a share of a two-dimensional normal error.
#pragma once

#include <Eigen/Core>

namespace lodemark {

// Half-width of a normal error that holds 68 % of it, in sigmas.
inline constexpr double kHalfWidth68 = 0.99446;

// Radius of the circle around the mean that holds the given probability (0..1) of a centred
// two-dimensional normal distribution, to a relative 1e-3.
double RadiusOfProbability(const Eigen::Matrix2d& covariance_m2, double probability);

}  // namespace lodemark
