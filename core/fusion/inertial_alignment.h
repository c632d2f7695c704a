// How an inertial sensor is turned, from what it felt while the velocity changed: the changes of
// velocity less gravity's, seen from the earth, are those felt by the sensor, turned. Gravity fixes
// the tilt, speeding up, braking and bends the heading; however the phone is held.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fusion/inertial_increment.h"

namespace lodemark {

// One stretch of the way: what was felt, and what Doppler or phase say of the velocity.
struct FeltStretch {
  InertialIncrement felt;                                        // as if there were no biases
  Eigen::Vector3d gained_in_ecef_mps = Eigen::Vector3d::Zero();  // of velocity, less gravity's part
  double sigma_mps = 0.1;                                        // of that, an axis
};

struct InertialAlignmentResult {
  Eigen::Quaterniond ecef_from_sensor = Eigen::Quaterniond::Identity();  // at the end
  InertialBiases biases;
  // Of the turn (earth-fixed), the turn rate's bias and the specific force's.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Identity();
  // Mean square of what does not fit, in its variance.
  double strain = 0.0;
};

class InertialAlignment {
 public:
  // Each begins where the one before ends; the oldest give way.
  void Add(const FeltStretch& stretch);
  void Forget() { stretches_.clear(); }
  std::size_t size() const { return stretches_.size(); }

  // up_in_ecef: of the place. Empty while the heading is not known to 10 degrees, the opposite one
  // is not excluded, or what was felt is not what was moved.
  std::optional<InertialAlignmentResult> Solve(const Eigen::Vector3d& up_in_ecef) const;

 private:
  std::vector<FeltStretch> stretches_;
};

}  // namespace lodemark
