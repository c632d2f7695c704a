#include "core/session/accuracy.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

// Probability inside a circle for principal sigmas 1 and ratio: the angular integral of the
// two-dimensional normal density, by the midpoint rule (periodic integrand: converges fast).
double ProbabilityInside(double radius, double ratio) {
  constexpr int kSteps = 24;
  double outside = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = (i + 0.5) * (kPi / 2.0) / kSteps;
    const double c = std::cos(angle);
    const double s = std::sin(angle) / ratio;
    const double q = c * c + s * s;
    outside += std::exp(-0.5 * radius * radius * q) / (q * ratio);
  }
  return 1.0 - outside / kSteps;
}

}  // namespace

double RadiusOfProbability(const Eigen::Matrix2d& covariance_m2, double probability) {
  const double mean = 0.5 * covariance_m2.trace();
  const double half = 0.5 * (covariance_m2(0, 0) - covariance_m2(1, 1));
  const double spread = std::hypot(half, covariance_m2(0, 1));
  const double major_m = std::sqrt(std::max(mean + spread, 0.0));
  if (!(major_m > 0.0)) return 0.0;
  const double ratio = std::max(std::sqrt(std::max(mean - spread, 0.0)) / major_m, 1e-3);
  // Between one dimension and two.
  double low = 0.0;
  double high = std::sqrt(-2.0 * std::log(1.0 - probability)) + 1e-6;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (ProbabilityInside(middle, ratio) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high) * major_m;
}

}  // namespace lodemark
