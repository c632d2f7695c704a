#include "core/fusion/motion_smoother.h"

namespace lodemark {

std::vector<MotionState> SmoothMotion(std::span<const MotionStep> steps) {
  std::vector<MotionState> smoothed(steps.size());
  for (std::size_t i = steps.size(); i-- > 0;) {
    if (i + 1 == steps.size() || steps[i + 1].begins) {
      smoothed[i] = steps[i].filtered;
      continue;
    }
    const MotionStep& next = steps[i + 1];
    const MotionState& after = smoothed[i + 1];
    smoothed[i].mean = next.before.mean + next.gain * (after.mean - next.predicted.mean);
    const MotionMatrix covariance =
        next.before.covariance +
        next.gain * (after.covariance - next.predicted.covariance) * next.gain.transpose();
    smoothed[i].covariance = 0.5 * (covariance + covariance.transpose());
  }
  return smoothed;
}

}  // namespace lodemark
