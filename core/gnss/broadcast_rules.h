// What the interface documents say about broadcast parameters beyond their values: which health
// bits mean healthy, what an accuracy index is worth, and which orbits cannot be.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/gnss/ephemeris.h"

namespace lodemark {

// Whether the bits, arranged as RINEX 4.00 does (tables A7 to A32), allow the signals the message
// is for to be used. Galileo, I/NAV: E1-B; F/NAV: E5a.
bool IsHealthy(System system, MessageType type, std::int32_t health);

// 1 sigma in metres of a user range accuracy index (IS-GPS-200N 20.3.3.3.1.3, and 30.3.3.1.1.4 for
// the indices below zero). Empty where no prediction is made: 15 and more, -16 and less.
std::optional<double> UserRangeAccuracy(int index);

// Galileo's signal-in-space accuracy (OS SIS ICD 2.1, 5.1.12). Empty for the spare indices and for
// 255, no accuracy prediction available.
std::optional<double> GalileoSignalAccuracy(int index);

// GLONASS word F_T (ICD L1, L2 edition 5.1, table 4.4). Empty for 15.
std::optional<double> GlonassAccuracy(int index);

// BeiDou's geostationary satellites, which send D2 (BDS-SIS-ICD-B1I 3.0, 5.1 and 4.1).
bool IsBeidouGeostationary(SatelliteId satellite);

// Hours of validity that a GPS issue of data, clock, stands for when the fit interval flag is set
// (IS-GPS-200N table 20-XII).
double GpsFitInterval(bool flag, int issue_of_clock);

// Names the first element that no working satellite can have, as in "eccentricity"; empty if all
// could be.
std::string_view ImplausibleElement(const KeplerEphemeris& ephemeris);
std::string_view ImplausibleElement(const StateEphemeris& ephemeris);

}  // namespace lodemark
