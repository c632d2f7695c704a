// What the group delays that satellites broadcast do to the clock of one signal.
#pragma once

#include "core/gnss/ephemeris.h"
#include "core/gnss/signal.h"

namespace lodemark {

// What a satellite clock refers to: that of a broadcast message, or of precise products, which IGS
// refers to the ionosphere-free code combination of each system's two reference signals.
enum class ClockSource : std::uint8_t { kBroadcast, kPrecise };

// Seconds to add to the satellite clock to make it the clock of one signal. type is that of the
// message the clock came in (for precise clocks it does not matter). Delays that are missing count
// as zero or are replaced by the nearest thing known; the source says by which.
double GroupDelayCorrection(SatelliteId satellite, SignalCode signal, ClockSource source,
                            MessageType type, const GroupDelays& delays);

// The same for GLONASS: l2_delay_s is StateEphemeris::l2_delay_s.
double GlonassDelayCorrection(SignalCode signal, ClockSource source, double l2_delay_s);

// Takes from newer every delay it has and that can be one (finite, below a microsecond).
void UpdateGroupDelays(const GroupDelays& newer, GroupDelays* delays);

}  // namespace lodemark
