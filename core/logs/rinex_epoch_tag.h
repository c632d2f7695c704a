// The first line of an epoch in RINEX 2, 3 and 4 observation files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/geo/time.h"

namespace lodemark {

struct RinexEpochTag {
  // RINEX 2.11 table A2, RINEX 3.04 table A3: 0 good, 1 power failed since the epoch before, 2 to 5
  // events followed by header records, 6 repaired cycle slips.
  int flag = 0;
  int count = 0;  // of satellites or of header records that follow
  // Empty where an event leaves it out.
  std::optional<std::int64_t> time_gps_ns;
};

inline constexpr int kRinexPowerFailure = 1;
inline constexpr int kRinexFirstEvent = 2;
inline constexpr int kRinexLastEvent = 5;
inline constexpr int kRinexCycleSlips = 6;

// Where the satellite list starts in version 2.
inline constexpr std::size_t kRinex2SatelliteColumn = 32;
inline constexpr std::size_t kRinex2SatellitesPerLine = 12;

// Empty if the line is no epoch line, or if its date is outside 1980 to 2099. The scale is that of
// the file's clock.
std::optional<RinexEpochTag> ParseRinex2EpochTag(std::string_view line, TimeScale scale);
std::optional<RinexEpochTag> ParseRinex3EpochTag(std::string_view line, TimeScale scale);

// Whether a line of a version 2 file is laid out like an epoch line that bears a time; no line of
// observations is.
bool LooksLikeRinex2Epoch(std::string_view line);

}  // namespace lodemark
