// How far each satellite is believed to be in plain sight at each of many moments, from how its
// ranges fared before and after.
#pragma once

#include <span>
#include <vector>

#include "core/fusion/point_adjustment.h"
#include "core/session/heard_step.h"

namespace lodemark {

// Sigmas of the rates and changes of one moment, times this.
struct MomentSigmaFactors {
  std::vector<double> rates;
  std::vector<double> changes;
};

// verdicts: of each moment's ranges, or empty. What SatelliteTrust learns of the past alone.
std::vector<MomentSigmaFactors> SigmaFactorsAround(
    std::span<const HeardStep> moments, std::span<const std::vector<ObservationVerdict>> verdicts);

}  // namespace lodemark
