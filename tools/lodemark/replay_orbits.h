// The orbits of a recording, pushed into a session before its measurements.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "tools/lodemark/replay_inputs.h"
#include "tools/lodemark/replay_session.h"

namespace lodemark {

// All navigation files and precise orbits, and what satellites broadcast into a u-blox file. Adds a
// sentence to *remarks for each with malformed records. Errors name the file and say what to do.
Status PushOrbits(const ReplayInputs& inputs, ReplaySession* session,
                  std::vector<std::string>* remarks);

}  // namespace lodemark
