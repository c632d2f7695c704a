// What BeiDou's D1 and D2 navigation messages have in common, BDS-SIS-ICD-B1I version 3.0.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/navigation_message.h"

namespace lodemark {

// The 300 bits of a subframe, parity included, whose fields the ICD numbers from 1.
using BeidouSubframe = std::array<std::uint8_t, 38>;

// From ten words of 30 bits, each right-aligned in four bytes, deinterleaved as receivers give them
// or as they were sent. kTaken if the code of every word is
// good and the subframe begins as it must; else why not, and *subframe is untouched.
MessageVerdict ReadBeidouSubframe(std::span<const std::uint8_t> bytes, BeidouSubframe* subframe);

// Both of a subframe that was read.
std::uint64_t BeidouSubframeNumber(const BeidouSubframe& subframe);  // 1 to 5
std::int64_t BeidouSecondOfWeek(const BeidouSubframe& subframe);

// Accuracy of the index of ICD table 5-8, which follows GPS's.
double BeidouAccuracy(std::uint64_t index);

// Times of a set in BeiDou's own time, in nanoseconds since 1980.
struct BeidouSetTimes {
  std::int64_t sent_ns = 0;
  std::int64_t toc_ns = 0;
  std::int64_t toe_ns = 0;
};

// When a subframe was sent. week: modulo 8192.
std::int64_t BeidouTransmission(std::int64_t week, std::int64_t second_of_week,
                                std::int64_t received_gps_ns);

// Gives each set of a satellite once.
class BeidouSets {
 public:
  // e: all but its times. Nothing is given of a set that was the last one, or is implausible.
  void Give(KeplerEphemeris e, const BeidouSetTimes& times, const KlobucharParameters& ionosphere,
            std::vector<NavigationRecord>* records);

 private:
  std::int64_t given_toe_gps_ns_ = 0;
  std::int64_t given_toc_gps_ns_ = 0;
  std::int32_t given_health_ = -1;
};

}  // namespace lodemark
