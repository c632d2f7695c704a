#include "core/fusion/acceleration_memory.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Changes are remembered for so long, and rests end after so long unheard of.
constexpr double kMemory_s = 10.0;
constexpr double kRest_s = 20.0;

// Even a phone on a table may be picked up the next moment; no car brakes harder.
const Eigen::Vector3d kCalmest_m2ps3(0.1, 0.1, 0.01);
const Eigen::Vector3d kLiveliest_m2ps3(4.0, 4.0, 0.5);

}  // namespace

MotionModel AccelerationMemory::After(double silent_s) const {
  const Eigen::Vector3d usual = MotionModel().acceleration_density_m2ps3;
  const double forgotten = 1.0 - std::exp(-silent_s / kRest_s);
  MotionModel model;
  model.acceleration_density_m2ps3 =
      density_m2ps3_ + forgotten * (usual - density_m2ps3_).cwiseMax(0.0);
  return model;
}

void AccelerationMemory::Learn(double seconds, const Eigen::Vector3d& change_enu_mps) {
  const Eigen::Vector3d squares = change_enu_mps.cwiseAbs2() / seconds;
  // North and east are alike: which way a street runs says nothing of the next one.
  const double horizontal = 0.5 * (squares.x() + squares.y());
  const Eigen::Vector3d seen(horizontal, horizontal, squares.z());
  const double gain = 1.0 - std::exp(-seconds / kMemory_s);
  density_m2ps3_ += gain * (seen - density_m2ps3_);
  density_m2ps3_ = density_m2ps3_.cwiseMax(kCalmest_m2ps3).cwiseMin(kLiveliest_m2ps3);
}

}  // namespace lodemark
