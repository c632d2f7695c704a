// Recordings in RINEX run through a session, for tests that compare what comes out with a truth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/session/session.h"

namespace lodemark::test {

struct ReplayFiles {
  std::string observations;
  std::vector<std::string> navigation;
};

struct ReplayEdits {
  // Changes an epoch before the session sees it.
  std::function<void(ObservationEpoch*)> epoch;
  // Whether the session is given the record.
  std::function<bool(const NavigationRecord&)> takes;
};

// One estimate per epoch, fix or not. Empty if a file cannot be read.
std::vector<SessionEstimate> Replay(const ReplayFiles& files, const SessionOptions& options,
                                    const ReplayEdits& edits = {});

// Bits of SessionOptions::systems, from letters: "GEJ".
std::uint32_t SystemsOf(const std::string& letters);

// Keeps only the signals of the list, as in "G1C G2W".
void KeepSignals(const std::string& names, ObservationEpoch* epoch);
void DropSignals(const std::string& names, ObservationEpoch* epoch);

}  // namespace lodemark::test
