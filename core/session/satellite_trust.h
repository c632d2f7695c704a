// How far each satellite is believed to be in plain sight, from how its ranges fared lately.
#pragma once

#include <span>
#include <vector>

#include "core/fusion/point_adjustment.h"
#include "core/session/gnss_epoch.h"

namespace lodemark {

// The Doppler and the phase of a reflected signal are those of the reflection: they are worth what
// the code range of the satellite was worth in the moments before.
class SatelliteTrust {
 public:
  // How many times their stated sigma rates and phases of a satellite have.
  double SigmaFactor(SatelliteId satellite) const;

  void Learn(double seconds, const std::vector<PreparedSignal>& signals,
             std::span<const ObservationVerdict> verdicts);
  void Forget() { satellites_.clear(); }

 private:
  struct Record {
    SatelliteId satellite;
    double trust = 0.0;  // 0..1
    double heard = 0.0;  // of this epoch: sum of the weights of its ranges
    int ranges = 0;
  };
  std::vector<Record> satellites_;
};

}  // namespace lodemark
