#include "tools/lodemark/truth.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/logs/recording.h"

namespace lodemark {
namespace {

// Receiver clocks stray from the time the truth was sampled at by some milliseconds, so that the
// first or last epoch may lie just outside the track.
constexpr std::int64_t kEdge_ns = 5'000'000;

std::optional<TrajectoryPoint> NearestAtEdge(const Trajectory& track, std::int64_t time_gps_ns) {
  const auto& points = track.points();
  const auto later = std::lower_bound(
      points.begin(), points.end(), time_gps_ns - kEdge_ns,
      [](const TrajectoryPoint& point, std::int64_t time) { return point.time_gps_ns < time; });
  for (auto point = later; point != points.end(); ++point) {
    if (point->time_gps_ns > time_gps_ns + kEdge_ns) break;
    if (point->has_position()) return *point;
  }
  return std::nullopt;
}

}  // namespace

std::optional<TrajectoryPoint> Truth::At(std::int64_t time_gps_ns) const {
  std::optional<TrajectoryPoint> point = track.At(time_gps_ns);
  if (!point) point = NearestAtEdge(track, time_gps_ns);
  if (point && track.is_static()) point->velocity_enu_mps = {0.0, 0.0, 0.0};
  return point;
}

Result<Truth> ReadTruth(const std::string& path) {
  std::string file = path;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    const Result<Recording> recording = OpenRecording(path);
    if (!recording) return recording.error();
    const std::optional<std::string> found = recording->File("truth");
    if (!found) {
      return Error{ErrorCode::kIo, path + ": is a recording without truth; name a truth.csv"};
    }
    file = *found;
  }
  ReadReport report;
  Result<Trajectory> track = ReadTrajectory(file, &report);
  if (!track) return track.error();
  const auto& points = track->points();
  if (std::none_of(points.begin(), points.end(),
                   [](const TrajectoryPoint& point) { return point.has_position(); })) {
    return Error{ErrorCode::kBadData, file + ": holds no position; a truth needs at least one"};
  }
  return Truth{std::move(track).value(), std::move(report), std::move(file)};
}

}  // namespace lodemark
