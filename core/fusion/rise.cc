#include "core/fusion/rise.h"

namespace lodemark {
namespace {

// Beyond so many sigmas it is something else that changed.
constexpr double kGate = 3.0;

constexpr double kEarthRadius_m = 6.371e6;

}  // namespace

double HearRise(const Rise& rise, const Eigen::Vector3d& up_in_ecef, StepKnowledge* known) {
  const Eigen::Vector3d moved = known->mean.head<3>();
  const double upwards_m = up_in_ecef.dot(moved);
  // Who goes straight on rises above the curved earth.
  const double bulge_m = (moved.squaredNorm() - upwards_m * upwards_m) / (2.0 * kEarthRadius_m);
  const StepVector cross = known->covariance.leftCols<3>() * up_in_ecef;
  const double variance_m2 = up_in_ecef.dot(cross.head<3>()) + rise.sigma_m * rise.sigma_m;
  const double apart_m = rise.rise_m - upwards_m - bulge_m;
  const double square = apart_m * apart_m / variance_m2;
  if (!(square <= kGate * kGate)) return square;
  known->mean += cross * (apart_m / variance_m2);
  known->covariance -= cross * cross.transpose() / variance_m2;
  return square;
}

}  // namespace lodemark
