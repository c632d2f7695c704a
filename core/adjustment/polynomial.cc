#include "core/adjustment/polynomial.h"

#include <cmath>

namespace lodemark {
namespace {

constexpr std::size_t kMostCoefficients = kMostRealRoots + 1;
using Coefficients = std::array<double, kMostCoefficients>;

// Relative to the largest coefficient, the value of an extremum that passes for a double root.
constexpr double kRounding = 1e-13;

// Half the interval searched: so much over 1 that no root at 1 is lost to rounding. What both
// searches find, closer than kSame relative to its size, is one root.
constexpr double kReach = 1.0 + 1e-6;
constexpr double kSame = 1e-9;

constexpr int kMostSteps = 100;

struct ValueAndSlope {
  double value;
  double slope;
};

ValueAndSlope Evaluate(const Coefficients& coefficients, std::size_t degree, double x) {
  double value = coefficients[degree];
  double slope = 0.0;
  for (std::size_t k = degree; k-- > 0;) {
    slope = slope * x + value;
    value = value * x + coefficients[k];
  }
  return {value, slope};
}

// Where the polynomial, of different signs at both ends, changes sign: Newton's steps, and halving
// where they leave the bracket or shrink it slowly.
double FindSignChange(const Coefficients& coefficients, std::size_t degree, double low, double high,
                      bool rises) {
  double x = 0.5 * (low + high);
  double last_step = high - low;
  for (int i = 0; i < kMostSteps; ++i) {
    const ValueAndSlope at = Evaluate(coefficients, degree, x);
    if (at.value == 0.0) return x;
    ((at.value > 0.0) == rises ? high : low) = x;
    double next = x - at.value / at.slope;
    if (!(next > low && next < high && std::abs(next - x) < 0.5 * last_step)) {
      next = 0.5 * (low + high);
    }
    last_step = std::abs(next - x);
    if (last_step <= 1e-16) return next;
    x = next;
  }
  return x;
}

// Roots in [-kReach, kReach], ascending, by way of the derivatives' roots, between which each is
// monotone.
int FindRootsWithinReach(const Coefficients& coefficients, std::size_t degree, double* roots) {
  std::array<double, kMostCoefficients + 1> extrema = {};
  std::size_t extremum_count = 0;
  for (std::size_t order = degree; order-- > 0;) {
    const std::size_t reduced = degree - order;
    Coefficients derivative = {};
    double largest = 0.0;
    for (std::size_t k = 0; k <= reduced; ++k) {
      derivative[k] = coefficients[k + order];
      for (std::size_t factor = k + 1; factor <= k + order; ++factor) {
        derivative[k] *= static_cast<double>(factor);
      }
      largest = std::max(largest, std::abs(derivative[k]));
    }

    std::array<double, kMostCoefficients + 1> found = {};
    std::size_t found_count = 0;
    double low = -kReach;
    double value_at_low = Evaluate(derivative, reduced, low).value;
    for (std::size_t i = 0; i <= extremum_count; ++i) {
      const double high = i < extremum_count ? extrema[i] : kReach;
      const double value_at_high = Evaluate(derivative, reduced, high).value;
      const bool touches =
          order == 0 && i < extremum_count && std::abs(value_at_high) < kRounding * largest;
      if ((value_at_low < 0.0) != (value_at_high < 0.0)) {
        found[found_count++] = FindSignChange(derivative, reduced, low, high, value_at_high >= 0.0);
      } else if (touches) {
        found[found_count++] = high;
      }
      if (found_count >= reduced) break;
      low = high;
      value_at_low = value_at_high;
    }
    extrema = found;
    extremum_count = found_count;
  }
  std::copy_n(extrema.begin(), extremum_count, roots);
  return static_cast<int>(extremum_count);
}

}  // namespace

int FindRealRoots(std::span<const double> coefficients, std::span<double> roots) {
  double largest = 0.0;
  for (const double coefficient : coefficients) {
    if (!std::isfinite(coefficient)) return 0;
    largest = std::max(largest, std::abs(coefficient));
  }
  std::size_t degree = coefficients.size();
  while (degree > 0 && coefficients[degree - 1] == 0.0) --degree;
  if (degree < 2 || degree > kMostCoefficients || roots.size() + 1 < degree) return 0;
  --degree;

  // The roots beyond 1 are those of the reversed polynomial within, upside down.
  Coefficients forward = {};
  Coefficients backward = {};
  for (std::size_t k = 0; k <= degree; ++k) {
    forward[k] = coefficients[k] / largest;
    backward[degree - k] = forward[k];
  }
  std::array<double, kMostCoefficients> within;
  const int within_count = FindRootsWithinReach(forward, degree, within.data());
  std::array<double, kMostCoefficients> inverses;
  const int inverse_count = FindRootsWithinReach(backward, degree, inverses.data());

  std::size_t count = 0;
  for (int i = 0; i < within_count; ++i) roots[count++] = within[static_cast<std::size_t>(i)];
  for (int i = 0; i < inverse_count; ++i) {
    const double root = 1.0 / inverses[static_cast<std::size_t>(i)];
    const auto is_same = [root](double other) {
      return std::abs(root - other) < kSame * std::abs(root);
    };
    const bool is_known = std::any_of(
        within.begin(), within.begin() + static_cast<std::ptrdiff_t>(within_count), is_same);
    if (std::isfinite(root) && !is_known && count < degree) roots[count++] = root;
  }
  std::sort(roots.begin(), roots.begin() + static_cast<std::ptrdiff_t>(count));
  return static_cast<int>(count);
}

}  // namespace lodemark
