#include "core/session/lost_place.h"

#include <cmath>

#include "core/fusion/range_error.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// A second look is due where of so many ranges less than half are likelier noise than anything
// else, or where they pull the place so many sigmas away.
constexpr std::size_t kFewestForDoubt = 6;
constexpr double kDoubtful_sigmas = 3.0;

}  // namespace

bool LooksLost(const PositionStatement& expected, const PointEstimate& point,
               std::span<const ObservationVerdict> verdicts) {
  if (verdicts.size() < kFewestForDoubt) return false;
  double ordinary = 0.0;
  for (const ObservationVerdict& verdict : verdicts) ordinary += verdict.weight;
  if (ordinary < 0.5 * static_cast<double>(verdicts.size())) return true;
  const Eigen::Vector3d moved_m = EnuFromEcefRotation(GeodeticFromEcef(expected.around_in_ecef)) *
                                  (point.position_in_ecef - expected.around_in_ecef);
  return moved_m.dot(expected.information_pm2 * moved_m) > kDoubtful_sigmas * kDoubtful_sigmas;
}

double LogLikelihood(std::span<const RangeObservation> ranges,
                     std::span<const ObservationVerdict> verdicts) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    sum += std::log(RangeErrorDensity(ranges[i].error, verdicts[i].residual_m));
  }
  return sum;
}

}  // namespace lodemark
