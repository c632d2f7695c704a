#include "tools/lodemark/run_errors.h"

#include <algorithm>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

constexpr double kAnotherPlace_m = 50e3;

Geodetic GeodeticOf(double latitude_deg, double longitude_deg, double height_m) {
  return {latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, height_m};
}

EpochError ErrorOf(const RunEpoch& epoch, const TruthPoint& truth) {
  EpochError error;
  error.time_gps_ns = epoch.time_gps_ns;
  // Without a true height the horizontal error is taken at the estimate's own.
  const Geodetic place =
      GeodeticOf(truth.latitude_deg, truth.longitude_deg, truth.height_m.value_or(epoch.height_m));
  const Eigen::Vector3d enu_m = EnuFrame(place).FromEcef(
      EcefFromGeodetic(GeodeticOf(epoch.latitude_deg, epoch.longitude_deg, epoch.height_m)));
  error.east_m = enu_m.x();
  error.north_m = enu_m.y();
  if (truth.height_m) error.up_m = enu_m.z();
  if (epoch.velocity_enu_mps) {
    const auto& [east, north, up] = truth.velocity_enu_mps;
    const std::array<double, 3>& velocity = *epoch.velocity_enu_mps;
    if (east && north) {
      error.horizontal_velocity_mps = std::array{velocity[0] - *east, velocity[1] - *north};
    }
    if (up) error.up_velocity_mps = velocity[2] - *up;
  }
  error.accuracy_m = epoch.accuracy_m;
  error.protection_level_m = epoch.protection_level_m;
  error.vertical_protection_level_m = epoch.vertical_protection_level_m;
  if (epoch.horizontal_covariance_m2) {
    error.normalised =
        NormalisedHorizontalError(error.east_m, error.north_m, *epoch.horizontal_covariance_m2);
  } else if (epoch.accuracy_m) {
    error.normalised = NormalisedHorizontalError(error.east_m, error.north_m, *epoch.accuracy_m);
  }
  return error;
}

std::string SpanText(std::int64_t first_ns, std::int64_t last_ns) {
  return CalendarText(first_ns) + " to " + CalendarText(last_ns);
}

Error AnotherTime(const RunFolder& run, const TruthTrack& truth) {
  const auto [first, last] = std::minmax_element(
      run.epochs.begin(), run.epochs.end(),
      [](const RunEpoch& a, const RunEpoch& b) { return a.time_gps_ns < b.time_gps_ns; });
  return {ErrorCode::kBadData,
          truth.file() + ": is the truth of another time (" +
              SpanText(truth.points().front().time_gps_ns, truth.points().back().time_gps_ns) +
              " GPS time) than " + run.path + " (" +
              SpanText(first->time_gps_ns, last->time_gps_ns) +
              "); name the truth of the same recording"};
}

}  // namespace

Result<RunErrors> ErrorsAgainst(const RunFolder& run, const TruthTrack& truth) {
  RunErrors result;
  double nearest_m = -1.0;
  for (const RunEpoch& epoch : run.epochs) {
    const std::optional<TruthPoint> point = truth.At(epoch.time_gps_ns);
    if (!point) {
      ++result.epochs_without_truth;
      continue;
    }
    ++result.expected_epochs;
    if (!epoch.answered) continue;
    const Geodetic true_place = GeodeticOf(point->latitude_deg, point->longitude_deg,
                                           point->height_m.value_or(epoch.height_m));
    const Geodetic place = GeodeticOf(epoch.latitude_deg, epoch.longitude_deg, epoch.height_m);
    const double distance_m = (EcefFromGeodetic(place) - EcefFromGeodetic(true_place)).norm();
    if (nearest_m < 0.0 || distance_m < nearest_m) nearest_m = distance_m;
    result.errors.push_back(ErrorOf(epoch, *point));
  }
  if (result.expected_epochs == 0) return AnotherTime(run, truth);
  if (nearest_m > kAnotherPlace_m) {
    return Error{ErrorCode::kBadData,
                 truth.file() + ": is the truth of another place: the nearest estimate of " +
                     run.path + Format(" is %.0f km away; ", nearest_m / 1000.0) +
                     "name the truth of the same recording"};
  }
  return result;
}

}  // namespace lodemark
