// What the simulated phone's accelerometer and gyroscope give: the truth about its motion, and
// what sensors of its price make of it.
#pragma once

#include <Eigen/Core>

#include "core/base/random.h"
#include "tools/simulator/phone_hold.h"
#include "tools/simulator/receiver_path.h"
#include "tools/simulator/scenario.h"

namespace lodemark {

struct InertialTruth {
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();       // specific force, axes of the device
  Eigen::Vector3d turn_rate_radps = Eigen::Vector3d::Zero();  // against the stars, the same axes
};

// Of the phone on its way, which bobs by some two centimetres with the steps of a walker.
class InertialMotion {
 public:
  explicit InertialMotion(const Scenario& scenario);

  // The means over the interval of the given length around the time, seconds after the start: what
  // sensors filter before they sample. Sums of them give velocity and attitude exactly.
  InertialTruth At(double time_s, double interval_s) const;

  Eigen::Vector3d PositionAt(double time_s) const;  // east, north, up
  Eigen::Vector3d VelocityAt(double time_s) const;
  const PhoneHold& hold() const { return hold_; }
  double gravity_mps2() const { return gravity_mps2_; }
  const Eigen::Vector3d& earth_rate_radps() const { return earth_rate_in_enu_; }

 private:
  double BobAt(double time_s) const;

  ReceiverPath path_;
  PhoneHold hold_;
  bool walks_;
  double gravity_mps2_;
  Eigen::Vector3d earth_rate_in_enu_;
};

// The errors of one three-axis sensor: a bias that is there from the start and walks, a factor of
// scale, white noise.
class SensorErrors {
 public:
  struct Grade {
    double bias_sigma = 0.0;     // at the start
    double bias_walk = 0.0;      // per square root of a second
    double noise_density = 0.0;  // per square root of a hertz
    double scale_sigma = 0.0;    // of the factor, against 1
    double stated_share = 0.0;   // of the first bias that the phone's own estimate misses
  };
  SensorErrors(const Grade& grade, Random* random);

  // The next sample, interval_s after the one before. Draws for the noise and the walk.
  Eigen::Vector3d Measure(const Eigen::Vector3d& truth, double interval_s, Random* random);
  // As the phone states it with every sample.
  const Eigen::Vector3d& stated_bias() const { return stated_bias_; }

 private:
  Grade grade_;
  Eigen::Vector3d bias_;
  Eigen::Vector3d scale_;
  Eigen::Vector3d stated_bias_;
};

SensorErrors::Grade PhoneAccelerometer();  // m/s^2
SensorErrors::Grade PhoneGyroscope();      // rad/s

}  // namespace lodemark
