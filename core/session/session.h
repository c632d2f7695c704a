// The pipeline: turns what the sensors measure into fusion's observations, in time order, and keeps
// the latest estimate with the verdict on every satellite.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/camera/gray_image.h"
#include "core/camera/lens.h"
#include "core/geo/geodetic.h"
#include "core/gnss/android_measurement.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/gnss/precise_orbits.h"
#include "core/map/feature_map.h"
#include "core/resection/sights.h"
#include "core/session/device_attitude.h"
#include "core/session/sensor_buffer.h"

namespace lodemark {

enum class IonosphereChoice : std::uint8_t {
  kBest,  // the best model whose coefficients were received, else climatology
  kNone,
  kKlobuchar,
  kBdgim,
  kNtcmG,
  kClimatology
};
enum class TroposphereChoice : std::uint8_t { kSaastamoinen, kHopfield, kNone };
enum class WeightChoice : std::uint8_t {
  kSignal,     // C/N0, elevation and the reported uncertainty, with a scale learned per signal
  kElevation,  // a^2 + b^2 / sin^2(elevation), Xu et al. equation 8, in place of the signal's noise
};
enum class TimeBase : std::uint8_t { kBoot, kGps };

// What the position is made of where there are photographs.
enum class Scheme : std::uint8_t {
  kJoint,          // bearings of landmarks and ranges to satellites in one adjustment
  kTight,          // visual ranges from the resected camera beside those to satellites (Xu et al.)
  kTightDiagonal,  // the same as if visual ranges of one photograph were independent, as published
  kVision,         // photographs alone
  kGnss,           // satellites alone
};

// What the position of one moment takes from the moments before.
enum class Estimator : std::uint8_t {
  kEpoch,     // nothing but biases between signals: each epoch stands for itself
  kFilter,    // place and velocity, carried on by Doppler and carrier phase
  kSmoother,  // the same, and all moments are remembered for Smoothed
};

struct SessionOptions {
  TimeBase time_base = TimeBase::kGps;
  Scheme scheme = Scheme::kJoint;
  Estimator estimator = Estimator::kEpoch;
  std::uint32_t systems = 0x7f;       // bit i: use System(i)
  double elevation_mask_rad = 0.087;  // 5 degrees
  double smallest_cn0_dbhz = 10.0;
  IonosphereChoice ionosphere = IonosphereChoice::kBest;
  TroposphereChoice troposphere = TroposphereChoice::kSaastamoinen;
  WeightChoice weight = WeightChoice::kSignal;
  double elevation_a_m = 1.0;  // of kElevation
  double elevation_b_m = 1.0;
  // From the residuals: a and b of kElevation, and of satellites and of landmarks a factor each,
  // where landmarks come as bearings.
  bool estimate_variance_components = false;
  bool estimate_zenith_delay = false;  // a tropospheric zenith delay in the state
  bool height_memory = false;          // a weak memory of the height
  bool learn_biases = true;            // between signals and systems, from past epochs
  bool accept_unhealthy = false;
  std::int32_t queue_capacity = 64;  // epochs that may wait for Process
  std::uint64_t seed = 1;
};

// A photograph and what is known of how it was taken.
struct CameraFrame {
  explicit CameraFrame(const Lens& its_lens) : lens(its_lens) {}

  std::int64_t time_ns = 0;  // in the session's time base, of the middle of the exposure
  Lens lens;
  GrayImage image;  // of the lens's size
  std::optional<GravityPrior> gravity;
  std::optional<double> heading_rad;  // of the optical axis, clockwise from north
  double heading_sigma_rad = 0.0;
  // Turns the accelerometer's axes into the camera's: without gravity, its samples tell it, and
  // without a heading the filter that they carry.
  std::optional<Eigen::Quaterniond> camera_from_device;
};

// What the latest photograph within reach gave the estimate.
enum class PhotoOutcome : std::uint8_t {
  kNone,  // there was none
  kUsed,
  kNotRecognised,  // it shows too little of the map for a pose
  kDisagreeing,    // its landmarks fit no one place
  kContradicted,   // satellites prove it to be of another place
};

enum class LandmarkVerdict : std::uint8_t {
  kUsed,
  kDownWeighted,
  kOutlier,
  kNotUsed,  // the photograph as a whole was not
};

// One landmark of the latest photograph within reach.
struct LandmarkStatus {
  std::uint32_t landmark_id = 0;
  LandmarkVerdict verdict = LandmarkVerdict::kNotUsed;
  bool has_residual = false;  // residual_px, range_m, range_sigma_m
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();  // seen minus predicted
  double weight = 0.0;                                    // 0..1, share of full weight it kept
  double range_m = 0.0;                                   // from the position estimated
  double range_sigma_m = 0.0;
  Eigen::Vector3d landmark_in_ecef = Eigen::Vector3d::Zero();
};

enum class EstimateStatus : std::uint8_t {
  kFix,
  kNoData,  // nothing was processed yet, or the last epoch was dropped: the events say why
  kTooFewSatellites,
  kNoEphemeris,  // measurements, but no orbit for enough of them
  kNotConverged,
  kInconsistent,  // no subset large enough agrees: no answer beats a wrong one
};

struct SessionEstimate {
  EstimateStatus status = EstimateStatus::kNoData;
  std::int64_t time_ns = 0;      // in the session's time base
  std::int64_t time_gps_ns = 0;  // GPS time, 0 if unknown
  Eigen::Vector3d position_in_ecef = Eigen::Vector3d::Zero();
  Geodetic position;
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
  bool has_velocity = false;
  Eigen::Vector3d velocity_enu_mps = Eigen::Vector3d::Zero();
  Eigen::Matrix3d velocity_covariance_enu_m2ps2 = Eigen::Matrix3d::Zero();
  double accuracy_m = 0.0;           // radius that holds the horizontal truth 68 % of the time
  double vertical_accuracy_m = 0.0;  // half-width that holds the height 68 % of the time
  double speed_accuracy_mps = 0.0;
  double protection_level_m = 0.0;  // horizontal; 0 where a single fault could go unseen
  double vertical_protection_level_m = 0.0;
  double clock_bias_m = 0.0;  // receiver clock minus GPS time, times c
  double clock_drift_mps = 0.0;
  // Variance components, times what is stated; 0 where there is none.
  double satellite_sigma_factor = 0.0;
  double landmark_sigma_factor = 0.0;
  double hdop = 0.0;
  double vdop = 0.0;
  double pdop = 0.0;
  double tdop = 0.0;
  std::int32_t satellites_used = 0;  // distinct satellites
  std::int32_t satellites_seen = 0;
  std::uint32_t sources = 0;  // kSourceGnss, kSourceVision, kSourceInertial
  PhotoOutcome photo = PhotoOutcome::kNone;
  std::int32_t landmarks_used = 0;
  std::int32_t landmarks_seen = 0;
  // Of the camera at the photograph, where it was used: turns east, north, up at the position into
  // camera axes.
  bool has_orientation = false;
  Eigen::Quaterniond camera_from_enu = Eigen::Quaterniond::Identity();
  // Of the phone, at the same place, where its inertial sensors carry the filter.
  std::optional<DeviceAttitude> attitude;
};

inline constexpr std::uint32_t kSourceGnss = 1;
inline constexpr std::uint32_t kSourceVision = 2;
inline constexpr std::uint32_t kSourceInertial = 4;

enum class SatelliteVerdict : std::uint8_t {
  kUsed,
  kDownWeighted,
  kNoEphemeris,
  kEphemerisTooOld,
  kUnhealthy,
  kLowElevation,
  kWeakSignal,
  kNotTracking,
  kTimeAmbiguous,
  kImplausible,
  kOutlier,
  kSystemOff,
  kUnknownSignal,
  kUnobservable,  // the only one of its clock group: it says nothing about the position
};

struct SatelliteStatus {
  SatelliteId satellite;
  SignalCode signal;
  SatelliteVerdict verdict = SatelliteVerdict::kUsed;
  bool has_residual = false;
  bool has_direction = false;
  bool has_rate_residual = false;
  bool has_sight = false;   // sight_probability
  double residual_m = 0.0;  // observed minus computed code range
  double sigma_m = 0.0;     // stated for the code range
  double weight = 0.0;      // 0..1, share of full weight it kept
  double elevation_rad = 0.0;
  double azimuth_rad = 0.0;
  double cn0_dbhz = 0.0;
  double range_rate_residual_mps = 0.0;
  double sight_probability = 0.0;  // that no building of the map stands in the way
};

enum class EventKind : std::uint8_t {
  kClockDiscontinuity,  // the receiver said so, or its bias was held anew
  kMillisecondJump,     // found and repaired
  kTimeBackwards,       // an epoch older than the last one: dropped, but for a restart
  kDuplicateEpoch,      // the same time twice: the second dropped
  kFirstFix,
  kFixLost,
  kEphemerisMissing,   // first time that no orbit was found for a satellite
  kPhotoContradicted,  // satellites prove a photograph to be of another place
  kPhotoFailed,        // a photograph could not be looked up: the text says why
  kMapDatum,           // the map's datum is another than the fix's, or not known
  kSensorDropped,      // samples not later than the one before, told once for each sensor
  kFilterRestarted,    // the filter's place was proven wrong, or fitted nothing for long
  kInertialAligned,    // inertial sensors carry the filter from here
  kInertialLost,       // they do not any more
  kPhotoTooLate,       // a photograph older than what a filter remembers: dropped
};

struct SessionEvent {
  EventKind kind = EventKind::kFirstFix;
  std::int64_t time_ns = 0;
  std::int64_t time_gps_ns = 0;
  double value = 0.0;  // milliseconds of a jump, count of satellites, ...
  std::string text;    // one sentence
};

class Session {
 public:
  static Result<std::unique_ptr<Session>> Open(const SessionOptions& options);
  ~Session();

  // Each copies what it needs. time_ns is the epoch's time in the session's base; for GPS-based
  // sessions it is ignored. Fails with kQueueFull when Process must be called first.
  Status PushAndroidEpoch(std::int64_t time_ns, const AndroidEpoch& epoch);
  Status PushObservationEpoch(std::int64_t time_ns, const ObservationEpoch& epoch);
  Status PushNavigation(const NavigationRecord& record);
  Status PushPreciseOrbits(const PreciseOrbits& orbits);
  // One message as android.location.GnssNavigationMessage delivers it. Complete sets take effect
  // when their last part arrives; needs a GPS time from earlier epochs to resolve the week.
  Status PushNavigationMessage(std::int32_t type, std::int32_t svid, std::int32_t message_id,
                               std::int32_t submessage_id, std::span<const std::uint8_t> bytes);

  // The map that photographs are looked up in, and whose buildings stand in the way of satellites
  // and landmarks; it must stay as long as it is used. Null: none. Fails, and uses none, if its
  // buildings are damaged.
  Status UseMap(const FeatureMap* map);
  // Copies the image. Fails with kQueueFull when Process must be called first: few photographs may
  // wait. kOutOfOrder without a map.
  Status PushFrame(const CameraFrame& frame);
  // Takes samples of any sensors; those of one sensor in the order of their times, or they are
  // dropped. The values are finite.
  Status PushSensors(std::span<const SensorSample> samples);

  // Takes the oldest of what is queued, epoch or photograph, and turns it into an estimate at its
  // time. True if there was one, even if it was dropped for its time: then the estimate has that
  // time and kNoData, no satellites are listed, and nothing is remembered of the epoch but its
  // event. An epoch is adjusted together with the latest photograph, a photograph with the latest
  // epoch, where they are not too far apart in time.
  bool ProcessNext();
  std::int32_t queued() const;  // epochs and photographs

  const SessionEstimate& estimate() const;
  std::span<const SatelliteStatus> satellites() const;  // of the epoch processed last
  std::span<const LandmarkStatus> landmarks() const;    // of the photograph the estimate looked at
  // All estimates so far in the order they were given, each with what came after it: empty without
  // Estimator::kSmoother. Remembers some 8 kB for each.
  std::vector<SessionEstimate> Smoothed() const;
  // Events since the last call of ClearEvents, at most 256; the oldest give way.
  std::span<const SessionEvent> events() const;
  void ClearEvents();

  // Forgets positions, clocks, queues, events and learned biases; keeps ephemerides.
  void Reset();

 private:
  struct Impl;
  explicit Session(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
