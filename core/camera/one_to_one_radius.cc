#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/camera/lens_distortion.h"

namespace lodemark {
namespace {

// The disk ends where one radian more moves the image by less than this many focal lengths: just
// short of the fold, so that what inverting costs in accuracy is bounded. The strip of image lost
// is the square of it: a ten-thousandth of a pixel for focal lengths of some thousands.
constexpr double kLeastGain = 1e-4;

constexpr int kMostIntervals = 20'000;
constexpr double kNarrowest = 1e-10;  // of the radius

// Bounds of a polynomial over 0 <= u0 <= u <= u1: each power at the end that suits its sign.
template <std::size_t kCount>
double LeastOf(const std::array<double, kCount>& coefficients, double u0, double u1) {
  double sum = 0.0;
  double power0 = 1.0;
  double power1 = 1.0;
  for (const double c : coefficients) {
    if (c != 0.0) sum += c * (c > 0.0 ? power0 : power1);
    power0 *= u0;
    power1 *= u1;
  }
  return sum;
}

template <std::size_t kCount>
double MostOf(std::array<double, kCount> coefficients, double u0, double u1) {
  for (double& c : coefficients) c = -c;
  return -LeastOf(coefficients, u0, u1);
}

// A map of a convex region is one-to-one if the symmetric part of its derivative is positive
// definite throughout: along the chord between two points the image then moves on in the direction
// of the chord. The derivative's symmetric part is a sum, so its least eigenvalue is at least the
// sum of the least ones, at distance r from the axis:
//   radial part       min(f'(r), f(r) / r), f(r) = r N / D
//   decentring part   2 (q.x) I + 2 x q^T + 2 q x^T: -6 |q| r, for x against q
//   prism part        w x^T with w = 2 prism_r2 + 4 u prism_r4: -|w| r, for x against w
// Without the latter two this is the fold itself, not only a bound.
class SlopeBound {
 public:
  SlopeBound(const DistortionTerms& terms, IdealImage ideal_image)
      : terms_(terms), ideal_image_(ideal_image) {
    // f' = (N D + 2 u (N' D - N D')) / D^2.
    for (std::size_t i = 0; i < terms.numerator.size(); ++i) {
      for (std::size_t j = 0; j < terms.denominator.size(); ++j) {
        const double weight = 1.0 + 2.0 * (static_cast<double>(i) - static_cast<double>(j));
        slope_numerator_[i + j] += weight * terms.numerator[i] * terms.denominator[j];
      }
    }
  }

  // Whether the least eigenvalue is large enough everywhere from r0 to r1.
  bool Holds(double r0, double r1) const {
    const double u0 = r0 * r0;
    const double u1 = r1 * r1;
    if (!(LeastOf(terms_.denominator, u0, u1) > 0.0)) return false;
    const double denominator = MostOf(terms_.denominator, u0, u1);
    const double along = LeastOf(slope_numerator_, u0, u1) / (denominator * denominator);
    const double across = LeastOf(terms_.numerator, u0, u1) / denominator;
    const double prism = std::max((2.0 * terms_.prism_r2 + 4.0 * u0 * terms_.prism_r4).norm(),
                                  (2.0 * terms_.prism_r2 + 4.0 * u1 * terms_.prism_r4).norm());
    const double disturbance = r1 * (6.0 * terms_.decentring.norm() + prism);
    const double radius_per_rad = ideal_image_ == IdealImage::kPlane ? 1.0 + u0 : 1.0;
    // False, too, if a coefficient is so large that something overflowed.
    return std::min(along, across) - disturbance > kLeastGain / radius_per_rad &&
           std::isfinite(denominator * denominator);
  }

 private:
  const DistortionTerms& terms_;
  IdealImage ideal_image_;
  std::array<double, 8> slope_numerator_ = {};
};

}  // namespace

double OutermostRadius(IdealImage ideal_image) {
  return ideal_image == IdealImage::kPlane ? 1.0 / 6e-7 : kPi;
}

double OneToOneRadius(const DistortionTerms& terms, IdealImage ideal_image) {
  const SlopeBound bound(terms, ideal_image);
  const double outermost = OutermostRadius(ideal_image);
  double radius = 0.0;
  double step = 0.125;
  for (int i = 0; i < kMostIntervals && radius < outermost; ++i) {
    const double next = std::min(radius + step, outermost);
    if (bound.Holds(radius, next)) {
      radius = next;
      step *= 2.0;
    } else {
      step *= 0.5;
      if (step < kNarrowest * std::max(radius, 1e-3)) break;
    }
  }
  return radius;
}

}  // namespace lodemark
