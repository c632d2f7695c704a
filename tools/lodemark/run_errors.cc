#include "tools/lodemark/run_errors.h"

#include <array>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

constexpr double kAnotherPlace_m = 50e3;

// Only of a point with a position. Where it has no height, other_height_m is taken.
Geodetic PlaceOf(const TrajectoryPoint& point, double other_height_m) {
  return {*point.latitude_deg * kRadiansPerDegree, *point.longitude_deg * kRadiansPerDegree,
          point.height_m.value_or(other_height_m)};
}

EpochError ErrorOf(const TrajectoryPoint& epoch, const TrajectoryPoint& truth) {
  EpochError error;
  error.time_gps_ns = epoch.time_gps_ns;
  // Where one height is unknown the horizontal error is taken at the other.
  const Geodetic true_place = PlaceOf(truth, epoch.height_m.value_or(0.0));
  const Eigen::Vector3d enu_m =
      EnuFrame(true_place).FromEcef(EcefFromGeodetic(PlaceOf(epoch, true_place.height_m)));
  error.east_m = enu_m.x();
  error.north_m = enu_m.y();
  if (truth.height_m && epoch.height_m) error.up_m = enu_m.z();
  const auto& [east, north, up] = truth.velocity_enu_mps;
  const auto& velocity = epoch.velocity_enu_mps;
  if (east && north && velocity[0] && velocity[1]) {
    error.horizontal_velocity_mps = std::array{*velocity[0] - *east, *velocity[1] - *north};
  }
  if (up && velocity[2]) error.up_velocity_mps = *velocity[2] - *up;
  error.accuracy_m = epoch.accuracy_m;
  error.protection_level_m = epoch.protection_level_m;
  error.vertical_protection_level_m = epoch.vertical_protection_level_m;
  const auto& covariance = epoch.covariance_enu_m2;
  if (covariance[0] && covariance[1] && covariance[2]) {
    error.normalised = NormalisedHorizontalError(error.east_m, error.north_m,
                                                 {*covariance[0], *covariance[1], *covariance[2]});
  } else if (epoch.accuracy_m) {
    error.normalised = NormalisedHorizontalError(error.east_m, error.north_m, *epoch.accuracy_m);
  }
  if (error.up_m && covariance[0] && covariance[1] && covariance[2] && covariance[3] &&
      covariance[4] && covariance[5]) {
    error.nees = NormalisedSquaredError({error.east_m, error.north_m, *error.up_m},
                                        {*covariance[0], *covariance[1], *covariance[2],
                                         *covariance[3], *covariance[4], *covariance[5]});
  }
  return error;
}

std::string SpanText(std::int64_t first_ns, std::int64_t last_ns) {
  return CalendarText(first_ns) + " to " + CalendarText(last_ns);
}

Error AnotherTime(const RunFolder& run, const Truth& truth) {
  const auto& points = truth.track.points();
  return {ErrorCode::kBadData,
          truth.file + ": is the truth of another time (" +
              SpanText(points.front().time_gps_ns, points.back().time_gps_ns) + " GPS time) than " +
              run.path + " (" +
              SpanText(run.epochs.front().time_gps_ns, run.epochs.back().time_gps_ns) +
              "); name the truth of the same recording"};
}

}  // namespace

Result<RunErrors> ErrorsAgainst(const RunFolder& run, const Truth& truth) {
  RunErrors result;
  double nearest_m = -1.0;
  for (const TrajectoryPoint& epoch : run.epochs) {
    const std::optional<TrajectoryPoint> point = truth.At(epoch.time_gps_ns);
    if (!point) {
      ++result.epochs_without_truth;
      continue;
    }
    ++result.expected_epochs;
    if (!epoch.has_position()) continue;
    const Geodetic true_place = PlaceOf(*point, epoch.height_m.value_or(0.0));
    const Geodetic place = PlaceOf(epoch, true_place.height_m);
    const double distance_m = (EcefFromGeodetic(place) - EcefFromGeodetic(true_place)).norm();
    if (nearest_m < 0.0 || distance_m < nearest_m) nearest_m = distance_m;
    result.errors.push_back(ErrorOf(epoch, *point));
  }
  if (result.expected_epochs == 0) return AnotherTime(run, truth);
  if (nearest_m > kAnotherPlace_m) {
    return Error{ErrorCode::kBadData,
                 truth.file + ": is the truth of another place: the nearest estimate of " +
                     run.path + Format(" is %.0f km away; ", nearest_m / 1000.0) +
                     "name the truth of the same recording"};
  }
  return result;
}

}  // namespace lodemark
