// What an inertial sensor felt between two moments, in its own axes: preintegration, after Forster,
// Carlone, Dellaert and Scaramuzza (IEEE T-RO 33(1), 2017), with errors in the axes of the
// beginning.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "core/fusion/inertial_sample.h"

namespace lodemark {

// Constant errors: what the sensor shows too much.
struct InertialBiases {
  Eigen::Vector3d turn_rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
};

// White, and how fast the biases wander. Those of a phone's sensors in a car or a hand, where
// vibration and imperfect axes weigh more than the noise of the data sheet.
struct InertialNoise {
  double turn_rate_radps_sqrt_s = 1e-3;  // times sqrt(s)
  double specific_force_mps2_sqrt_s = 0.02;
  double turn_rate_wander_radps_psqrt_s = 1e-4;  // per sqrt(s)
  double specific_force_wander_mps2_psqrt_s = 2e-3;
  double scale = 0.01;  // of a turn and of a change of velocity
};

struct InertialIncrement {
  double seconds = 0.0;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  // axes of the beginning from the end's
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();    // by the specific force alone
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();         // likewise, from rest
  // By how much the true ones differ if the biases are greater: rows turn, velocity, moved, all in
  // the axes of the beginning; columns turn rate, specific force.
  Eigen::Matrix<double, 9, 6> by_biases = Eigen::Matrix<double, 9, 6>::Zero();
  // Of white noise, rows as above.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
};

// samples: by time, the first and the last at the ends of the increment.
InertialIncrement IntegrateInertial(std::span<const InertialSample> samples,
                                    const InertialBiases& biases, const InertialNoise& noise);

}  // namespace lodemark
