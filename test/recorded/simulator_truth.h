// What a professional simulator's csv says of every satellite, by time of reception.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "core/gnss/signal.h"

namespace lodemark::test {

struct SimulatedSignalPath {
  std::array<double, 6> pseudorange_m = {};  // carriers of the groups A to F; 0: not sent
  std::array<double, 6> ionosphere_m = {};
  double troposphere_m = 0.0;
};

using SimulatorTruth = std::map<std::pair<std::int64_t, SatelliteId>, SimulatedSignalPath>;

// Of spirent_static_20230108. Empty if the file cannot be read.
SimulatorTruth ReadSimulatorTruth(const std::string& path);

}  // namespace lodemark::test
