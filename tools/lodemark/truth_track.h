// Where the receiver truly was: truth.csv of a recording, or one static point.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/logs/read_report.h"

namespace lodemark {

struct TruthPoint {
  std::int64_t time_gps_ns = 0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  std::optional<double> height_m;
  // East, north, up; each may be unknown on its own.
  std::array<std::optional<double>, 3> velocity_enu_mps;
};

class TruthTrack {
 public:
  static constexpr std::int64_t kLongestGap_ns = 3'000'000'000;

  // The points need not be in order. One point is a place at rest, valid at all times. At least
  // one.
  explicit TruthTrack(std::vector<TruthPoint> points);

  // Reads a truth.csv, or the one that a recording folder names or holds.
  static Result<TruthTrack> Read(const std::string& path);

  // Linear between the neighbours; empty outside the track and inside a gap above 3 s.
  std::optional<TruthPoint> At(std::int64_t time_gps_ns) const;

  bool is_static() const { return points_.size() == 1; }
  const std::vector<TruthPoint>& points() const { return points_; }
  const std::string& file() const { return report_.file; }
  const ReadReport& report() const { return report_; }

 private:
  std::vector<TruthPoint> points_;  // ascending in time
  ReadReport report_;
};

}  // namespace lodemark
