// Whoever can say how likely a satellite is in plain sight.
#pragma once

#include <optional>

#include "core/geo/geodetic.h"
#include "core/gnss/signal.h"

namespace lodemark {

class SightSource {
 public:
  virtual ~SightSource() = default;

  // That the straight path is free, 0 .. 1; nothing where nothing is known. What it says must not
  // rest on the measurements that it helps to weigh.
  virtual std::optional<double> ProbabilityOfSight(SatelliteId satellite, const LookAngles& look,
                                                   double wavelength_m) = 0;
};

}  // namespace lodemark
