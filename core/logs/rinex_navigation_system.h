// The records of RINEX 4 that are about a whole system: STO, EOP and ION.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/gnss/ephemeris.h"
#include "core/logs/rinex_navigation_kepler.h"
#include "core/logs/rinex_navigation_text.h"

namespace lodemark {

// Each fills its message from a whole record and returns what is wrong with it, if anything is.
// satellite is the sender, number 0 where the file does not say; time_ns is the record's epoch in
// the system's own scale.
std::optional<NavigationFault> ReadTimeOffset(NavigationText* text, SatelliteId satellite,
                                              std::int64_t time_ns, TimeOffsetMessage* message);
std::optional<NavigationFault> ReadEarthOrientation(NavigationText* text, SatelliteId satellite,
                                                    std::int64_t time_ns,
                                                    EarthOrientationMessage* message);
std::optional<NavigationFault> ReadIonosphere(NavigationText* text, SatelliteId satellite,
                                              std::string_view message_name, std::int64_t time_ns,
                                              IonosphereMessage* message);

// Whether RINEX 4.00 knows the ionosphere record of this system and message.
bool IsIonosphereMessage(System system, std::string_view message_name);

// Coefficients that a model could have been sent with.
bool IsPlausible(const KlobucharParameters& parameters);
bool IsPlausible(const GalileoIonosphereParameters& parameters);

}  // namespace lodemark
