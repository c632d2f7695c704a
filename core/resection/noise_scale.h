// The noise of pixels from the residuals of the sights that a gate let through, which are smaller
// than residuals are.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace lodemark {

// Squares of sight residuals in sigmas have a chi-square distribution of two degrees of freedom;
// this share of its mean is left where those beyond the squared gate are cut off.
double KeptVariance(double squared_gate);

// Scale of the sigma of normal residuals with two components each, from the median of the squares
// that lie within limit: 1 where the squares are in sigmas. At most sqrt(limit).
double ScaleFromMedian(std::vector<double> squares_within, double limit);

// A residual whose covariance is noise^2 own + others.
struct NoisyResidual {
  Eigen::Vector2d residual_px;
  double own_variance = 1.0;                             // pixel_sigma_px squared
  Eigen::Matrix2d others_px2 = Eigen::Matrix2d::Zero();  // of the landmark
};

// The noise_px at which the residuals' weighted squares sum to expected. least_px if there they are
// already less.
double NoiseFromSquares(std::span<const NoisyResidual> residuals, double expected, double least_px,
                        double most_px);

// The noise whose 95 % ellipsoid of three unknowns holds 95 % where noise_px is but an estimate,
// from squares with that many degrees of freedom of residuals cut off beyond gate_px. What is known
// of the noise without them: that it lies between least_px and most_px, at any scale alike. With
// many degrees the estimate itself; with few the bound is that of an F distribution, or wider where
// the gate cannot tell more noise from less.
double NoiseThatCovers(double noise_px, double degrees, double gate_px, double least_px,
                       double most_px);

}  // namespace lodemark
