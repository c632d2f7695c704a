#include "core/fusion/protection.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/adjustment/distributions.h"

namespace lodemark {
namespace {

// Share of a row's information that is not its own alone, below which its fault cannot be seen.
constexpr double kUntestable = 1e-3;

// Metres of position a metre of a range, below which a fault is none of the position's.
constexpr double kNoInfluence = 1e-3;

}  // namespace

double HorizontalSigma(const Eigen::Matrix3d& covariance_m2) {
  const double mean = 0.5 * (covariance_m2(0, 0) + covariance_m2(1, 1));
  const double half = 0.5 * (covariance_m2(0, 0) - covariance_m2(1, 1));
  return std::sqrt(std::max(mean + std::hypot(half, covariance_m2(0, 1)), 0.0));
}

ProtectionLevels SeparationLevels(const PointProblem& problem, const PointMatrix& information,
                                  std::span<const double> weights, double spread_factor,
                                  double risk) {
  const Eigen::LLT<PointMatrix, Eigen::Upper> factor(information);
  if (factor.info() != Eigen::Success) return {};
  const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxPointUnknowns, 3> columns =
      factor.solve(Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxPointUnknowns, 3>::Identity(
          problem.unknowns(), 3));
  const Eigen::Matrix3d covariance_m2 = columns.topRows<3>();
  const double count = static_cast<double>(problem.rows().size()) + 1.0;
  const double quantile = spread_factor * -NormalQuantile(0.5 * risk / count);
  ProtectionLevels levels;
  levels.horizontal_m = quantile * HorizontalSigma(covariance_m2);
  levels.vertical_m = quantile * std::sqrt(covariance_m2(2, 2));
  bool seen_horizontal = true;
  bool seen_vertical = true;
  for (std::size_t i = 0; i < problem.rows().size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    const PointProblem::Row& row = problem.rows()[i];
    const PointVector slope = problem.Slope(row);
    const PointVector gain = factor.solve(slope);
    // What stays of the row's own information when the others are told without it.
    const double left = 1.0 - weights[i] * slope.dot(gain);
    if (left < kUntestable) {
      // The others do not fix what the row tells: no residual would show its fault. One that finds
      // its own clock and nothing else does no harm.
      if (weights[i] * gain.head<2>().norm() > kNoInfluence) seen_horizontal = false;
      if (weights[i] * std::abs(gain[2]) > kNoInfluence) seen_vertical = false;
      continue;
    }
    const Eigen::Vector3d shift_m = gain.head<3>() * (weights[i] * problem.Residual(row) / left);
    const Eigen::Matrix3d without_m2 =
        covariance_m2 + weights[i] / left * gain.head<3>() * gain.head<3>().transpose();
    levels.horizontal_m = std::max(
        levels.horizontal_m, shift_m.head<2>().norm() + quantile * HorizontalSigma(without_m2));
    levels.vertical_m =
        std::max(levels.vertical_m, std::abs(shift_m.z()) + quantile * std::sqrt(without_m2(2, 2)));
  }
  if (!seen_horizontal) levels.horizontal_m = 0.0;
  if (!seen_vertical) levels.vertical_m = 0.0;
  return levels;
}

DilutionOfPrecision Dilution(const PointProblem& problem, std::span<const double> weights,
                             double known_bias_m) {
  // Clocks that are unknowns of their own.
  std::array<int, kMaxClockGroups> column;
  int unknowns = 3;
  for (int clock = 0; clock < problem.clocks(); ++clock) {
    const bool known = clock > 0 && problem.prior_sigma_m(clock) <= known_bias_m;
    column[static_cast<std::size_t>(clock)] = known ? 3 : unknowns++;
  }
  PointMatrix normal = PointMatrix::Zero(unknowns, unknowns);
  std::array<bool, kMaxPointUnknowns> supported = {};
  for (std::size_t i = 0; i < problem.rows().size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    const PointProblem::Row& row = problem.rows()[i];
    PointVector slope = PointVector::Zero(unknowns);
    slope.head<3>() = -row.direction;
    if (row.clock >= 0) {
      const int k = column[static_cast<std::size_t>(row.clock)];
      slope[k] = 1.0;
      supported[static_cast<std::size_t>(k)] = true;
    }
    normal += slope * slope.transpose();
  }
  for (int k = 3; k < unknowns; ++k) {
    if (!supported[static_cast<std::size_t>(k)]) normal(k, k) = 1.0;
  }
  const Eigen::LLT<PointMatrix> factor(normal);
  if (factor.info() != Eigen::Success) return {};
  const PointMatrix inverse = factor.solve(PointMatrix::Identity(unknowns, unknowns));
  DilutionOfPrecision dilution;
  dilution.horizontal = std::sqrt(inverse(0, 0) + inverse(1, 1));
  dilution.vertical = std::sqrt(inverse(2, 2));
  dilution.position = std::sqrt(inverse(0, 0) + inverse(1, 1) + inverse(2, 2));
  dilution.time = unknowns > 3 ? std::sqrt(inverse(3, 3)) : 0.0;
  return dilution;
}

}  // namespace lodemark
