#include "core/session/photo_level.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr std::int64_t kReach_ns = 100 * kMillisecond_ns;  // to either side
constexpr int kFewestSamples = 3;
constexpr double kSmallestSigma_rad = 2.0 * kRadiansPerDegree;

constexpr double kGravity_mps2 = 9.81;
constexpr double kLargestDifference_mps2 = 1.5;  // 8 degrees, if all of it were sideways

}  // namespace

std::optional<GravityPrior> LevelAt(const SensorBuffer& sensors, std::int64_t time_ns,
                                    const Eigen::Quaterniond& camera_from_device) {
  const std::optional<MeanForce> force =
      sensors.MeanForceBetween(time_ns - kReach_ns, time_ns + kReach_ns);
  if (!force || force->samples < kFewestSamples) return std::nullopt;
  const double length_mps2 = force->mean_mps2.norm();
  if (!(std::abs(length_mps2 - kGravity_mps2) < kLargestDifference_mps2)) return std::nullopt;
  const double sigma_rad = std::atan2(force->scatter_mps2.maxCoeff(), length_mps2);
  return GravityPrior{camera_from_device * (force->mean_mps2 / length_mps2),
                      std::max(sigma_rad, kSmallestSigma_rad)};
}

}  // namespace lodemark
