// Where a receiver was over time: truth.csv of a recording and trajectory.csv of a run, see
// docs/formats.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

// One row. What the file does not say is empty; a truth has little beyond the position.
struct TrajectoryPoint {
  std::int64_t time_gps_ns = 0;
  std::optional<double> latitude_deg;  // both or neither
  std::optional<double> longitude_deg;
  std::optional<double> height_m;                         // above the ellipsoid
  std::array<std::optional<double>, 3> velocity_enu_mps;  // east, north, up
  std::optional<double> accuracy_m;                       // 68 % radius
  std::optional<double> vertical_accuracy_m;              // 68 % half-width
  std::optional<double> speed_accuracy_mps;
  std::optional<double> protection_level_m;
  std::optional<double> vertical_protection_level_m;
  std::array<std::optional<double>, 6> covariance_enu_m2;  // ee en nn eu nu uu
  std::optional<double> clock_bias_m;
  std::optional<double> clock_drift_mps;
  std::string sources;
  std::optional<std::int32_t> satellites_used;
  std::optional<double> hdop;
  std::optional<double> vdop;
  std::string status;

  bool has_position() const { return latitude_deg.has_value() && longitude_deg.has_value(); }
};

class Trajectory {
 public:
  // Longer gaps are not bridged.
  static constexpr std::int64_t kLongestGap_ns = 3'000'000'000;

  // Puts the points in order of time; of two with the same time the first stays.
  explicit Trajectory(std::vector<TrajectoryPoint> points);

  const std::vector<TrajectoryPoint>& points() const { return points_; }

  // A single point with a position is a place at rest, valid at all times.
  bool is_static() const { return points_.size() == 1 && points_[0].has_position(); }

  // Position, height and velocity at a time, linear between the neighbouring points that have a
  // position. Empty before the first, after the last and inside a gap.
  std::optional<TrajectoryPoint> At(std::int64_t time_gps_ns) const;

 private:
  std::vector<TrajectoryPoint> points_;
  std::vector<std::size_t> positions_;  // indices of the points that have one
};

// Malformed rows are counted in *report and skipped. Fails if the file cannot be read, has no
// columns time_gps_ns, latitude_deg and longitude_deg, or no row.
Result<Trajectory> ReadTrajectory(LineReader* lines, ReadReport* report);
Result<Trajectory> ReadTrajectory(const std::string& path, ReadReport* report);

// The header line of trajectory.csv and its rows, each with its line end. A number that is not
// finite becomes an empty field.
std::string TrajectoryHeader();
void AppendTrajectoryRow(const TrajectoryPoint& point, std::string* text);

}  // namespace lodemark
