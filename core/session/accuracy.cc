#include "core/session/accuracy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/adjustment/distributions.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kRelativeTolerance = 2e-4;

// Probability inside a circle for principal sigmas 1 and ratio: over the strips across the major
// axis, at radius times the sine of an angle. The integrand goes on evenly beyond both ends of the
// quarter turn, so the midpoint rule converges fast, and nothing in it is narrow for small ratios.
double ProbabilityInside(double radius, double ratio) {
  constexpr int kSteps = 16;
  constexpr double kStep_rad = kPi / 2.0 / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double along = radius * std::sin((i + 0.5) * kStep_rad);
    const double across = radius * std::cos((i + 0.5) * kStep_rad);
    sum +=
        std::exp(-0.5 * along * along) * std::erf(across / (ratio * std::numbers::sqrt2)) * across;
  }
  return 2.0 * sum * kStep_rad / std::sqrt(2.0 * kPi);
}

}  // namespace

double RadiusOfProbability(const Eigen::Matrix2d& covariance_m2, double probability) {
  const double mean = 0.5 * covariance_m2.trace();
  const double half = 0.5 * (covariance_m2(0, 0) - covariance_m2(1, 1));
  const double spread = std::hypot(half, covariance_m2(0, 1));
  const double major_m = std::sqrt(std::max(mean + spread, 0.0));
  if (!(major_m > 0.0)) return 0.0;
  const double ratio = std::max(std::sqrt(std::max(mean - spread, 0.0)) / major_m, 1e-3);
  // Between an error along a line and one alike in all directions; false position, halving the
  // weight of an end that stays (Illinois).
  double low = NormalQuantile(0.5 * (1.0 + probability));
  double high = std::sqrt(-2.0 * std::log(1.0 - probability));
  double below = ProbabilityInside(low, ratio) - probability;
  double above = ProbabilityInside(high, ratio) - probability;
  // At the very ends the rule's own error decides the sign.
  if (below >= 0.0) return low * major_m;
  if (above <= 0.0) return high * major_m;
  double radius = low;
  int stayed = 0;
  for (int i = 0; i < 20 && high - low > kRelativeTolerance * low; ++i) {
    const double before = radius;
    radius = (low * above - high * below) / (above - below);
    const double excess = ProbabilityInside(radius, ratio) - probability;
    if (excess < 0.0) {
      low = radius;
      below = excess;
      if (stayed == 1) above *= 0.5;
      stayed = 1;
    } else {
      high = radius;
      above = excess;
      if (stayed == -1) below *= 0.5;
      stayed = -1;
    }
    if (std::abs(radius - before) < 0.5 * kRelativeTolerance * radius) break;
  }
  return radius * major_m;
}

}  // namespace lodemark
