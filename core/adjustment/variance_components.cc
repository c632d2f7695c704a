#include "core/adjustment/variance_components.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

constexpr int kMostIterations = 50;
constexpr double kConverged = 1e-9;  // relative

// Determinant against the product of the diagonal: below, both components explain the same.
constexpr double kTooMuchAlike = 1e-4;

}  // namespace

void VarianceComponents::Add(double coefficient, double squared_residual, double redundancy) {
  if (!(coefficient > 0.0) || !std::isfinite(coefficient) || !std::isfinite(squared_residual) ||
      !(redundancy > 0.0) || !std::isfinite(redundancy)) {
    return;
  }
  const double number = 4.0 * std::log2(std::max(coefficient, 1.0));
  Class& of = classes_[static_cast<std::size_t>(std::min(number, kClasses - 1.0))];
  of.squares += squared_residual;
  of.redundancy += redundancy;
  of.moment += redundancy * coefficient;
}

void VarianceComponents::Fade(double share) {
  for (Class& of : classes_) {
    of.squares *= share;
    of.redundancy *= share;
    of.moment *= share;
  }
}

double VarianceComponents::redundancy() const {
  double sum = 0.0;
  for (const Class& of : classes_) sum += of.redundancy;
  return sum;
}

std::optional<VarianceLaw> VarianceComponents::Estimate(const VarianceLaw& start) const {
  VarianceLaw law = start;
  for (int i = 0; i < kMostIterations; ++i) {
    double a00 = 0.0;
    double a01 = 0.0;
    double a11 = 0.0;
    double b0 = 0.0;
    double b1 = 0.0;
    for (const Class& of : classes_) {
      if (!(of.redundancy > 0.0)) continue;
      const double mean = of.moment / of.redundancy;
      const double variance = law.constant + law.proportional * mean;
      if (!(variance > 0.0)) return std::nullopt;
      const double weight = 1.0 / (variance * variance);
      a00 += weight * of.redundancy;
      a01 += weight * of.moment;
      a11 += weight * of.moment * mean;
      b0 += weight * of.squares;
      b1 += weight * of.squares * mean;
    }
    const double determinant = a00 * a11 - a01 * a01;
    if (!(determinant > kTooMuchAlike * a00 * a11) || !(b0 > 0.0)) return std::nullopt;
    VarianceLaw next = {(a11 * b0 - a01 * b1) / determinant, (a00 * b1 - a01 * b0) / determinant};
    if (next.constant < 0.0) next = {0.0, b1 / a11};
    if (next.proportional < 0.0) next = {b0 / a00, 0.0};
    const double change =
        std::abs(next.constant - law.constant) + std::abs(next.proportional - law.proportional);
    law = next;
    if (change < kConverged * (law.constant + law.proportional)) break;
  }
  return law;
}

}  // namespace lodemark
