// How the receiver got from one moment to the next, by Doppler and carrier phase: whatever model of
// its motion said before, robustly adjusted.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/observation.h"

namespace lodemark {

// What one observation of a step was worth.
struct MotionVerdict {
  double residual = 0.0;  // m/s of a rate, m of a change
  double weight = 0.0;    // 0..1
};

struct MotionVerdicts {
  std::vector<MotionVerdict> rates;
  std::vector<MotionVerdict> changes;
  // False: too few of them fit one velocity, or one displacement, and none was used.
  bool rates_agree = false;
  bool changes_agree = false;
  // Of a rise, where there was one, in its expected variance.
  std::optional<double> rise_square;
};

// By x, y, z earth-fixed: the displacement since the moment before, in metres, and the velocity
// now, in metres a second.
using StepVector = Eigen::Matrix<double, 6, 1>;
using StepMatrix = Eigen::Matrix<double, 6, 6>;

struct StepKnowledge {
  StepVector mean = StepVector::Zero();
  StepMatrix covariance = StepMatrix::Identity();
  double clock_drift_mps = 0.0;  // of the receiver now
};

// rates: of now; changes: since the moment before. Kernels shrink from "everything counts" to a
// redescending one, so what contradicts the rest counts for little; where too few fit one velocity
// or one displacement none of them is used, and the scatter that is found widens what is stated.
// Without any that agree, known comes back as it is.
StepKnowledge AdjustStep(const StepKnowledge& known, std::span<const RangeRateObservation> rates,
                         std::span<const RangeChangeObservation> changes, MotionVerdicts* verdicts);

}  // namespace lodemark
