#include "core/session/accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/adjustment/distributions.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kRelativeTolerance = 2e-4;

// The nodes of a quarter turn.
constexpr int kSteps = 16;
constexpr double kStep_rad = kPi / 2.0 / kSteps;
struct Nodes {
  Nodes() {
    for (std::size_t i = 0; i < kSteps; ++i) {
      sine[i] = std::sin((static_cast<double>(i) + 0.5) * kStep_rad);
    }
    // The cosines are the sines from the other end.
    std::reverse_copy(sine.begin(), sine.end(), cosine.begin());
  }
  std::array<double, kSteps> sine;
  std::array<double, kSteps> cosine;
};

// Probability inside a circle for principal sigmas 1 and ratio: over the strips across the major
// axis, at radius times the sine of an angle. The integrand goes on evenly beyond both ends of the
// quarter turn, so the midpoint rule converges fast, and nothing in it is narrow for small ratios.
double ProbabilityInside(double radius, double ratio) {
  static const Nodes nodes;
  double sum = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double along = radius * nodes.sine[i];
    const double across = radius * nodes.cosine[i];
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
  // Between an error along a line and one alike in all directions, and between their densities by
  // radius. What lies between goes about with the square of the ratio: a first guess, then secants.
  const double along_a_line = NormalQuantile(0.5 * (1.0 + probability));
  const double all_around = std::sqrt(-2.0 * std::log(1.0 - probability));
  const double share = ratio * ratio;
  double slope =
      (1.0 - share) * 2.0 / std::sqrt(2.0 * kPi) * std::exp(-0.5 * along_a_line * along_a_line) +
      share * (1.0 - probability) * all_around;
  double radius = along_a_line + share * (all_around - along_a_line);
  double excess = ProbabilityInside(radius, ratio) - probability;
  for (int i = 0; i < 20; ++i) {
    const double next = std::clamp(radius - excess / slope, along_a_line, all_around);
    const double step = next - radius;
    radius = next;
    if (std::abs(step) < kRelativeTolerance * radius) break;
    const double before = excess;
    excess = ProbabilityInside(radius, ratio) - probability;
    // Where the rule's own error is all there is, the slope is as good as before.
    if ((excess - before) / step > 0.1 * slope) slope = (excess - before) / step;
  }
  return radius * major_m;
}

}  // namespace lodemark
