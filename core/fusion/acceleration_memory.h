// How lively the receiver has moved lately: a phone at rest, in a hand or in a car.
#pragma once

#include <Eigen/Core>

namespace lodemark {

// How the velocity may change by itself: white acceleration, its density along east, north, up.
struct MotionModel {
  Eigen::Vector3d acceleration_density_m2ps3 = Eigen::Vector3d(1.0, 1.0, 0.05);
};

class AccelerationMemory {
 public:
  // What to expect so long after the last velocity was learned: a rest may end.
  MotionModel After(double silent_s) const;

  // How much the velocity has changed within so many seconds.
  void Learn(double seconds, const Eigen::Vector3d& change_enu_mps);
  void Forget() { *this = AccelerationMemory(); }

 private:
  Eigen::Vector3d density_m2ps3_ = MotionModel().acceleration_density_m2ps3;
};

}  // namespace lodemark
