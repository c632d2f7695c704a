// Where the receiver truly was: truth.csv of a recording, or one static point.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/logs/read_report.h"
#include "core/logs/trajectory.h"

namespace lodemark {

struct Truth {
  Trajectory track;
  ReadReport report;
  std::string file;

  // As Trajectory::At, but up to 5 ms beyond its ends the nearest point holds. A place at rest has
  // no velocity but zero.
  std::optional<TrajectoryPoint> At(std::int64_t time_gps_ns) const;
};

// Reads a truth.csv, or the one that a recording folder names or holds.
Result<Truth> ReadTruth(const std::string& path);

}  // namespace lodemark
