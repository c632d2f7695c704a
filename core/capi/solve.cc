// Position from ranges to known points.
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "core/base/units.h"
#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/structs.h"
#include "core/fusion/point_solution.h"
#include "core/geo/geodetic.h"
#include "core/session/accuracy.h"

namespace lodemark {
namespace {

static_assert(LODEMARK_CLOCK_GROUPS <= kMaxClockGroups);

constexpr double kSmallestSigma_m = 1e-6;

// By PointSolutionStatus.
constexpr std::int32_t kOutcomes[] = {LODEMARK_OUTCOME_FIX, LODEMARK_OUTCOME_TOO_FEW,
                                      LODEMARK_OUTCOME_NOT_CONVERGED, LODEMARK_OUTCOME_INCONSISTENT,
                                      LODEMARK_OUTCOME_AMBIGUOUS};
static_assert(static_cast<int>(PointSolutionStatus::kGood) == 0);
static_assert(static_cast<int>(PointSolutionStatus::kTooFew) == 1);
static_assert(static_cast<int>(PointSolutionStatus::kNotConverged) == 2);
static_assert(static_cast<int>(PointSolutionStatus::kInconsistent) == 3);
static_assert(static_cast<int>(PointSolutionStatus::kAmbiguous) == 4);

lodemark_status Translate(const lodemark_range& from, Where where, RangeObservation* to) {
  Check check(where);
  check.True(
      from.clock_group >= LODEMARK_CLOCK_GROUP_NONE && from.clock_group <= LODEMARK_CLOCK_GROUPS,
      "clock_group", "is outside 0 .. LODEMARK_CLOCK_GROUPS");
  check.Point(from.point_in_ecef_m, "point_in_ecef_m");
  check.Within(from.range_m, -kLargestLength_m, kLargestLength_m, "range_m");
  check.Within(from.sigma_m, kSmallestSigma_m, kLargestLength_m, "sigma_m");
  if (check.status() != LODEMARK_OK) return check.status();
  to->point_in_ecef = Eigen::Map<const Eigen::Vector3d>(from.point_in_ecef_m);
  to->range_m = from.range_m;
  to->error.sigma_m = from.sigma_m;
  const bool has_clock = from.clock_group != LODEMARK_CLOCK_GROUP_NONE;
  to->clock_group = has_clock ? from.clock_group - 1 : kNoClock;
  return LODEMARK_OK;
}

lodemark_status ReadStart(const lodemark_solve_options* options,
                          std::optional<Eigen::Vector3d>* start) {
  if (options == nullptr) return LODEMARK_OK;
  lodemark_solve_options stated = {};
  const lodemark_status status = ReadStruct(options, {"options"}, &stated);
  if (status != LODEMARK_OK) return status;
  Check check({"options"});
  check.Bits(stated.present, LODEMARK_SOLVE_HAS_START, "present");
  if ((stated.present & LODEMARK_SOLVE_HAS_START) != 0) {
    check.Point(stated.start_in_ecef_m, "start_in_ecef_m");
    *start = Eigen::Map<const Eigen::Vector3d>(stated.start_in_ecef_m);
  }
  return check.status();
}

lodemark_solution ToC(const PointSolution& from) {
  lodemark_solution to = {};
  to.outcome = kOutcomes[static_cast<std::size_t>(from.status)];
  if (from.status != PointSolutionStatus::kGood) return to;
  to.ranges_used = from.used;
  to.clocks_present = from.clock_groups;
  std::memcpy(to.ecef_m, from.position_in_ecef.data(), sizeof to.ecef_m);
  const Geodetic place = GeodeticFromEcef(from.position_in_ecef);
  to.latitude_deg = place.latitude_rad * kDegreesPerRadian;
  to.longitude_deg = place.longitude_rad * kDegreesPerRadian;
  to.height_m = place.height_m;
  std::memcpy(to.covariance_enu_m2, from.covariance_enu_m2.data(), sizeof to.covariance_enu_m2);
  to.accuracy_m = RadiusOfProbability(from.covariance_enu_m2.topLeftCorner<2, 2>(), 0.68);
  to.vertical_accuracy_m = kHalfWidth68 * std::sqrt(from.covariance_enu_m2(2, 2));
  to.pdop = from.pdop;
  to.hdop = from.hdop;
  to.vdop = from.vdop;
  to.tdop = from.tdop;
  std::memcpy(to.clock_m, from.clock_m.data(), sizeof to.clock_m);
  std::memcpy(to.clock_sigma_m, from.clock_sigma_m.data(), sizeof to.clock_sigma_m);
  return to;
}

lodemark_range_residual ToC(const ObservationVerdict& from) {
  lodemark_range_residual to = {};
  to.used = from.used ? 1 : 0;
  to.residual_m = from.residual_m;
  to.weight = from.weight;
  return to;
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_position_solve(const lodemark_range* ranges, int32_t count,
                                        const lodemark_solve_options* options,
                                        lodemark_solution* solution,
                                        lodemark_range_residual* residuals) {
  using namespace lodemark;
  return Guard([&] {
    const StructArray<lodemark_range> array(ranges, count, "ranges");
    std::optional<Eigen::Vector3d> start;
    lodemark_status status = array.CheckCount();
    if (status == LODEMARK_OK) status = ReadStart(options, &start);
    if (status == LODEMARK_OK) status = CheckStruct<lodemark_solution>(solution, {"solution"});
    if (status == LODEMARK_OK && residuals != nullptr && count > 0) {
      status = CheckStruct<lodemark_range_residual>(residuals, {"residuals"});
    }
    if (status != LODEMARK_OK) return status;

    std::vector<RangeObservation> observations(static_cast<std::size_t>(count));
    status = array.ForEach([&](const lodemark_range& from, Where where, std::size_t i) {
      return Translate(from, where, &observations[i]);
    });
    if (status != LODEMARK_OK) return status;

    std::vector<ObservationVerdict> verdicts;
    const PointSolution solved = SolvePoint(observations, start, &verdicts);
    WriteStruct(ToC(solved), solution);
    if (residuals != nullptr) {
      std::int32_t written = 0;
      WriteList<lodemark_range_residual>(
          verdicts.size(), [&](std::size_t i) { return ToC(verdicts[i]); }, residuals, count,
          &written);
    }
    return solved.status == PointSolutionStatus::kGood ? LODEMARK_OK : LODEMARK_NO_POSITION;
  });
}
