// Reading GLONASS and SBAS navigation records: a position, velocity and acceleration.
#pragma once

#include <cstdint>
#include <optional>

#include "core/gnss/ephemeris.h"
#include "core/logs/rinex_navigation_kepler.h"
#include "core/logs/rinex_navigation_text.h"

namespace lodemark {

inline constexpr int kStateLines = 4;        // without it, coordinates are missing
inline constexpr int kGlonassMostLines = 5;  // RINEX 3.05 and 4: status, delay, accuracy, health

// Fills *ephemeris from a whole record of RINEX 2, 3 or 4, whose epoch is toe_ns in UTC (GLONASS)
// or GPS time (SBAS). Returns what is wrong with it, if anything is.
std::optional<NavigationFault> ReadState(NavigationText* text, SatelliteId satellite,
                                         std::int64_t toe_ns, StateEphemeris* ephemeris);

}  // namespace lodemark
