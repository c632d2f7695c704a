// SP3-c and SP3-d precise orbit files.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/gnss/precise_orbits.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

Result<PreciseOrbits> ReadSp3(LineReader* lines, ReadReport* report);
Result<PreciseOrbits> ReadSp3(const std::string& path, ReadReport* report);

}  // namespace lodemark
