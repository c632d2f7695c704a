#include "tools/lodemark/report_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "tools/lodemark/compare_statistics.h"

namespace lodemark {
namespace {

constexpr std::int64_t kHalfStep_ns = 500'000'000;

Geodetic PlaceOf(const TrajectoryPoint& point, double height_m) {
  return {*point.latitude_deg * kRadiansPerDegree, *point.longitude_deg * kRadiansPerDegree,
          height_m};
}

std::optional<std::array<double, 2>> MiddleAndHigh(const std::vector<double>& errors) {
  if (errors.empty()) return std::nullopt;
  const Spread spread = SpreadOf(errors);
  return std::array{spread.p50, spread.p95};
}

}  // namespace

TruthVelocity::TruthVelocity(const Truth& truth) : truth_(truth) {
  const auto& points = truth.track.points();
  by_differences_ = !truth.track.is_static() &&
                    std::none_of(points.begin(), points.end(), [](const TrajectoryPoint& point) {
                      return point.velocity_enu_mps[0] && point.velocity_enu_mps[1];
                    });
}

std::optional<TruthVelocity::Velocity> TruthVelocity::At(std::int64_t time_gps_ns) const {
  if (!by_differences_) {
    const std::optional<TrajectoryPoint> point = truth_.At(time_gps_ns);
    if (!point || !point->velocity_enu_mps[0] || !point->velocity_enu_mps[1]) return std::nullopt;
    return Velocity{*point->velocity_enu_mps[0], *point->velocity_enu_mps[1],
                    point->velocity_enu_mps[2]};
  }
  const std::optional<TrajectoryPoint> before = truth_.track.At(time_gps_ns - kHalfStep_ns);
  const std::optional<TrajectoryPoint> after = truth_.track.At(time_gps_ns + kHalfStep_ns);
  if (!before || !after) return std::nullopt;
  const double height_m = before->height_m.value_or(0.0);
  const bool heights = before->height_m && after->height_m;
  const EnuFrame frame(PlaceOf(*before, height_m));
  const Eigen::Vector3d moved_m =
      frame.FromEcef(EcefFromGeodetic(PlaceOf(*after, heights ? *after->height_m : height_m)));
  const double per_second =
      0.5 * static_cast<double>(kSecond_ns) / static_cast<double>(kHalfStep_ns);
  Velocity velocity;
  velocity.east_mps = moved_m.x() * per_second;
  velocity.north_mps = moved_m.y() * per_second;
  if (heights) velocity.up_mps = moved_m.z() * per_second;
  return velocity;
}

void AddMotion(const TrajectoryPoint& epoch, ReportEpoch* drawn) {
  const auto& [east, north, up] = epoch.velocity_enu_mps;
  if (east && north) drawn->speed_mps = std::hypot(*east, *north);
  drawn->climb_mps = up;
  drawn->speed_accuracy_mps = epoch.speed_accuracy_mps;
  drawn->clock_bias_m = epoch.clock_bias_m;
  drawn->clock_drift_mps = epoch.clock_drift_mps;
  drawn->sources = epoch.sources;
}

void AddTruthSpeed(const TruthVelocity& truth, std::int64_t time_gps_ns, ReportTruthPoint* drawn) {
  const auto velocity = truth.At(time_gps_ns);
  if (!velocity) return;
  drawn->speed_mps = std::hypot(velocity->east_mps, velocity->north_mps);
  drawn->climb_mps = velocity->up_mps;
}

ReportVelocityErrors VelocityErrorsOf(const RunFolder& run, const TruthVelocity& truth) {
  std::vector<double> horizontal_mps, up_mps;
  Share within;
  for (const TrajectoryPoint& epoch : run.epochs) {
    const auto& [east, north, up] = epoch.velocity_enu_mps;
    if (!east || !north) continue;
    const auto velocity = truth.At(epoch.time_gps_ns);
    if (!velocity) continue;
    const double error_mps = std::hypot(*east - velocity->east_mps, *north - velocity->north_mps);
    horizontal_mps.push_back(error_mps);
    if (epoch.speed_accuracy_mps) within.Add(error_mps <= *epoch.speed_accuracy_mps);
    if (up && velocity->up_mps) up_mps.push_back(std::abs(*up - *velocity->up_mps));
  }
  ReportVelocityErrors errors;
  errors.horizontal_mps = MiddleAndHigh(horizontal_mps);
  errors.up_mps = MiddleAndHigh(up_mps);
  if (within.of > 0) errors.within_accuracy = within.value();
  return errors;
}

}  // namespace lodemark
