// A scene solved by the point adjustment, for the tests of fusion.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/fusion/point_adjustment.h"
#include "test/unit/fusion/range_scene.h"

namespace lodemark {

struct Adjusted {
  PointStatus status = PointStatus::kTooFew;
  PointEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
};

inline Adjusted Adjust(const RangeScene& scene, const Eigen::Vector3d& start_in_ecef,
                       const ClockBiases& biases = ClockBiases(),
                       const PointOptions& options = PointOptions()) {
  PointAdjustment adjustment;
  Adjusted adjusted;
  adjusted.status = adjustment.Solve(scene.ranges, start_in_ecef, biases, options,
                                     &adjusted.estimate, &adjusted.verdicts);
  return adjusted;
}

// From a start a kilometre away.
inline Adjusted Adjust(const RangeScene& scene, const ClockBiases& biases = ClockBiases(),
                       const PointOptions& options = PointOptions()) {
  return Adjust(scene, scene.Beside({700.0, -600.0, 400.0}), biases, options);
}

inline double DistanceFromTruth(const RangeScene& scene, const Adjusted& adjusted) {
  return (adjusted.estimate.position_in_ecef - scene.truth_in_ecef).norm();
}

}  // namespace lodemark
