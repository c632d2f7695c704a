// A position from ranges to known points and nothing else: the adjustment as a step of its own.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/observation.h"
#include "core/fusion/point_adjustment.h"

namespace lodemark {

enum class PointSolutionStatus : std::uint8_t {
  kGood,
  kTooFew,        // fewer ranges than unknowns
  kNotConverged,  // the geometry does not fix the position
  kInconsistent,  // the ranges that agree are too few to prove the others wrong
  kAmbiguous,     // two places fit alike, and no start says which is meant
};

struct PointSolution {
  PointSolutionStatus status = PointSolutionStatus::kTooFew;
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
  std::uint32_t clock_groups = 0;  // bit per group whose clock was determined
  std::array<double, kMaxClockGroups> clock_m = {};
  std::array<double, kMaxClockGroups> clock_sigma_m = {};
  // Dilutions of the ranges used, all weighted alike. tdop is that of the first clock group.
  double pdop = 0.0;
  double hdop = 0.0;
  double vdop = 0.0;
  double tdop = 0.0;
  int used = 0;
};

// start_in_ecef: where to begin; decides between places that fit alike. Without it, landmarks (no
// clock) are taken to be near and satellites to be seen from near the ground. verdicts: one per
// observation. Points are not farther than 1e9 m from the earth's centre.
PointSolution SolvePoint(std::span<const RangeObservation> observations,
                         const std::optional<Eigen::Vector3d>& start_in_ecef,
                         std::vector<ObservationVerdict>* verdicts);

}  // namespace lodemark
