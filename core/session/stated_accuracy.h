// The accuracies of an estimate, as its covariances say.
#pragma once

#include "core/session/session.h"

namespace lodemark {

// A place carried on by the motion alone is one while it is known so well.
inline constexpr double kWorstCoasted_m = 50.0;

// Of position and, where there is one, velocity.
void StateAccuracy(SessionEstimate* estimate);

}  // namespace lodemark
