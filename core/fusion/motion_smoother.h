// The way as it is known in the end: each state with what came after it, by the fixed-interval
// smoother of Rauch, Tung and Striebel (AIAA Journal 3(8), 1965).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace lodemark {

// By x, y, z earth-fixed: position, velocity, in metres and seconds.
using MotionVector = Eigen::Matrix<double, 6, 1>;
using MotionMatrix = Eigen::Matrix<double, 6, 6>;

struct MotionState {
  MotionVector mean = MotionVector::Zero();
  MotionMatrix covariance = MotionMatrix::Zero();
};

// One time update of a filter and what was heard after it.
struct MotionStep {
  bool begins = true;     // no way leads here from the step before; the next four say nothing
  MotionState before;     // the state of the step before, with what was heard on the way
  MotionState predicted;  // that of this step, likewise
  MotionMatrix gain = MotionMatrix::Zero();  // by which a change of predicted changes before
  MotionState filtered;                      // with what was heard at this step
};

// One state per step.
std::vector<MotionState> SmoothMotion(std::span<const MotionStep> steps);

}  // namespace lodemark
