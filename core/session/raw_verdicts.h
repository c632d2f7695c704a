// What became of the raw measurements of a phone that gave no range.
#pragma once

#include <span>
#include <vector>

#include "core/gnss/android_measurement.h"
#include "core/gnss/android_observables.h"
#include "core/session/session.h"

namespace lodemark {

// One status per measurement whose satellite has a name and whose outcome is not good; of a signal
// reported twice only the first. Replaces *rangeless.
void CollectRangeless(const AndroidEpoch& epoch, std::span<const RawOutcome> outcomes,
                      const GlonassChannels& channels, std::vector<SatelliteStatus>* rangeless);

// Puts them among the statuses of an epoch's observations: a signal that is there without a range
// takes the verdict, others are appended. systems: bit i if System(i) is on.
void MergeRangeless(std::span<const SatelliteStatus> rangeless, std::uint32_t systems,
                    std::vector<SatelliteStatus>* statuses);

}  // namespace lodemark
