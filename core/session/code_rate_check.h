// Does each code range change as its Doppler says?
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/gnss/observation.h"

namespace lodemark {

// Compares the change of every code range since the epoch before with the change that Doppler
// predicts, after removing what all signals of a band have in common (receiver clocks step).
// Remembers measurements only, never positions.
class CodeRateCheck {
 public:
  // Disagreement of each signal in metres, signed; 0 where it cannot be told. One per signal of
  // the epoch, valid until the next call.
  const std::vector<double>& Update(const ObservationEpoch& epoch);
  void Forget() { past_.clear(); }

 private:
  struct Past {
    SatelliteId satellite;
    SignalCode signal;
    std::int64_t time_gps_ns = 0;
    double pseudorange_m = 0.0;
    double rate_mps = 0.0;
    int count = 1;
  };

  std::vector<Past> past_;
  std::vector<Past> present_;
  std::vector<double> disagreement_m_;
  std::vector<double> sorted_m_;
};

}  // namespace lodemark
