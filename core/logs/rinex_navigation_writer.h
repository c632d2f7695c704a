// Writes RINEX 3.04 navigation files.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/gnss/ephemeris.h"

namespace lodemark {

struct RinexNavigationWriterOptions {
  std::string program = "lodemark";  // at most 20 characters each
  std::string run_by;
  std::string date;  // "20240624 104231 UTC"
};

struct RinexNavigationFile {
  std::string text;
  std::int64_t records_written = 0;
  // What version 3.04 has no place for: the CNAV family, earth orientation, BDGIM, offsets between
  // two systems that it does not list.
  std::int64_t records_left_out = 0;
};

// Ephemerides in the order given; of ionosphere models, time offsets and leap seconds the last of
// each kind, in the header. GLONASS satellites that only string 3 calls unhealthy are written with
// their Bn set, as there is no other way to say so.
RinexNavigationFile WriteRinexNavigation(std::span<const NavigationRecord> records,
                                         const RinexNavigationWriterOptions& options);

}  // namespace lodemark
