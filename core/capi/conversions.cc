#include <Eigen/Core>

#include "core/base/units.h"
#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/geo/geodetic.h"
#include "core/geo/time.h"

namespace lodemark {
namespace {

// 1970-01-01 to 1980-01-06: ten years, two of them leap years, and five days.
constexpr std::int64_t kUnixOfGpsEpoch_ns = (10 * 365 + 2 + 5) * kDay_ns;
// 2100-01-01 on either scale.
constexpr std::int64_t kEndOfTimes_ns = 43'825 * kDay_ns;

lodemark_status ReadPoint(const double* values, const char* name, Eigen::Vector3d* point) {
  if (values == nullptr) return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name}, "", "is NULL");
  double copy[3];
  std::memcpy(copy, values, sizeof copy);
  Check check({name});
  check.Point(copy, "");
  *point = {copy[0], copy[1], copy[2]};
  return check.status();
}

lodemark_status ReadGeodetic(const double* values, const char* name, Geodetic* place) {
  if (values == nullptr) return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name}, "", "is NULL");
  double copy[3];
  std::memcpy(copy, values, sizeof copy);
  Check check({name});
  check.Within(copy[0], -90.0, 90.0, "latitude");
  check.Within(copy[1], -360.0, 360.0, "longitude");
  check.Within(copy[2], -kLargestLength_m, kLargestLength_m, "height");
  *place = {copy[0] * kRadiansPerDegree, copy[1] * kRadiansPerDegree, copy[2]};
  return check.status();
}

lodemark_status CheckOutput(const void* out, const char* name) {
  if (out == nullptr) return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name}, "", "is NULL");
  return LODEMARK_OK;
}

void WritePoint(const Eigen::Vector3d& point, double* out) {
  std::memcpy(out, point.data(), 3 * sizeof(double));
}

lodemark_status CheckInstant(std::int64_t since_1980_ns, const char* name) {
  Check check({name});
  check.True(since_1980_ns >= 0 && since_1980_ns < kEndOfTimes_ns, "",
             "is outside the years 1980 to 2099");
  return check.status();
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_ecef_from_geodetic(const double geodetic[3], double ecef_m[3]) {
  using namespace lodemark;
  return Guard([&] {
    Geodetic place;
    lodemark_status status = ReadGeodetic(geodetic, "geodetic", &place);
    if (status == LODEMARK_OK) status = CheckOutput(ecef_m, "ecef_m");
    if (status == LODEMARK_OK) WritePoint(EcefFromGeodetic(place), ecef_m);
    return status;
  });
}

lodemark_status lodemark_geodetic_from_ecef(const double ecef_m[3], double geodetic[3]) {
  using namespace lodemark;
  return Guard([&] {
    Eigen::Vector3d point;
    lodemark_status status = ReadPoint(ecef_m, "ecef_m", &point);
    if (status == LODEMARK_OK) status = CheckOutput(geodetic, "geodetic");
    if (status != LODEMARK_OK) return status;
    const Geodetic place = GeodeticFromEcef(point);
    WritePoint({place.latitude_rad * kDegreesPerRadian, place.longitude_rad * kDegreesPerRadian,
                place.height_m},
               geodetic);
    return status;
  });
}

lodemark_status lodemark_enu_from_ecef(const double origin_geodetic[3], const double ecef_m[3],
                                       double enu_m[3]) {
  using namespace lodemark;
  return Guard([&] {
    Geodetic origin;
    Eigen::Vector3d point;
    lodemark_status status = ReadGeodetic(origin_geodetic, "origin_geodetic", &origin);
    if (status == LODEMARK_OK) status = ReadPoint(ecef_m, "ecef_m", &point);
    if (status == LODEMARK_OK) status = CheckOutput(enu_m, "enu_m");
    if (status == LODEMARK_OK) WritePoint(EnuFrame(origin).FromEcef(point), enu_m);
    return status;
  });
}

lodemark_status lodemark_ecef_from_enu(const double origin_geodetic[3], const double enu_m[3],
                                       double ecef_m[3]) {
  using namespace lodemark;
  return Guard([&] {
    Geodetic origin;
    Eigen::Vector3d point;
    lodemark_status status = ReadGeodetic(origin_geodetic, "origin_geodetic", &origin);
    if (status == LODEMARK_OK) status = ReadPoint(enu_m, "enu_m", &point);
    if (status == LODEMARK_OK) status = CheckOutput(ecef_m, "ecef_m");
    if (status == LODEMARK_OK) WritePoint(EnuFrame(origin).ToEcef(point), ecef_m);
    return status;
  });
}

lodemark_status lodemark_unix_from_gps(int64_t time_gps_ns, int64_t* time_unix_ns) {
  using namespace lodemark;
  return Guard([&] {
    lodemark_status status = CheckInstant(time_gps_ns, "time_gps_ns");
    if (status == LODEMARK_OK) status = CheckOutput(time_unix_ns, "time_unix_ns");
    if (status != LODEMARK_OK) return status;
    const std::int64_t result = ScaleFromGps(time_gps_ns, TimeScale::kUtc) + kUnixOfGpsEpoch_ns;
    std::memcpy(time_unix_ns, &result, sizeof result);
    return status;
  });
}

lodemark_status lodemark_gps_from_unix(int64_t time_unix_ns, int64_t* time_gps_ns) {
  using namespace lodemark;
  return Guard([&] {
    const bool early = time_unix_ns < kUnixOfGpsEpoch_ns;  // or the difference might overflow
    const std::int64_t time_utc_ns = early ? -1 : time_unix_ns - kUnixOfGpsEpoch_ns;
    lodemark_status status = CheckInstant(time_utc_ns, "time_unix_ns");
    if (status == LODEMARK_OK) status = CheckOutput(time_gps_ns, "time_gps_ns");
    if (status != LODEMARK_OK) return status;
    const std::int64_t result = GpsFromScale(time_utc_ns, TimeScale::kUtc);
    std::memcpy(time_gps_ns, &result, sizeof result);
    return status;
  });
}
