// The schemes of the paper and ours on one draw of the square.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "test/experiments/square_draws.h"

namespace lodemark {

enum class Solution { kGnss, kGnssAtmosphere, kVision, kTight, kTightDiagonal, kJoint };

std::string_view NameOf(Solution solution);

struct Solved {
  Eigen::Vector3d error_enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
  double protection_level_m = 0.0;  // horizontal; 0: none
};

// Empty where the scheme gives no position. Vision and the tight schemes resect the photograph with
// the noise as known as the resection finds it; joint takes the bearings of the sights it kept.
std::optional<Solved> SolveSquare(const SquareDraw& draw, int satellites, Solution solution);

// Least covariance that an unbiased estimate of the position can have, from the noise as drawn:
// satellites, clock, bearings and attitude in one, landmarks within their deviation.
Eigen::Matrix3d CramerRaoBound(const SquareDraw& draw, int satellites, bool with_photograph);

}  // namespace lodemark
