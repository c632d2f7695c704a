// Density of a range error under a RangeErrorModel, and what an estimator needs of it.
//
// A mixture of a normal core, a normal plus exponential tail on the late side (reflections
// lengthen the path), and a flat remainder so that no single value can decide anything.
#pragma once

#include "core/fusion/observation.h"

namespace lodemark {

struct RangeErrorTerms {
  double density_pm = 0.0;  // per metre
  double slope_pm = 0.0;    // -d log(density) / d error
  double core_share = 0.0;  // probability that the error is ordinary noise
  double late_share = 0.0;  // that it is a reflection
};

RangeErrorTerms EvaluateRangeError(const RangeErrorModel& model, double error_m);

// Only the density.
double RangeErrorDensity(const RangeErrorModel& model, double error_m);

// What the density falls to far from zero, per metre.
double GrossErrorDensity();
// The probability of that flat part.
double GrossErrorProbability();

}  // namespace lodemark
