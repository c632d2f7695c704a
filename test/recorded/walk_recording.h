// A walk in tight turns with a u-blox receiver and an inertial sensor in the hand.
#pragma once

#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/session/sensor_buffer.h"

namespace lodemark::test {

inline constexpr const char* kWalk = "drive/walk_boulder_20250828";

struct Walk {
  std::vector<ObservationEpoch> epochs;
  std::vector<NavigationRecord> navigation;
  std::vector<SensorSample> samples;  // by time, in GPS time
};

// Empty where the recording cannot be read.
Walk ReadWalk();

}  // namespace lodemark::test
