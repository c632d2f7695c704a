// What a session has found out.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/base/units.h"
#include "core/capi/guard.h"
#include "core/capi/session_handle.h"
#include "core/capi/structs.h"
#include "core/session/accuracy.h"

namespace lodemark {
namespace {

// By EstimateStatus.
constexpr std::int32_t kOutcomes[] = {
    LODEMARK_OUTCOME_FIX,          LODEMARK_OUTCOME_NO_DATA,       LODEMARK_OUTCOME_TOO_FEW,
    LODEMARK_OUTCOME_NO_EPHEMERIS, LODEMARK_OUTCOME_NOT_CONVERGED, LODEMARK_OUTCOME_INCONSISTENT};
static_assert(static_cast<int>(EstimateStatus::kFix) == 0);
static_assert(static_cast<int>(EstimateStatus::kNoData) == 1);
static_assert(static_cast<int>(EstimateStatus::kTooFewSatellites) == 2);
static_assert(static_cast<int>(EstimateStatus::kNoEphemeris) == 3);
static_assert(static_cast<int>(EstimateStatus::kNotConverged) == 4);
static_assert(static_cast<int>(EstimateStatus::kInconsistent) == 5);

static_assert(LODEMARK_VERDICT_USED == static_cast<int>(SatelliteVerdict::kUsed));
static_assert(LODEMARK_VERDICT_DOWN_WEIGHTED == static_cast<int>(SatelliteVerdict::kDownWeighted));
static_assert(LODEMARK_VERDICT_NO_EPHEMERIS == static_cast<int>(SatelliteVerdict::kNoEphemeris));
static_assert(LODEMARK_VERDICT_EPHEMERIS_TOO_OLD ==
              static_cast<int>(SatelliteVerdict::kEphemerisTooOld));
static_assert(LODEMARK_VERDICT_UNHEALTHY == static_cast<int>(SatelliteVerdict::kUnhealthy));
static_assert(LODEMARK_VERDICT_LOW_ELEVATION == static_cast<int>(SatelliteVerdict::kLowElevation));
static_assert(LODEMARK_VERDICT_WEAK_SIGNAL == static_cast<int>(SatelliteVerdict::kWeakSignal));
static_assert(LODEMARK_VERDICT_NOT_TRACKING == static_cast<int>(SatelliteVerdict::kNotTracking));
static_assert(LODEMARK_VERDICT_TIME_AMBIGUOUS ==
              static_cast<int>(SatelliteVerdict::kTimeAmbiguous));
static_assert(LODEMARK_VERDICT_IMPLAUSIBLE == static_cast<int>(SatelliteVerdict::kImplausible));
static_assert(LODEMARK_VERDICT_OUTLIER == static_cast<int>(SatelliteVerdict::kOutlier));
static_assert(LODEMARK_VERDICT_SYSTEM_OFF == static_cast<int>(SatelliteVerdict::kSystemOff));
static_assert(LODEMARK_VERDICT_UNKNOWN_SIGNAL ==
              static_cast<int>(SatelliteVerdict::kUnknownSignal));
static_assert(LODEMARK_VERDICT_UNOBSERVABLE == static_cast<int>(SatelliteVerdict::kUnobservable));

static_assert(LODEMARK_EVENT_CLOCK_DISCONTINUITY ==
              static_cast<int>(EventKind::kClockDiscontinuity));
static_assert(LODEMARK_EVENT_MILLISECOND_JUMP == static_cast<int>(EventKind::kMillisecondJump));
static_assert(LODEMARK_EVENT_TIME_BACKWARDS == static_cast<int>(EventKind::kTimeBackwards));
static_assert(LODEMARK_EVENT_DUPLICATE_EPOCH == static_cast<int>(EventKind::kDuplicateEpoch));
static_assert(LODEMARK_EVENT_FIRST_FIX == static_cast<int>(EventKind::kFirstFix));
static_assert(LODEMARK_EVENT_FIX_LOST == static_cast<int>(EventKind::kFixLost));
static_assert(LODEMARK_EVENT_EPHEMERIS_MISSING == static_cast<int>(EventKind::kEphemerisMissing));

static_assert(LODEMARK_EVENT_PHOTO_CONTRADICTED == static_cast<int>(EventKind::kPhotoContradicted));
static_assert(LODEMARK_EVENT_PHOTO_FAILED == static_cast<int>(EventKind::kPhotoFailed));
static_assert(LODEMARK_EVENT_MAP_DATUM == static_cast<int>(EventKind::kMapDatum));
static_assert(LODEMARK_EVENT_SENSOR_DROPPED == static_cast<int>(EventKind::kSensorDropped));
static_assert(LODEMARK_EVENT_FILTER_RESTARTED == static_cast<int>(EventKind::kFilterRestarted));
static_assert(LODEMARK_EVENT_INERTIAL_ALIGNED == static_cast<int>(EventKind::kInertialAligned));
static_assert(LODEMARK_EVENT_INERTIAL_LOST == static_cast<int>(EventKind::kInertialLost));
static_assert(LODEMARK_EVENT_PHOTO_TOO_LATE == static_cast<int>(EventKind::kPhotoTooLate));

static_assert(LODEMARK_PHOTO_NONE == static_cast<int>(PhotoOutcome::kNone));
static_assert(LODEMARK_PHOTO_USED == static_cast<int>(PhotoOutcome::kUsed));
static_assert(LODEMARK_PHOTO_NOT_RECOGNISED == static_cast<int>(PhotoOutcome::kNotRecognised));
static_assert(LODEMARK_PHOTO_DISAGREEING == static_cast<int>(PhotoOutcome::kDisagreeing));
static_assert(LODEMARK_PHOTO_CONTRADICTED == static_cast<int>(PhotoOutcome::kContradicted));
static_assert(LODEMARK_SOURCE_GNSS == kSourceGnss && LODEMARK_SOURCE_VISION == kSourceVision &&
              LODEMARK_SOURCE_INERTIAL == kSourceInertial);

// By LandmarkVerdict.
constexpr std::int32_t kLandmarkVerdicts[] = {LODEMARK_VERDICT_USED, LODEMARK_VERDICT_DOWN_WEIGHTED,
                                              LODEMARK_VERDICT_OUTLIER,
                                              LODEMARK_VERDICT_PHOTO_NOT_USED};
static_assert(static_cast<int>(LandmarkVerdict::kUsed) == 0);
static_assert(static_cast<int>(LandmarkVerdict::kDownWeighted) == 1);
static_assert(static_cast<int>(LandmarkVerdict::kOutlier) == 2);
static_assert(static_cast<int>(LandmarkVerdict::kNotUsed) == 3);

void Copy(const Eigen::Vector3d& from, double (&to)[3]) { std::memcpy(to, from.data(), sizeof to); }

// A covariance is symmetric, so its columns are its rows.
void Copy(const Eigen::Matrix3d& from, double (&to)[9]) { std::memcpy(to, from.data(), sizeof to); }

lodemark_estimate ToC(const SessionEstimate& from) {
  lodemark_estimate to = {};
  to.outcome = kOutcomes[static_cast<std::size_t>(from.status)];
  to.satellites_used = from.satellites_used;
  to.satellites_seen = from.satellites_seen;
  to.time_ns = from.time_ns;
  if (from.time_gps_ns != 0) {
    to.present |= LODEMARK_ESTIMATE_HAS_GPS_TIME;
    to.time_gps_ns = from.time_gps_ns;
  }
  to.photo = static_cast<std::int32_t>(from.photo);
  to.landmarks_used = from.landmarks_used;
  to.landmarks_seen = from.landmarks_seen;
  if (from.status != EstimateStatus::kFix) return to;

  to.present |= LODEMARK_ESTIMATE_HAS_POSITION;
  to.sources = from.sources;
  Copy(from.position_in_ecef, to.ecef_m);
  to.latitude_deg = from.position.latitude_rad * kDegreesPerRadian;
  to.longitude_deg = from.position.longitude_rad * kDegreesPerRadian;
  to.height_m = from.position.height_m;
  Copy(from.covariance_enu_m2, to.covariance_enu_m2);
  to.accuracy_m = from.accuracy_m;
  to.vertical_accuracy_m = from.vertical_accuracy_m;
  to.clock_bias_m = from.clock_bias_m;
  to.pdop = from.pdop;
  to.hdop = from.hdop;
  to.vdop = from.vdop;
  to.tdop = from.tdop;
  if (from.has_velocity) {
    to.present |= LODEMARK_ESTIMATE_HAS_VELOCITY;
    Copy(from.velocity_enu_mps, to.velocity_enu_mps);
    Copy(from.velocity_covariance_enu_m2ps2, to.velocity_covariance_enu_m2ps2);
    to.speed_accuracy_mps = from.speed_accuracy_mps;
    to.clock_drift_mps = from.clock_drift_mps;
  }
  if (from.protection_level_m > 0.0) {
    to.present |= LODEMARK_ESTIMATE_HAS_PROTECTION_LEVEL;
    to.protection_level_m = from.protection_level_m;
  }
  if (from.vertical_protection_level_m > 0.0) {
    to.present |= LODEMARK_ESTIMATE_HAS_VERTICAL_PROTECTION_LEVEL;
    to.vertical_protection_level_m = from.vertical_protection_level_m;
  }
  if (from.satellite_sigma_factor > 0.0) {
    to.present |= LODEMARK_ESTIMATE_HAS_SATELLITE_SIGMA_FACTOR;
    to.satellite_sigma_factor = from.satellite_sigma_factor;
  }
  if (from.landmark_sigma_factor > 0.0) {
    to.present |= LODEMARK_ESTIMATE_HAS_LANDMARK_SIGMA_FACTOR;
    to.landmark_sigma_factor = from.landmark_sigma_factor;
  }
  if (from.has_orientation) {
    to.present |= LODEMARK_ESTIMATE_HAS_ORIENTATION;
    const Eigen::Quaterniond& rotation = from.camera_from_enu;
    const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
    to.camera_from_enu[0] = sign * rotation.w();
    to.camera_from_enu[1] = sign * rotation.x();
    to.camera_from_enu[2] = sign * rotation.y();
    to.camera_from_enu[3] = sign * rotation.z();
  }
  if (from.attitude) {
    to.present |= LODEMARK_ESTIMATE_HAS_ATTITUDE;
    const Eigen::Quaterniond& rotation = from.attitude->device_from_enu;
    const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
    to.device_from_enu[0] = sign * rotation.w();
    to.device_from_enu[1] = sign * rotation.x();
    to.device_from_enu[2] = sign * rotation.y();
    to.device_from_enu[3] = sign * rotation.z();
    const Eigen::Matrix3d covariance_deg2 =
        kDegreesPerRadian * kDegreesPerRadian * from.attitude->covariance_enu_rad2;
    Copy(covariance_deg2, to.attitude_covariance_enu_deg2);
    to.heading_accuracy_deg = kHalfWidth68 * std::sqrt(covariance_deg2(2, 2));
  }
  return to;
}

lodemark_landmark ToC(const LandmarkStatus& from) {
  lodemark_landmark to = {};
  to.landmark_id = from.landmark_id;
  to.verdict = kLandmarkVerdicts[static_cast<std::size_t>(from.verdict)];
  std::memcpy(to.pixel_px, from.pixel.data(), sizeof to.pixel_px);
  to.weight = from.weight;
  Copy(from.landmark_in_ecef, to.landmark_in_ecef_m);
  if (from.has_residual) {
    to.present |= LODEMARK_LANDMARK_HAS_RESIDUAL;
    std::memcpy(to.residual_px, from.residual_px.data(), sizeof to.residual_px);
    to.range_m = from.range_m;
    to.range_sigma_m = from.range_sigma_m;
  }
  return to;
}

lodemark_satellite ToC(const SatelliteStatus& from) {
  lodemark_satellite to = {};
  to.system = static_cast<std::int32_t>(from.satellite.system);
  to.satellite = from.satellite.number;
  to.verdict = static_cast<std::int32_t>(from.verdict);
  if (from.signal.band != ' ') to.signal[0] = from.signal.band;
  if (from.signal.attribute != ' ') to.signal[1] = from.signal.attribute;
  to.weight = from.weight;
  if (from.has_residual) {
    to.present |= LODEMARK_SATELLITE_HAS_RESIDUAL;
    to.residual_m = from.residual_m;
    to.sigma_m = from.sigma_m;
  }
  if (from.has_direction) {
    to.present |= LODEMARK_SATELLITE_HAS_DIRECTION;
    to.elevation_deg = from.elevation_rad * kDegreesPerRadian;
    to.azimuth_deg = from.azimuth_rad * kDegreesPerRadian;
  }
  if (from.has_rate_residual) {
    to.present |= LODEMARK_SATELLITE_HAS_RANGE_RATE_RESIDUAL;
    to.range_rate_residual_mps = from.range_rate_residual_mps;
  }
  if (from.has_sight) {
    to.present |= LODEMARK_SATELLITE_HAS_SIGHT;
    to.sight_probability = from.sight_probability;
  }
  if (from.cn0_dbhz != 0.0) {
    to.present |= LODEMARK_SATELLITE_HAS_CN0;
    to.cn0_dbhz = from.cn0_dbhz;
  }
  return to;
}

lodemark_event ToC(const SessionEvent& from) {
  lodemark_event to = {};
  to.kind = static_cast<std::int32_t>(from.kind);
  to.time_ns = from.time_ns;
  to.time_gps_ns = from.time_gps_ns;
  to.value = from.value;
  CopyText(from.text.data(), from.text.size(), to.text, sizeof to.text);
  return to;
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_session_queued(const lodemark_session* session, int32_t* count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  if (count == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "count is NULL");
  return Guard([&] {
    *count = session->engine->queued();
    return lodemark_status{LODEMARK_OK};
  });
}

lodemark_status lodemark_session_estimate(const lodemark_session* session,
                                          lodemark_estimate* estimate) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    const lodemark_status status = CheckStruct<lodemark_estimate>(estimate, {"estimate"});
    if (status != LODEMARK_OK) return status;
    const SessionEstimate& found = session->engine->estimate();
    WriteStruct(ToC(found), estimate);
    return found.status == EstimateStatus::kFix ? LODEMARK_OK : LODEMARK_NO_POSITION;
  });
}

lodemark_status lodemark_session_smoothed(const lodemark_session* session, lodemark_estimate* out,
                                          int32_t capacity, int32_t* count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    const std::vector<SessionEstimate> estimates = session->engine->Smoothed();
    return WriteList<lodemark_estimate>(
        estimates.size(), [&](std::size_t i) { return ToC(estimates[i]); }, out, capacity, count);
  });
}

lodemark_status lodemark_session_satellites(const lodemark_session* session,
                                            lodemark_satellite* out, int32_t capacity,
                                            int32_t* count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    const std::span<const SatelliteStatus> satellites = session->engine->satellites();
    return WriteList<lodemark_satellite>(
        satellites.size(), [&](std::size_t i) { return ToC(satellites[i]); }, out, capacity, count);
  });
}

lodemark_status lodemark_session_landmarks(const lodemark_session* session, lodemark_landmark* out,
                                           int32_t capacity, int32_t* count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    const std::span<const LandmarkStatus> landmarks = session->engine->landmarks();
    return WriteList<lodemark_landmark>(
        landmarks.size(), [&](std::size_t i) { return ToC(landmarks[i]); }, out, capacity, count);
  });
}

lodemark_status lodemark_session_events(const lodemark_session* session, lodemark_event* out,
                                        int32_t capacity, int32_t* count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    const std::span<const SessionEvent> events = session->engine->events();
    return WriteList<lodemark_event>(
        events.size(), [&](std::size_t i) { return ToC(events[i]); }, out, capacity, count);
  });
}
