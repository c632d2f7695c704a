// The pipeline: turns what the sensors measure into fusion's observations, in time order, and keeps
// the latest estimate with the verdict on every satellite.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "core/gnss/android_measurement.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/gnss/precise_orbits.h"

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

struct SessionOptions {
  TimeBase time_base = TimeBase::kGps;
  std::uint32_t systems = 0x7f;       // bit i: use System(i)
  double elevation_mask_rad = 0.087;  // 5 degrees
  double smallest_cn0_dbhz = 10.0;
  IonosphereChoice ionosphere = IonosphereChoice::kBest;
  TroposphereChoice troposphere = TroposphereChoice::kSaastamoinen;
  WeightChoice weight = WeightChoice::kSignal;
  double elevation_a_m = 1.0;  // of kElevation
  double elevation_b_m = 1.0;
  bool estimate_variance_components = false;  // a and b of kElevation from the residuals
  bool estimate_zenith_delay = false;         // a tropospheric zenith delay in the state
  bool height_memory = false;                 // a weak memory of the height
  bool learn_biases = true;                   // between signals and systems, from past epochs
  bool accept_unhealthy = false;
  std::int32_t queue_capacity = 64;  // epochs that may wait for Process
  std::uint64_t seed = 1;
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
  double hdop = 0.0;
  double vdop = 0.0;
  double pdop = 0.0;
  double tdop = 0.0;
  std::int32_t satellites_used = 0;  // distinct satellites
  std::int32_t satellites_seen = 0;
  std::uint32_t sources = 0;  // bit 0: GNSS
};

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
  double residual_m = 0.0;  // observed minus computed code range
  double sigma_m = 0.0;     // stated for the code range
  double weight = 0.0;      // 0..1, share of full weight it kept
  double elevation_rad = 0.0;
  double azimuth_rad = 0.0;
  double cn0_dbhz = 0.0;
  double range_rate_residual_mps = 0.0;
};

enum class EventKind : std::uint8_t {
  kClockDiscontinuity,  // the receiver said so, or its bias was held anew
  kMillisecondJump,     // found and repaired
  kTimeBackwards,       // an epoch older than the last one: dropped, but for a restart
  kDuplicateEpoch,      // the same time twice: the second dropped
  kFirstFix,
  kFixLost,
  kEphemerisMissing,  // first time that no orbit was found for a satellite
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

  // Takes the oldest queued epoch and turns it into an estimate. True if there was one, even if it
  // was dropped for its time: then the estimate has that time and kNoData, no satellites are
  // listed, and nothing is remembered of the epoch but its event.
  bool ProcessNext();
  std::int32_t queued() const;

  const SessionEstimate& estimate() const;
  std::span<const SatelliteStatus> satellites() const;  // of the last epoch processed
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
