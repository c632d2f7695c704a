// Polynomials in one variable: products, sums, and the real roots.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace lodemark {

// The coefficient of the power k at k.
template <int Degree>
struct Polynomial {
  std::array<double, Degree + 1> coefficients = {};
};

template <int A, int B>
Polynomial<A + B> operator*(const Polynomial<A>& a, const Polynomial<B>& b) {
  Polynomial<A + B> product;
  for (std::size_t i = 0; i <= A; ++i) {
    for (std::size_t j = 0; j <= B; ++j) {
      product.coefficients[i + j] += a.coefficients[i] * b.coefficients[j];
    }
  }
  return product;
}

template <int A, int B>
Polynomial<(A > B ? A : B)> operator+(const Polynomial<A>& a, const Polynomial<B>& b) {
  Polynomial<(A > B ? A : B)> sum;
  for (std::size_t i = 0; i <= A; ++i) sum.coefficients[i] += a.coefficients[i];
  for (std::size_t j = 0; j <= B; ++j) sum.coefficients[j] += b.coefficients[j];
  return sum;
}

template <int Degree>
Polynomial<Degree> operator-(Polynomial<Degree> a) {
  for (double& coefficient : a.coefficients) coefficient = -coefficient;
  return a;
}

template <int A, int B>
Polynomial<(A > B ? A : B)> operator-(const Polynomial<A>& a, const Polynomial<B>& b) {
  return a + -b;
}

inline constexpr int kMostRealRoots = 12;

// The real roots, ascending, without the heap; a multiple root once or, where rounding parts it,
// more often. None for the zero polynomial, for degrees above 12, and for what is not finite.
// Gives how many there are. roots holds at least the degree.
int FindRealRoots(std::span<const double> coefficients, std::span<double> roots);

template <int Degree>
int FindRealRoots(const Polynomial<Degree>& polynomial, std::span<double> roots) {
  return FindRealRoots(std::span<const double>(polynomial.coefficients), roots);
}

}  // namespace lodemark
