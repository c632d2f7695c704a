// How much of a signal's time of transmission an Android phone knows, and what travel times a
// satellite can have.
#pragma once

#include <cstdint>

#include "core/gnss/android_measurement.h"
#include "core/gnss/signal.h"

namespace lodemark {

// GnssMeasurement.STATE_*.
enum AndroidState : std::int32_t {
  kStateCodeLock = 1 << 0,
  kStateBitSync = 1 << 1,
  kStateSubframeSync = 1 << 2,
  kStateTowDecoded = 1 << 3,
  kStateMillisecondAmbiguous = 1 << 4,
  kStateSymbolSync = 1 << 5,
  kStateGlonassStringSync = 1 << 6,
  kStateGlonassTodDecoded = 1 << 7,
  kStateBeidouD2BitSync = 1 << 8,
  kStateBeidouD2SubframeSync = 1 << 9,
  kStateGalileoE1bcCodeLock = 1 << 10,
  kStateGalileoE1cSecondaryCodeLock = 1 << 11,
  kStateGalileoE1bPageSync = 1 << 12,
  kStateSbasSync = 1 << 13,
  kStateTowKnown = 1 << 14,
  kStateGlonassTodKnown = 1 << 15,
  kStateSecondaryCodeLock = 1 << 16,
};

// True if the phone tracks the code, so that the fraction below the code's period is measured.
bool HasCodeLock(std::int32_t state);

// The period modulo which getReceivedSvTimeNanos is known: a week, GLONASS a day, or what the
// synchronisation reached leaves (documentation of getReceivedSvTimeNanos), down to 1 ms. Where
// the state is open to two readings the shorter period is returned.
std::int64_t AmbiguityPeriodNanoseconds(std::int32_t state, System system, SignalCode signal);

// Travel times, without clock errors, that a satellite of the system can have seen from the
// ground or an aircraft.
struct TravelTimes {
  std::int64_t shortest_ns = 0;
  std::int64_t longest_ns = 0;
};
TravelTimes PossibleTravelTimes(System system);

// What the phone's reading of GPS time has to be reduced by to give the time that the system's
// satellites count (their week or day then starts at a multiple of it).
std::int64_t SystemTimeOffsetNanoseconds(System system, int leap_seconds);

}  // namespace lodemark
