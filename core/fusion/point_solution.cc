#include "core/fusion/point_solution.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/fusion/clock_biases.h"
#include "core/fusion/coarse_position.h"
#include "core/fusion/range_error.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// A point this near has no direction worth the name.
constexpr double kTouching_m = 1e-3;
// Two places whose costs differ by less than a 3 sigma residual cannot be told apart.
constexpr double kTellingCost = 4.5;
// Dilution beyond which the geometry fixes nothing.
constexpr double kHopelessDilution = 1e4;
// Nobody reads landmarks and satellites from farther above or below the ground.
constexpr double kFarthestFromGround_m = 1e5;

// The same observations with their clock groups numbered from 0 as they appear.
struct Problem {
  explicit Problem(std::span<const RangeObservation> given)
      : observations(given.begin(), given.end()) {
    std::array<std::int32_t, kMaxClockGroups> dense;
    dense.fill(kNoClock);
    for (RangeObservation& observation : observations) {
      if (observation.clock_group == kNoClock) continue;
      std::int32_t& number = dense[static_cast<std::size_t>(observation.clock_group)];
      if (number == kNoClock) {
        number = static_cast<std::int32_t>(group_of.size());
        group_of.push_back(observation.clock_group);
      }
      observation.clock_group = number;
      ++members[static_cast<std::size_t>(number)];
    }
  }

  int unknowns() const { return 3 + static_cast<int>(group_of.size()); }
  // False for a range whose clock no other shares: it finds that clock and nothing else.
  bool IsObservable(const RangeObservation& observation) const {
    return observation.clock_group == kNoClock ||
           members[static_cast<std::size_t>(observation.clock_group)] > 1;
  }

  std::vector<RangeObservation> observations;
  std::vector<int> group_of;  // dense number to the caller's
  std::array<int, kMaxClockGroups> members = {};
};

// Fourteen places around the landmarks, as far from them as the ranges say. Empty without
// landmarks.
std::vector<Eigen::Vector3d> StartsAroundLandmarks(std::span<const RangeObservation> observations) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double range_m = 0.0;
  int landmarks = 0;
  for (const RangeObservation& observation : observations) {
    if (observation.clock_group != kNoClock) continue;
    centre += observation.point_in_ecef;
    range_m += observation.range_m;
    ++landmarks;
  }
  std::vector<Eigen::Vector3d> starts;
  if (landmarks == 0) return starts;
  centre /= landmarks;
  range_m = std::max(std::abs(range_m) / landmarks, 1.0);
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Eigen::Vector3d direction(x, y, z);
        const int axes = x * x + y * y + z * z;
        if (axes != 1 && axes != 3) continue;
        starts.push_back(centre + range_m * direction.normalized());
      }
    }
  }
  return starts;
}

Eigen::Vector3d BesideThePoints(Eigen::Vector3d start,
                                std::span<const RangeObservation> observations) {
  const auto touches = [&](const RangeObservation& observation) {
    return (observation.point_in_ecef - start).norm() < kTouching_m;
  };
  if (std::any_of(observations.begin(), observations.end(), touches)) start.x() += 1.0;
  return start;
}

// Position information of the ranges that were used, from which the covariance (weighted) and the
// dilutions (all alike) follow. Empty if they leave something undetermined.
std::optional<PointMatrix> Cofactor(const Problem& problem,
                                    const std::vector<ObservationVerdict>& verdicts,
                                    const Eigen::Vector3d& position_in_ecef, bool weighted) {
  const int unknowns = problem.unknowns();
  PointMatrix normal = PointMatrix::Zero(unknowns, unknowns);
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(GeodeticFromEcef(position_in_ecef));
  std::array<bool, kMaxClockGroups> seen = {};
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (!verdicts[i].used) continue;
    const RangeObservation& observation = problem.observations[i];
    PointVector slope = PointVector::Zero(unknowns);
    const Eigen::Vector3d line = position_in_ecef - observation.point_in_ecef;
    slope.head<3>() = enu_from_ecef * line.normalized();
    if (observation.clock_group != kNoClock) {
      slope[3 + observation.clock_group] = 1.0;
      seen[static_cast<std::size_t>(observation.clock_group)] = true;
    }
    const double sigma_m = weighted ? observation.error.sigma_m : 1.0;
    normal += slope * slope.transpose() / (sigma_m * sigma_m);
  }
  for (int k = 3; k < unknowns; ++k) {
    if (!seen[static_cast<std::size_t>(k - 3)]) normal(k, k) = 1.0;
  }
  // Scaled to a unit diagonal, so that the verdict does not depend on the sigmas.
  const PointVector diagonal = normal.diagonal();
  if (!(diagonal.minCoeff() > 0.0)) return std::nullopt;
  const PointVector scale = diagonal.cwiseSqrt().cwiseInverse();
  const PointMatrix scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::LDLT<PointMatrix> factor(scaled);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-14)) {
    return std::nullopt;
  }
  const PointMatrix inverse = factor.solve(PointMatrix::Identity(unknowns, unknowns));
  return PointMatrix(scale.asDiagonal() * inverse * scale.asDiagonal());
}

class Solver {
 public:
  explicit Solver(const Problem& problem) : problem_(problem) {
    options_.posterior_mean = false;  // the mode: what the ranges say, not how others might err
  }

  // Follows one start to the place it leads to, if there is one.
  void Follow(const Eigen::Vector3d& start_in_ecef) {
    PointEstimate estimate;
    const PointStatus status = adjustment_.Solve(
        problem_.observations, BesideThePoints(start_in_ecef, problem_.observations), ClockBiases(),
        options_, &estimate, &verdicts_);
    // Whether enough of them agree is judged once the best place is known.
    if (status != PointStatus::kGood && status != PointStatus::kInconsistent) return;
    if (!estimate.position_in_ecef.allFinite()) return;
    double cost = 0.0;
    for (std::size_t i = 0; i < verdicts_.size(); ++i) {
      cost -= std::log(RangeErrorDensity(problem_.observations[i].error, verdicts_[i].residual_m));
    }
    candidates_.push_back({cost, estimate});
  }

  // Of all places found the one that fits best; null if there is none.
  const PointEstimate* Best() {
    const auto costs_less = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
    std::sort(candidates_.begin(), candidates_.end(), costs_less);
    return candidates_.empty() ? nullptr : &candidates_.front().estimate;
  }

  // Whether another place near the ground, this far from the best, fits as well. After Best.
  bool IsAmbiguous(double distinct_m) const {
    const Candidate& best = candidates_.front();
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& other) {
      const Eigen::Vector3d& place = other.estimate.position_in_ecef;
      return other.cost < best.cost + kTellingCost &&
             (place - best.estimate.position_in_ecef).norm() > distinct_m &&
             std::abs(GeodeticFromEcef(place).height_m) < kFarthestFromGround_m;
    });
  }

 private:
  struct Candidate {
    double cost = 0.0;
    PointEstimate estimate;
  };

  const Problem& problem_;
  PointOptions options_;
  PointAdjustment adjustment_;
  std::vector<ObservationVerdict> verdicts_;
  std::vector<Candidate> candidates_;
};

std::vector<Eigen::Vector3d> Starts(const Problem& problem,
                                    const std::optional<Eigen::Vector3d>& start_in_ecef) {
  if (start_in_ecef) return {*start_in_ecef};
  std::vector<Eigen::Vector3d> starts = StartsAroundLandmarks(problem.observations);
  if (!starts.empty()) return starts;
  const std::optional<Eigen::Vector3d> coarse = CoarsePosition(problem.observations);
  if (coarse) starts.push_back(*coarse);
  return starts;
}

double ClockOf(const PointEstimate& estimate, std::int32_t group) {
  if (group == kNoClock) return 0.0;
  return estimate.clock_m + estimate.biases[static_cast<std::size_t>(group)].mean_m;
}

// How each range fits the place.
void Judge(const Problem& problem, const PointEstimate& estimate,
           std::vector<ObservationVerdict>* verdicts) {
  for (std::size_t i = 0; i < verdicts->size(); ++i) {
    const RangeObservation& observation = problem.observations[i];
    ObservationVerdict& verdict = (*verdicts)[i];
    verdict.residual_m = observation.range_m -
                         (observation.point_in_ecef - estimate.position_in_ecef).norm() -
                         ClockOf(estimate, observation.clock_group);
    verdict.observable = problem.IsObservable(observation);
    if (!verdict.observable) continue;
    verdict.weight = EvaluateRangeError(observation.error, verdict.residual_m).core_share;
    verdict.used = verdict.weight >= 0.5;
  }
}

// Whether those that agree are enough to prove the others wrong.
bool EnoughAgree(const Problem& problem, const std::vector<ObservationVerdict>& verdicts) {
  int observable = 0;
  int used = 0;
  for (const ObservationVerdict& verdict : verdicts) {
    observable += verdict.observable ? 1 : 0;
    used += verdict.used ? 1 : 0;
  }
  int unknowns = 3;
  for (std::size_t g = 0; g < problem.group_of.size(); ++g) {
    if (problem.members[g] > 1) ++unknowns;
  }
  return used == observable || (used > unknowns && 2 * used >= observable);
}

void FillClocks(const Problem& problem, const PointEstimate& estimate,
                const PointMatrix& covariance, const PointMatrix& cofactor,
                PointSolution* solution) {
  for (std::size_t g = 0; g < problem.group_of.size(); ++g) {
    if (problem.members[g] < 2) continue;
    const auto k = static_cast<Eigen::Index>(3 + g);
    const auto group = static_cast<std::size_t>(problem.group_of[g]);
    if (solution->clock_groups == 0) solution->tdop = std::sqrt(cofactor(k, k));
    solution->clock_groups |= 1u << group;
    solution->clock_m[group] = ClockOf(estimate, static_cast<std::int32_t>(g));
    solution->clock_sigma_m[group] = std::sqrt(covariance(k, k));
  }
}

}  // namespace

PointSolution SolvePoint(std::span<const RangeObservation> observations,
                         const std::optional<Eigen::Vector3d>& start_in_ecef,
                         std::vector<ObservationVerdict>* verdicts) {
  PointSolution solution;
  verdicts->assign(observations.size(), ObservationVerdict());
  const Problem problem(observations);
  if (static_cast<int>(observations.size()) < problem.unknowns()) return solution;

  Solver solver(problem);
  for (const Eigen::Vector3d& start : Starts(problem, start_in_ecef)) solver.Follow(start);
  const PointEstimate* best = solver.Best();
  solution.status = PointSolutionStatus::kNotConverged;
  if (best == nullptr) return solution;

  Judge(problem, *best, verdicts);
  if (!EnoughAgree(problem, *verdicts)) {
    solution.status = PointSolutionStatus::kInconsistent;
    return solution;
  }
  const auto covariance = Cofactor(problem, *verdicts, best->position_in_ecef, true);
  const auto cofactor = Cofactor(problem, *verdicts, best->position_in_ecef, false);
  if (!covariance || !cofactor) return solution;
  const double pdop = std::sqrt(cofactor->topLeftCorner<3, 3>().trace());
  if (!(pdop < kHopelessDilution)) return solution;
  const double sigma_m = std::sqrt(covariance->topLeftCorner<3, 3>().trace());
  if (!start_in_ecef && solver.IsAmbiguous(1.0 + sigma_m)) {
    solution.status = PointSolutionStatus::kAmbiguous;
    return solution;
  }

  solution.status = PointSolutionStatus::kGood;
  solution.position_in_ecef = best->position_in_ecef;
  solution.covariance_enu_m2 = covariance->topLeftCorner<3, 3>();
  solution.pdop = pdop;
  solution.hdop = std::sqrt((*cofactor)(0, 0) + (*cofactor)(1, 1));
  solution.vdop = std::sqrt((*cofactor)(2, 2));
  FillClocks(problem, *best, *covariance, *cofactor, &solution);
  for (const ObservationVerdict& verdict : *verdicts) solution.used += verdict.used ? 1 : 0;
  return solution;
}

}  // namespace lodemark
