// How far the receiver may have moved between two moments.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/session/session.h"

namespace lodemark {

// A displacement and how sure it is.
struct Displacement {
  Eigen::Vector3d in_ecef_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
};

// Carries the last velocity on: by Doppler where it is recent, else by what phones in hands and
// cars do.
class Motion {
 public:
  void Learn(const SessionEstimate& estimate);
  Displacement Between(std::int64_t from_ns, std::int64_t to_ns) const;
  void Forget() { has_velocity_ = false; }

 private:
  bool has_velocity_ = false;
  std::int64_t time_ns_ = 0;
  Eigen::Vector3d velocity_in_ecef_mps_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2ps2_ = Eigen::Matrix3d::Zero();
};

}  // namespace lodemark
