#include "core/session/redundancy.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "core/fusion/point_problem.h"

namespace lodemark {

bool RedundancyNumbers(std::span<const RangeObservation> ranges,
                       std::span<const ObservationVerdict> verdicts,
                       const Eigen::Vector3d& place_in_ecef, const ClockBiases& biases,
                       std::vector<double>* numbers) {
  // Unknowns: the position, the common clock, and of each group what it differs by.
  std::array<int, kMaxClockGroups> column;
  column.fill(-1);
  int unknowns = 4;
  for (const RangeObservation& range : ranges) {
    if (range.clock_group < 0) continue;
    int& of = column[static_cast<std::size_t>(range.clock_group)];
    if (of < 0 && unknowns < kMaxPointUnknowns) of = unknowns++;
  }
  PointMatrix normal = PointMatrix::Zero(unknowns, unknowns);
  for (int group = 0; group < kMaxClockGroups; ++group) {
    const int of = column[static_cast<std::size_t>(group)];
    // Group 0 differs by nothing; a micrometre stands for it.
    const double sigma_m = std::max(biases[group].sigma_m, 1e-6);
    if (of >= 0) normal(of, of) += 1.0 / (sigma_m * sigma_m);
  }
  const auto row = [&](const RangeObservation& range) {
    PointVector slope = PointVector::Zero(unknowns);
    slope.head<3>() = (place_in_ecef - range.point_in_ecef).normalized();
    if (range.clock_group >= 0) {
      slope[3] = 1.0;
      const int of = column[static_cast<std::size_t>(range.clock_group)];
      if (of >= 0) slope[of] = 1.0;
    }
    return slope;
  };
  const auto weight = [&](std::size_t i) {
    return verdicts[i].weight / (ranges[i].error.sigma_m * ranges[i].error.sigma_m);
  };
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const PointVector slope = row(ranges[i]);
    normal.noalias() += weight(i) * slope * slope.transpose();
  }
  const Eigen::LLT<PointMatrix> factor(normal);
  if (factor.info() != Eigen::Success) return false;
  numbers->resize(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const PointVector slope = row(ranges[i]);
    const PointVector solved = factor.solve(slope);
    (*numbers)[i] = std::clamp(1.0 - weight(i) * slope.dot(solved), 0.0, 1.0);
  }
  return true;
}

}  // namespace lodemark
