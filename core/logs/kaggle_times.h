// Times of a Kaggle measurement file made whole again with its pseudoranges.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/gnss/android_measurement.h"
#include "core/logs/kaggle_row.h"

namespace lodemark {

// Time of reception by the receiver's clock that agrees with most of the pseudoranges and times of
// transmission: the median over the measurements. Whole times of transmission count first, then
// times of week in GPS time next to near_gps_ns, then those that lost their digits. Empty if no
// measurement gives any.
std::optional<std::int64_t> ReceptionFromRanges(const std::vector<AndroidMeasurement>& measurements,
                                                const std::vector<TransmitTime>& transmissions,
                                                std::optional<std::int64_t> near_gps_ns);

// ReceivedSvTimeNanos of a signal sent at the given time, in the scale of its constellation and
// modulo its week, or day for GLONASS.
std::int64_t ReceivedSvTime(std::int32_t constellation_type, std::int64_t sent_gps_ns);

// When a signal with this pseudorange was sent, if it came at reception_gps_ns.
std::int64_t SentBefore(std::int64_t reception_gps_ns, const AndroidMeasurement& measurement);

}  // namespace lodemark
