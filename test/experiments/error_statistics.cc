#include "test/experiments/error_statistics.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// A photograph whose bound is larger fixes no place.
constexpr double kNoBound_m2 = 1e4;

// Of chi-square with three degrees of freedom.
constexpr double kSquareOf68 = 3.506;

double Share(int part, int whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void ErrorStatistics::Add(const PositionError& error) {
  ++asked_;
  ++answered_;
  squares_m2_ += error.enu_m.cwiseAbs2();
  const double square = error.enu_m.dot(error.covariance_enu_m2.inverse() * error.enu_m);
  squares_ += square;
  inside_ += square < kSquareOf68 ? 1 : 0;
  if (error.bound_enu_m2.trace() < kNoBound_m2) {
    ++bounded_;
    traces_m2_ += error.bound_enu_m2.trace();
  }
}

double ErrorStatistics::answered_share() const { return Share(answered_, asked_); }
Eigen::Vector3d ErrorStatistics::rmse_enu_m() const {
  return (squares_m2_ / std::max(answered_, 1)).cwiseSqrt();
}
double ErrorStatistics::nees() const { return squares_ / 3.0 / std::max(answered_, 1); }
double ErrorStatistics::within_68() const { return Share(inside_, answered_); }
double ErrorStatistics::bound_m() const { return std::sqrt(traces_m2_ / std::max(bounded_, 1)); }

}  // namespace lodemark
