#include "core/resection/noise_scale.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lodemark {

double KeptVariance(double squared_gate) {
  const double half = 0.5 * squared_gate;
  if (half > 500.0) return 1.0;
  if (half < 1e-6) return 0.5 * half;
  return 1.0 - half / std::expm1(half);
}

double ScaleFromMedian(std::vector<double> squares_within, double limit) {
  if (squares_within.empty()) return std::sqrt(limit);
  const auto middle =
      squares_within.begin() + static_cast<std::ptrdiff_t>(squares_within.size() / 2);
  std::nth_element(squares_within.begin(), middle, squares_within.end());
  const double median = *middle;
  // Of the squares below limit, the share below the median is a half: too large a scale makes them
  // uniform, too small a one puts all of them below.
  double low = std::log(1e-4);
  double high = 0.5 * std::log(limit);
  for (int i = 0; i < 50; ++i) {
    const double log_scale = 0.5 * (low + high);
    const double twice_square = 2.0 * std::exp(2.0 * log_scale);
    const double share = std::expm1(-median / twice_square) / std::expm1(-limit / twice_square);
    (share > 0.5 ? low : high) = log_scale;
  }
  return std::exp(0.5 * (low + high));
}

double NoiseFromSquares(std::span<const NoisyResidual> residuals, double expected, double least_px,
                        double most_px) {
  const auto sum = [&](double noise_px) {
    double squares = 0.0;
    for (const NoisyResidual& row : residuals) {
      Eigen::Matrix2d covariance = row.others_px2;
      covariance.diagonal().array() += noise_px * noise_px * row.own_variance;
      const Eigen::Vector2d weighted = covariance.inverse() * row.residual_px;
      squares += row.residual_px.dot(weighted);
    }
    return squares;
  };
  const bool is_plain = std::all_of(residuals.begin(), residuals.end(),
                                    [](const auto& row) { return row.others_px2.isZero(0.0); });
  if (is_plain) {
    return std::clamp(std::sqrt(sum(1.0) / std::max(expected, 1e-9)), least_px, most_px);
  }
  if (sum(least_px) <= expected) return least_px;
  double low = std::log(least_px);
  double high = std::log(most_px);
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (sum(std::exp(middle)) > expected ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

}  // namespace lodemark
