// Which of the two GLONASS satellites on one channel a phone hears.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/gnss/android_signal.h"
#include "core/gnss/satellite_orbits.h"

namespace lodemark {

// Of the slots that share a channel one is above the horizon at most; names those that are. For
// phones that give channels instead of slots.
void NameVisibleSlots(const SatelliteOrbits& orbits, std::int64_t time_gps_ns,
                      const Eigen::Vector3d& place_in_ecef, GlonassChannels* channels);

}  // namespace lodemark
