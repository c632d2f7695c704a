// Do an epoch's ranges speak of another place than the one expected?
#pragma once

#include <span>

#include "core/fusion/observation.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/position_statement.h"

namespace lodemark {

// Whether it is worth asking them by themselves. point, verdicts: of the adjustment that heard what
// was expected.
bool LooksLost(const PositionStatement& expected, const PointEstimate& point,
               std::span<const ObservationVerdict> verdicts);

// Log of the density of their errors where an adjustment put the receiver. One verdict per range.
double LogLikelihood(std::span<const RangeObservation> ranges,
                     std::span<const ObservationVerdict> verdicts);

}  // namespace lodemark
