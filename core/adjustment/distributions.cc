#include "core/adjustment/distributions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodemark {
namespace {

constexpr double kInverseSqrtTwo = 0.7071067811865476;
constexpr double kInverseSqrtTwoPi = 0.3989422804014327;

// Logarithm of the gamma function for x > 0 (Lanczos; std::lgamma writes a global).
double LogGamma(double x) {
  constexpr double kCoefficients[] = {
      676.5203681218851,  -1259.1392167224028,  771.32342877765313,    -176.61502916214059,
      12.507343278686905, -0.13857109526572012, 9.9843695780195716e-6, 1.5056327351493116e-7};
  if (x < 0.5)
    return std::log(3.141592653589793 / std::sin(3.141592653589793 * x)) - LogGamma(1.0 - x);
  double sum = 0.99999999999980993;
  for (int i = 0; i < 8; ++i) sum += kCoefficients[i] / (x + i);
  const double t = x + 6.5;
  return 0.9189385332046727 + (x - 0.5) * std::log(t) - t + std::log(sum);
}

// Regularised lower incomplete gamma function: series below, continued fraction above.
double GammaP(double a, double x) {
  if (!(x > 0.0)) return 0.0;
  const double front = std::exp(a * std::log(x) - x - LogGamma(a));
  // Terms of the series fall like a normal density whose sigma is the root of a.
  const int terms = 1000 + static_cast<int>(10.0 * std::sqrt(std::min(a, 1e8)));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < terms && term > sum * 1e-16; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return front * sum;
  }
  // Lentz's algorithm.
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < terms; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = an * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1.0 / d;
    const double factor = d * c;
    fraction *= factor;
    if (std::abs(factor - 1.0) < 1e-16) break;
  }
  return 1.0 - front * fraction;
}

// Root of an increasing function between low and high.
template <typename Function>
double Bisect(double low, double high, Function function) {
  for (int i = 0; i < 200 && high - low > 1e-12 * (std::abs(low) + std::abs(high)); ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double NormalCdf(double x) { return 0.5 * std::erfc(-x * kInverseSqrtTwo); }

double NormalQuantile(double probability) {
  if (!(probability > 0.0)) return -std::numeric_limits<double>::infinity();
  if (!(probability < 1.0)) return std::numeric_limits<double>::infinity();
  // The lower half keeps its relative precision in the tail.
  if (probability > 0.5) return -NormalQuantile(1.0 - probability);
  // Abramowitz and Stegun 26.2.23, good to 4.5e-4, then Newton's steps.
  const double t = std::sqrt(-2.0 * std::log(probability));
  double x = (2.515517 + t * (0.802853 + t * 0.010328)) /
                 (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) -
             t;
  for (int i = 0; i < 3; ++i) {
    const double density = kInverseSqrtTwoPi * std::exp(-0.5 * x * x);
    if (!(density > 0.0)) break;
    x -= (NormalCdf(x) - probability) / density;
  }
  return x;
}

double ChiSquareCdf(double x, double degrees_of_freedom) {
  return GammaP(0.5 * degrees_of_freedom, 0.5 * x);
}

double ChiSquareQuantile(double probability, double degrees_of_freedom) {
  double high = degrees_of_freedom + 10.0;
  while (ChiSquareCdf(high, degrees_of_freedom) < probability && high < 1e9) high *= 2.0;
  return Bisect(0.0, high,
                [&](double x) { return ChiSquareCdf(x, degrees_of_freedom) - probability; });
}

}  // namespace lodemark
