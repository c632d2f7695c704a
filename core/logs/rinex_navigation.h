// RINEX 2.10-2.12, 3.00-3.05 and 4.00-4.02 navigation files.
#pragma once

#include <functional>
#include <string>

#include "core/base/result.h"
#include "core/gnss/ephemeris.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

// Calls sink for every record of the file in order, header parameters (ionosphere, time offsets,
// leap seconds) first. Malformed records are counted in *report and skipped. Fails only if the file
// cannot be read or is no RINEX navigation file.
Status ReadRinexNavigation(LineReader* lines,
                           const std::function<void(const NavigationRecord&)>& sink,
                           ReadReport* report);
Status ReadRinexNavigation(const std::string& path,
                           const std::function<void(const NavigationRecord&)>& sink,
                           ReadReport* report);

}  // namespace lodemark
