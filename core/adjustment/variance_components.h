// Splits the variance of observations into two components by the squares of their residuals.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace lodemark {

// Variance of an observation: constant + proportional * coefficient, where the coefficient is known
// and differs between observations (1 / sin^2 of the elevation, a squared distance).
struct VarianceLaw {
  double constant = 0.0;
  double proportional = 0.0;
};

// Helmert's idea, iterated and simplified to the diagonal: the expected square of a residual is its
// redundancy number times the variance; least squares on the squares, each weighted by what the
// law of the step before says of its spread (of a normal error: twice the squared variance).
//
// Squares are summed in classes of similar coefficients with their exact moments, so any number of
// observations takes the same room.
class VarianceComponents {
 public:
  // redundancy: the observation's redundancy number, 0..1. Ignores what is not finite.
  void Add(double coefficient, double squared_residual, double redundancy);
  // Makes what was added so far count less.
  void Fade(double share);
  // Sum of the redundancy numbers.
  double redundancy() const;

  // start: law to weigh the first step by. Neither component is ever negative. Empty if nothing was
  // added, or if the coefficients are too much alike to tell the components apart.
  std::optional<VarianceLaw> Estimate(const VarianceLaw& start) const;

 private:
  struct Class {
    double squares = 0.0;
    double redundancy = 0.0;
    double moment = 0.0;  // redundancy times coefficient
  };
  // Quarter octaves of the coefficient from 1 up.
  static constexpr std::size_t kClasses = 40;
  std::array<Class, kClasses> classes_ = {};
};

}  // namespace lodemark
