// Probabilities and quantiles of the distributions that test residuals.
#pragma once

namespace lodemark {

// Probability that a standard normal value lies below x.
double NormalCdf(double x);

// The value below which a standard normal lies with the probability, 0 < probability < 1, to 1e-9.
double NormalQuantile(double probability);

// Probability that a chi-square value with the degrees of freedom (> 0) lies below x.
double ChiSquareCdf(double x, double degrees_of_freedom);

// Its inverse, 0 < probability < 1, to a relative 1e-9.
double ChiSquareQuantile(double probability, double degrees_of_freedom);

}  // namespace lodemark
