// What a phone's inertial sensors make of the motion: turned by what they felt, then carried by
// them; held by what a phone at rest or in a vehicle cannot do.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/inertial_alignment.h"
#include "core/fusion/inertial_filter.h"
#include "core/fusion/motion_filter.h"
#include "core/session/barometer.h"
#include "core/session/device_attitude.h"
#include "core/session/sensor_buffer.h"

namespace lodemark {

// Times are the session's.
class InertialCarrier {
 public:
  explicit InertialCarrier(const SensorBuffer* sensors) : sensors_(sensors) {}

  bool carries() const { return filter_.started(); }
  const InertialFilter& filter() const { return filter_; }
  InertialFilter& filter() { return filter_; }

  // Notes the motion of a moment without which it cannot begin to carry; begins where it can.
  // measured: the velocity rests on Doppler or phase of that moment.
  void Note(std::int64_t time_ns, const MotionFilter& motion, bool measured);

  // Carries from one moment to the next. False, and carrying no more, where the sensors do not
  // reach; the state is then that of the first moment.
  bool Advance(std::int64_t from_ns, std::int64_t to_ns,
               std::span<const RangeRateObservation> rates,
               std::span<const RangeChangeObservation> changes, Barometer* barometer,
               MotionVerdicts* verdicts);

  // How the phone is turned at a time, by what was felt since the moment of the state, or until it.
  // None where nothing carries, where it is a vehicle that does, and where samples are missing.
  std::optional<DeviceAttitude> AttitudeAt(std::int64_t state_ns, std::int64_t time_ns) const;

  void Forget();

 private:
  bool Step(std::int64_t from_ns, std::int64_t to_ns, std::span<const RangeRateObservation> rates,
            std::span<const RangeChangeObservation> changes, Barometer* barometer,
            MotionVerdicts* verdicts);
  // What was felt in between, by the phone or else by a vehicle that tells its speed.
  std::span<const InertialSample> Felt(std::int64_t from_ns, std::int64_t to_ns, bool* complete);
  const InertialNoise& noise() const;
  void HearRest(std::span<const InertialSample> samples, double seconds);
  void HearVehicle(std::span<const InertialSample> samples, std::int64_t from_ns,
                   std::int64_t to_ns);

  const SensorBuffer* sensors_;
  InertialFilter filter_;
  InertialAlignment alignment_;
  bool by_wheels_ = false;  // what is felt is what a vehicle says
  std::vector<InertialSample> wheels_;
  // Of the last moment whose velocity was measured.
  std::int64_t noted_ns_ = 0;
  Eigen::Vector3d noted_velocity_in_ecef_mps_ = Eigen::Vector3d::Zero();
  double noted_variance_m2ps2_ = 0.0;
  int unlike_vehicle_ = 0;  // times in a row
};

}  // namespace lodemark
