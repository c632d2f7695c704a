// Velocity and clock drift of one epoch from Doppler.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/fusion/observation.h"

namespace lodemark {

struct VelocityEstimate {
  Eigen::Vector3d velocity_in_ecef_mps = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ecef_m2ps2 = Eigen::Matrix3d::Zero();
  double clock_drift_mps = 0.0;
  int used = 0;
};

struct RateVerdict {
  double residual_mps = 0.0;
  double weight = 0.0;  // 0..1
};

// Robust least squares; false if fewer than four rates, if they do not fix the velocity, or if only
// four agree and another contradicts them.
// verdicts: one per observation.
bool AdjustVelocity(std::span<const RangeRateObservation> observations, VelocityEstimate* estimate,
                    std::vector<RateVerdict>* verdicts);

}  // namespace lodemark
