// How much of each range's error shows in its residual.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"
#include "core/fusion/point_adjustment.h"

namespace lodemark {

// Redundancy numbers of the ranges of one position, each weighted by its sigma and verdict; the
// biases are what was known before. Of ranges whose weight is hardly any: 1. False if the ranges
// fix no position.
bool RedundancyNumbers(std::span<const RangeObservation> ranges,
                       std::span<const ObservationVerdict> verdicts,
                       const Eigen::Vector3d& place_in_ecef, const ClockBiases& biases,
                       std::vector<double>* numbers);

}  // namespace lodemark
