// The way of a filter once more, by one who knows how it went on: every epoch is judged by what
// all the others say of its place, those after it too.
#pragma once

#include <span>
#include <vector>

#include "core/fusion/motion_smoother.h"
#include "core/session/heard_step.h"

namespace lodemark {

// steps: those of the filter; heard: what it heard on each. Returns a state for each,
// smoothed. Expectation propagation (Minka, 2001) along the chain, an epoch's ranges being the
// factors that are no normal densities.
std::vector<MotionState> GoAgain(std::span<const MotionStep> steps,
                                 std::span<const HeardStep> heard);

}  // namespace lodemark
