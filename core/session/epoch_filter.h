// The filter over a session's moments: carries what is known of the place from one to the next, and
// takes what the adjustment of an epoch or a photograph makes of it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/acceleration_memory.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/position_statement.h"
#include "core/session/carried_motion.h"
#include "core/session/error_persistence.h"
#include "core/session/gnss_epoch.h"
#include "core/session/heard_step.h"
#include "core/session/numbered_list.h"
#include "core/session/phase_changes.h"
#include "core/session/satellite_trust.h"

namespace lodemark {

// Times are the session's.
class EpochFilter {
 public:
  // remembers: every step it takes, for smoothing, and does without sensors; they must stay.
  EpochFilter(bool remembers, const SensorBuffer* sensors)
      : remembers_(remembers), sensors_(remembers ? nullptr : sensors), filter_(sensors_) {}

  bool started() const { return filter_.started(); }
  bool inertial() const { return filter_.inertial(); }
  // How often it has begun anew as its place fitted no more.
  int restarts() const { return restarts_; }
  std::int64_t time_ns() const { return time_ns_; }
  Eigen::Vector3d position_in_ecef() const { return filter_.position_in_ecef(); }
  Eigen::Vector3d velocity_in_ecef_mps() const { return filter_.velocity_in_ecef_mps(); }
  double clock_drift_mps() const { return filter_.clock_drift_mps(); }
  // How the phone is turned at a time, where its inertial sensors carry the filter.
  std::optional<DeviceAttitude> AttitudeAt(std::int64_t time_ns) const {
    return filter_.AttitudeAt(time_ns_, time_ns);
  }
  // As they are to be stated: with what no averaging takes away.
  Eigen::Matrix3d PositionCovarianceEnu() const;
  Eigen::Matrix3d VelocityCovarianceEnu() const { return filter_.VelocityCovarianceEnu(); }
  // Of the position as the filter has it.
  Eigen::Matrix3d FilteredCovarianceEnu() const;
  const NumberedList<MotionStep>& steps() const { return steps_.list; }
  // What the rates of the epoch advanced to were worth, and which of its signals each is of: empty
  // where they do not fit one velocity.
  std::span<const MotionVerdict> rate_verdicts() const {
    return verdicts_.rates_agree ? std::span<const MotionVerdict>(verdicts_.rates)
                                 : std::span<const MotionVerdict>();
  }
  std::span<const std::size_t> rate_signals() const { return rate_signals_; }
  const NumberedList<HeardStep>& heard() const { return steps_.heard; }  // of the same numbers
  // How far the position rests on ranges: it moves by this times what moves them all.
  const Eigen::Matrix3d& ranged_share() const { return ranged_share_; }

  // Where the receiver is about to be found; empty before the first fix.
  std::optional<Eigen::Vector3d> PlaceAt(std::int64_t time_ns) const;

  // Carries the state to an epoch that was modelled near PlaceAt, or to a moment without one.
  void Advance(std::int64_t time_ns, const ObservationEpoch& epoch, const GnssEpochModel& model);
  void Advance(std::int64_t time_ns);

  // What is known of the place before the moment's own observations are heard.
  std::optional<PositionStatement> Place() const;

  // The ranges of an epoch are by so much likelier elsewhere (log). True, and stopped, once epochs
  // that err alike prove it together.
  bool ProvesLost(double likelier);
  // Nothing makes them look so.
  void NoteFound() { Doubt(0.0); }

  // From the adjustment that heard Place() and the ranges of the epoch advanced to.
  void HearEpoch(const GnssEpochModel& model, const PointEstimate& point,
                 std::span<const ObservationVerdict> verdicts);
  // What that adjustment heard beside Place(), for going the way again; after HearEpoch.
  void Remember(std::span<const RangeObservation> ranges, const ClockBiases& biases,
                const PointOptions& options);
  // From one that heard Place(), if there was one, and a photograph taken near by; of a moment.
  void HearPhoto(std::int64_t time_ns, std::int64_t taken_ns, const PointEstimate& point);

  // A copy has no steps, and assigning one leaves them; this cuts those off that were taken since.
  void GoBackTo(const EpochFilter& copy);

  // All but the steps.
  void Forget();
  void ForgetSteps();

 private:
  struct Steps {
    Steps() = default;
    Steps(const Steps&) {}
    Steps& operator=(const Steps&) { return *this; }
    // Of both lists, so that noting a step takes no memory.
    void MakeRoom(bool remembers) {
      if (!remembers) return;
      list.MakeRoom();
      heard.MakeRoom();
    }
    NumberedList<MotionStep> list;
    NumberedList<HeardStep> heard;
  };

  void Doubt(double likelier);
  void BeginAnew();
  void Move(std::int64_t time_ns);
  void Start(const Eigen::Vector3d& position_in_ecef, const Eigen::Matrix3d& covariance_enu_m2);
  HeardStep MotionHeard(std::int64_t time_ns) const;
  void NoteStep(HeardStep heard);
  void NoteSaid(const PositionStatement& said, bool ranged);
  // Hears what an adjustment made of the present state, as strong as a share of it.
  void Hear(const PointEstimate& point, double share, bool ranged);

  bool remembers_;
  const SensorBuffer* sensors_;
  CarriedMotion filter_;
  Steps steps_;
  std::size_t steps_taken_ = 0;  // the number after the last one
  // What was said of the place at the last of them.
  PositionStatement epoch_said_;
  PositionStatement photos_said_;
  PhaseChanges phases_;
  ErrorPersistence persistence_;
  SatelliteTrust trust_;
  AccelerationMemory accelerations_;
  std::vector<RangeRateObservation> rates_;
  std::vector<std::size_t> rate_signals_;
  std::vector<RangeChangeObservation> changes_;
  std::vector<SatelliteId> rate_satellites_;
  std::vector<SatelliteId> change_satellites_;
  std::vector<RangeSource> sources_;  // of the epoch's ranges
  MotionVerdicts verdicts_;
  std::int64_t time_ns_ = 0;   // of the state
  std::int64_t epoch_ns_ = 0;  // of the last epoch
  std::int64_t photo_ns_ = 0;  // of the last photograph heard
  double seconds_ = 0.0;       // between the last two epochs
  int restarts_ = 0;
  double silent_s_ = 0.0;       // since a velocity was measured
  double unexplained_s_ = 0.0;  // for so long most ranges have fitted nothing
  double lost_ = 0.0;           // how much likelier it is by now to be elsewhere (log)
  double epochs_ = 0.0;         // heard since the filter began, or as good as
  Eigen::Matrix3d lasting_m2_ = Eigen::Matrix3d::Zero();  // of ranges, whatever the time
  Eigen::Matrix3d ranged_share_ = Eigen::Matrix3d::Zero();
};

}  // namespace lodemark
