// One reading of an inertial sensor: three gyroscopes and three accelerometers with common axes.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lodemark {

struct InertialSample {
  std::int64_t time_ns = 0;
  Eigen::Vector3d turn_rate_radps = Eigen::Vector3d::Zero();      // right-handed, about the axes
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();  // at rest 9.8 upwards
};

}  // namespace lodemark
