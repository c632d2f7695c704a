#include "core/fusion/coarse_position.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/fusion/clock_biases.h"
#include "core/fusion/point_problem.h"

namespace lodemark {
namespace {

constexpr double kNearestToCentre_m = 6.3e6;
constexpr double kFarthestFromCentre_m = 6.5e6;

// Sum of absolute residuals minimised by reweighting; every group has its own clock.
struct Coarse {
  static constexpr int kMax = 3 + kMaxClockGroups;
  Eigen::Matrix<double, kMax, kMax> normal;
  Eigen::Matrix<double, kMax, 1> right;
};

}  // namespace

std::optional<Eigen::Vector3d> CoarsePosition(std::span<const RangeObservation> observations) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::array<double, kMaxClockGroups> clocks = {};
  Coarse equations;
  double residual_scale_m = 1e7;
  double previous_move_m = 1e9;
  for (int i = 0; i < 40; ++i) {
    equations.normal.setZero();
    equations.right.setZero();
    // Groups without a member, and a vanishing support for lonely ones.
    for (int k = 3; k < Coarse::kMax; ++k) equations.normal(k, k) = 1e-12;
    for (const RangeObservation& observation : observations) {
      const Eigen::Vector3d line = observation.point_in_ecef - position;
      const double distance_m = line.norm();
      const Eigen::Vector3d slope = -line / distance_m;
      const int k = 3 + std::max(observation.clock_group, 0);
      const bool has_clock = observation.clock_group >= 0;
      const double clock_m = has_clock ? clocks[static_cast<std::size_t>(k - 3)] : 0.0;
      const double residual_m = observation.range_m - distance_m - clock_m;
      const double weight = 1.0 / std::max(std::abs(residual_m), residual_scale_m);
      equations.normal.topLeftCorner<3, 3>() += weight * slope * slope.transpose();
      equations.right.head<3>() += weight * residual_m * slope;
      if (!has_clock) continue;
      equations.normal.block<3, 1>(0, k) += weight * slope;
      equations.normal.block<1, 3>(k, 0) += weight * slope.transpose();
      equations.normal(k, k) += weight;
      equations.right[k] += weight * residual_m;
    }
    const Eigen::LDLT<Eigen::Matrix<double, Coarse::kMax, Coarse::kMax>> factor(equations.normal);
    const Eigen::Matrix<double, Coarse::kMax, 1> step = factor.solve(equations.right);
    if (!step.allFinite()) return std::nullopt;
    position += step.head<3>();
    for (std::size_t g = 0; g < clocks.size(); ++g) clocks[g] += step[static_cast<int>(g) + 3];
    const double moved_m = step.head<3>().norm();
    if (moved_m > 1e9) return std::nullopt;
    // First plain least squares until it settles, then ever closer to absolute values.
    if (moved_m < 100.0 && residual_scale_m <= 30.0) break;
    if (moved_m < 1e4 || i > 12) residual_scale_m = std::max(20.0, 0.25 * residual_scale_m);
    previous_move_m = moved_m;
  }
  const double radius_m = position.norm();
  if (previous_move_m > 1e6) return std::nullopt;
  if (radius_m < kNearestToCentre_m || radius_m > kFarthestFromCentre_m) return std::nullopt;
  return position;
}

}  // namespace lodemark
