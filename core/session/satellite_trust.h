// How far each satellite is believed to be in plain sight, from how its ranges fared lately.
#pragma once

#include <span>
#include <vector>

#include "core/fusion/point_adjustment.h"
#include "core/session/gnss_epoch.h"

namespace lodemark {

// Of a satellite nobody has heard of yet.
inline constexpr double kUnknownTrust = 0.5;
// Streets come and go within seconds.
inline constexpr double kTrustMemory_s = 2.0;

// In the rate and phase of a satellite, 0..1, by how one of its ranges fared.
double TrustIn(const ObservationVerdict& verdict);
// How many times their stated sigma they have then.
double SigmaFactorOfTrust(double trust);

// The Doppler and the phase of a reflected signal are those of the reflection: they are worth what
// the code range of the satellite was worth in the moments before.
class SatelliteTrust {
 public:
  // How many times their stated sigma rates and phases of a satellite have.
  double SigmaFactor(SatelliteId satellite) const;

  void Learn(double seconds, std::span<const RangeSource> sources,
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
