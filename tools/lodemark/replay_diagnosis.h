// Why a replay has no estimate, in one sentence that says what to do.
#pragma once

#include <string>

#include "tools/lodemark/replay_inputs.h"
#include "tools/lodemark/replay_measurements.h"
#include "tools/lodemark/replay_summary.h"

namespace lodemark {

// Of a replay without a single estimate. Reads the files of orbits again, for their dates.
std::string WhyNoEstimate(const ReplayInputs& inputs, const MeasurementCounts& counts,
                          const ReplaySummary& summary);

}  // namespace lodemark
