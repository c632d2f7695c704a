// SP3-a, SP3-c and SP3-d precise orbit files.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/gnss/precise_orbits.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

// Positions and clocks of every satellite that SatelliteId can name; velocities and correlations
// are passed over. Malformed rows are counted in *report and skipped. Fails if the file cannot be
// read or is no SP3 file.
Result<PreciseOrbits> ReadSp3(LineReader* lines, ReadReport* report);
Result<PreciseOrbits> ReadSp3(const std::string& path, ReadReport* report);

}  // namespace lodemark
