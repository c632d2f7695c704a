#include "core/session/height_memory.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

constexpr double kLongestGap_s = 60.0;

// What a way may climb, as a share of its length, beside stairs and lifts.
constexpr double kSlopeSigma = 0.1;
constexpr double kLiftSigma_mps = 0.3;
// Of a receiver without a velocity: a car on a slope.
constexpr double kUnknownClimbSigma_mps = 3.0;

// Errors of neighbouring epochs are alike, so their mean is never believed better than this, and
// each epoch's stated sigma is widened.
constexpr double kSmallestSigma_m = 4.0;
constexpr double kWidening = 1.5;

}  // namespace

std::optional<HeightPrior> HeightMemory::At(std::int64_t time_gps_ns) const {
  if (!has_fix_) return std::nullopt;
  const double gap_s = 1e-9 * static_cast<double>(time_gps_ns - time_gps_ns_);
  if (!(gap_s >= 0.0) || gap_s > kLongestGap_s) return std::nullopt;
  HeightPrior prior;
  prior.height_m = height_m_ + climb_mps_ * gap_s;
  prior.sigma_m = std::sqrt(variance_m2_ + climb_variance_m2ps2_ * gap_s * gap_s);
  return prior;
}

void HeightMemory::Learn(const SessionEstimate& estimate) {
  has_fix_ = true;
  time_gps_ns_ = estimate.time_gps_ns;
  height_m_ = estimate.position.height_m;
  variance_m2_ = std::max(kSmallestSigma_m * kSmallestSigma_m,
                          kWidening * kWidening * estimate.covariance_enu_m2(2, 2));
  climb_mps_ = 0.0;
  climb_variance_m2ps2_ = kUnknownClimbSigma_mps * kUnknownClimbSigma_mps;
  if (!estimate.has_velocity) return;
  const double speed_mps = estimate.velocity_enu_mps.head<2>().norm();
  const double allowed_mps = std::hypot(kLiftSigma_mps, kSlopeSigma * speed_mps);
  const double allowed_m2ps2 = allowed_mps * allowed_mps;
  const double measured_m2ps2 = std::max(estimate.velocity_covariance_enu_m2ps2(2, 2), 0.0);
  const double share = allowed_m2ps2 / (allowed_m2ps2 + measured_m2ps2);
  climb_mps_ = share * estimate.velocity_enu_mps.z();
  climb_variance_m2ps2_ = share * measured_m2ps2;
}

}  // namespace lodemark
