#include "core/fusion/range_error.h"

#include <cmath>

namespace lodemark {
namespace {

constexpr double kGrossProbability = 0.005;
constexpr double kGrossDensity_pm = kGrossProbability / 2000.0;  // uniform over +-1 km
constexpr double kInverseSqrtTwoPi = 0.3989422804014327;
constexpr double kInverseSqrtTwo = 0.7071067811865476;
constexpr double kInverseSqrtPi = 0.5641895835477563;

// exp(x^2) erfc(x) for x >= 0, to a relative 3e-5: the slope of the density is a difference of two
// that are nearly alike where the noise exceeds the reflections.
double ScaledErfc(double x) {
  if (x > 2.0) {
    // Continued fraction, Abramowitz and Stegun 7.1.14, cut after eight steps.
    double tail = x;
    for (int k = 8; k > 0; --k) tail = x + 0.5 * k / tail;
    return kInverseSqrtPi / tail;
  }
  // Abramowitz and Stegun 7.1.26, whose error is 1.5e-7 exp(x^2).
  const double t = 1.0 / (1.0 + 0.3275911 * x);
  return t * (0.254829592 +
              t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
}

struct Parts {
  double normal_pm;
  double late_pm;
};

Parts Evaluate(const RangeErrorModel& model, double error_m) {
  const double inverse_sigma = 1.0 / model.sigma_m;
  const double u = error_m * inverse_sigma;
  const double gauss = std::exp(-0.5 * u * u);
  const double normal_pm = kInverseSqrtTwoPi * inverse_sigma * gauss;
  // Normal plus exponential: exp(k^2 / 2 - k u) erfc((k - u) / sqrt 2) / (2 scale), k =
  // sigma/scale.
  const double k = model.sigma_m / model.late_scale_m;
  const double z = (k - u) * kInverseSqrtTwo;
  double late_pm = 0.0;
  if (z >= 0.0) {
    // exp(k^2/2 - k u) = exp(z^2) exp(-u^2/2)
    late_pm = 0.5 / model.late_scale_m * gauss * ScaledErfc(z);
  } else {
    const double tail = gauss > 0.0 ? gauss * ScaledErfc(-z) : 0.0;
    late_pm = 0.5 / model.late_scale_m * (2.0 * std::exp(k * (0.5 * k - u)) - tail);
  }
  return {normal_pm, late_pm};
}

}  // namespace

RangeErrorTerms EvaluateRangeError(const RangeErrorModel& model, double error_m) {
  const Parts parts = Evaluate(model, error_m);
  const double core = (1.0 - kGrossProbability - model.late_probability) * parts.normal_pm;
  const double late = model.late_probability * parts.late_pm;
  RangeErrorTerms terms;
  terms.density_pm = core + late + kGrossDensity_pm;
  // The derivative of normal-plus-exponential is (normal - itself) / scale.
  const double derivative =
      -core * error_m / (model.sigma_m * model.sigma_m) +
      model.late_probability * (parts.normal_pm - parts.late_pm) / model.late_scale_m;
  terms.slope_pm = -derivative / terms.density_pm;
  terms.core_share = core / terms.density_pm;
  terms.late_share = late / terms.density_pm;
  return terms;
}

double RangeErrorDensity(const RangeErrorModel& model, double error_m) {
  const Parts parts = Evaluate(model, error_m);
  return (1.0 - kGrossProbability - model.late_probability) * parts.normal_pm +
         model.late_probability * parts.late_pm + kGrossDensity_pm;
}

double GrossErrorDensity() { return kGrossDensity_pm; }
double GrossErrorProbability() { return kGrossProbability; }

}  // namespace lodemark
