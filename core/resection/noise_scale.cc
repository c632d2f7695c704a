#include "core/resection/noise_scale.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/units.h"

namespace lodemark {
namespace {

// What a square of three unknowns is within, 95 times in a hundred, if its variances are right.
constexpr double kSquared95 = 7.814727903251179;

// Degrees of freedom beyond which the tail of the F distribution is its first-order expansion.
constexpr double kManyDegrees = 150.0;

// Probability that a chi-square of three degrees of freedom exceeds a square, and its derivative.
struct Tail {
  double beyond = 0.0;
  double by_square = 0.0;
};
Tail TailOfThree(double square) {
  const double density = std::sqrt(square / (2.0 * kPi)) * std::exp(-0.5 * square);
  return {std::erfc(std::sqrt(0.5 * square)) + 2.0 * density, -density};
}

}  // namespace

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

double NoiseThatCovers(double noise_px, double degrees, double gate_px, double least_px,
                       double most_px) {
  // The F distribution's bound over the chi-square's, to the first order in one over degrees.
  if (degrees > kManyDegrees) {
    return noise_px * std::sqrt(1.0 + 0.5 * (kSquared95 - 1.0) / degrees);
  }
  constexpr std::size_t kSteps = 48;
  // The logarithm of noise from squares scatters by sqrt(1 / (2 degrees)), and to the upper side
  // more.
  const double root = std::sqrt(std::max(degrees, 1e-3));
  const double log_estimate = std::log(noise_px);
  const double lowest = std::max(std::log(least_px), log_estimate - std::min(5.0 / root, 2.3));
  const double highest =
      std::min(std::log(std::max(most_px, noise_px)), log_estimate + 12.0 / root);
  const double width = (highest - lowest) / (kSteps - 1);
  if (!(width > 0.0)) return noise_px;
  std::array<double, kSteps> variance;
  std::array<double, kSteps> weight;
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double log_noise = lowest + width * static_cast<double>(k);
    variance[k] = std::exp(2.0 * log_noise);
    const double kept = -std::expm1(-0.5 * gate_px * gate_px / variance[k]);
    weight[k] = degrees * (-log_noise - 0.5 * noise_px * noise_px / variance[k] -
                           0.5 * std::log(std::max(kept, 1e-300)));
    largest = std::max(largest, weight[k]);
  }
  double sum = 0.0;
  for (double& each : weight) sum += each = std::exp(each - largest);
  // By Newton's steps on the logarithm of the variance, from below.
  double covering = noise_px * noise_px;
  for (int step = 0; step < 20; ++step) {
    double beyond = 0.0;
    double slope = 0.0;
    for (std::size_t k = 0; k < kSteps; ++k) {
      const double square = kSquared95 * covering / variance[k];
      const Tail tail = TailOfThree(square);
      beyond += weight[k] / sum * tail.beyond;
      slope += weight[k] / sum * tail.by_square * square;
    }
    // The logarithm of the tail is nearer to a line than the tail.
    const double change =
        std::clamp(-beyond * std::log(beyond / 0.05) / std::min(slope, -1e-12), -1.0, 1.0);
    covering *= std::exp(change);
    if (std::abs(change) < 1e-6) break;
  }
  return std::clamp(std::sqrt(covering), least_px, std::max(most_px, noise_px));
}

}  // namespace lodemark
