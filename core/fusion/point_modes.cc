#include "core/fusion/point_modes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/adjustment/distributions.h"
#include "core/fusion/range_error.h"

namespace lodemark {
namespace {

// Rows more than expected that noise does not explain, beyond which the approach is in doubt, and
// how many of the rows it hangs on are then left out in turn.
constexpr double kSurprising = 1.5;
constexpr std::size_t kSuspects = 3;

constexpr double kConverged_m = 1e-4;
constexpr double kSmallGain = 1e-6;  // of -log density, with a step of centimetres
// Ranges to satellites are rounded to 4e-9 m, and the cost that follows from thirty of them to some
// 1e-9. Whether it fell by less is chance, which must not shorten a step.
constexpr double kCostRounding = 1e-7;

// A mode this near in every direction, in sigmas, is the same.
constexpr double kSameMode = 0.1;

// Rejected rows that are believed in turn, and the share of a row's information that none but it
// gives, beyond which the state hangs on it.
constexpr std::size_t kMostBelieved = 6;
constexpr double kMuchLeverage = 0.4;

// Rows that an approach treats apart, or null.
struct Hearing {
  const PointProblem::Row* left_out = nullptr;  // not heard
  const PointProblem::Row* believed = nullptr;  // taken for noise, whatever it says
};

// Cauchy weights whose width shrinks step by step (graduated non-convexity), late errors held
// more suspect than early ones.
double GraduatedWeight(double residual_m, double sigma_m, double width) {
  const double side = residual_m > 0.0 ? 0.7 : 1.3;
  const double u = residual_m / (side * width * sigma_m);
  return 1.0 / (sigma_m * sigma_m * (1.0 + u * u));
}

double Cost(const PointProblem& problem) {
  double cost = problem.PriorCost();
  for (const PointProblem::Row& row : problem.rows()) {
    cost -= std::log(RangeErrorDensity(row.error, problem.Residual(row)));
  }
  return cost;
}

bool ApproachHearing(PointProblem* problem, bool robust, const Hearing& hearing) {
  const auto solve = [&](double width) {
    Normals normals(problem->unknowns());
    for (const PointProblem::Row& row : problem->rows()) {
      if (&row == hearing.left_out) continue;
      const double residual_m = problem->Residual(row);
      const double weight = &row == hearing.believed
                                ? 1.0 / (row.error.sigma_m * row.error.sigma_m)
                                : GraduatedWeight(residual_m, row.error.sigma_m, width);
      problem->Accumulate(row, weight, weight * residual_m, &normals.matrix, &normals.right);
    }
    problem->AccumulatePriors(&normals.matrix, &normals.right);
    PointVector step;
    if (!normals.Solve(&step)) return -1.0;
    problem->Step(step);
    return step.head<3>().norm();
  };
  for (int i = 0; i < 12; ++i) {
    const double moved_m = solve(1e9);
    if (moved_m < 0.0 || moved_m > 1e8) return false;
    if (moved_m < 1.0) break;
  }
  if (!robust) return true;
  // Begin where the worst residual is not yet suspect.
  double worst = 0.0;
  for (const PointProblem::Row& row : problem->rows()) {
    if (&row == hearing.left_out) continue;
    worst = std::max(worst, std::abs(problem->Residual(row)) / row.error.sigma_m);
  }
  for (double width = std::clamp(worst, 16.0, 1e7); width > 1.5; width *= 0.6) {
    if (solve(width) < 0.0) return false;
  }
  return true;
}

// How many more rows than expected are likelier anything but noise.
double Surprise(const PointProblem& problem) {
  double surprise = 0.0;
  for (const PointProblem::Row& row : problem.rows()) {
    surprise += 1.0 - EvaluateRangeError(row.error, problem.Residual(row)).core_share;
    surprise -= row.error.late_probability;
  }
  return surprise;
}

// The rows that hold the present state most, by what their information is worth to it.
std::array<const PointProblem::Row*, kSuspects> Suspects(const PointProblem& problem) {
  std::array<const PointProblem::Row*, kSuspects> suspects = {};
  std::array<double, kSuspects> leverages = {};
  Normals normals(problem.unknowns());
  ModelNormals(problem, &normals.matrix, &normals.right);
  const Eigen::LLT<PointMatrix, Eigen::Upper> factor(normals.matrix);
  if (factor.info() != Eigen::Success) return suspects;
  for (const PointProblem::Row& row : problem.rows()) {
    const PointVector slope = problem.Slope(row);
    const double core_share = EvaluateRangeError(row.error, problem.Residual(row)).core_share;
    const PointVector gain = factor.solve(slope);
    double leverage = core_share * slope.dot(gain) / (row.error.sigma_m * row.error.sigma_m);
    const PointProblem::Row* suspect = &row;
    for (std::size_t i = 0; i < kSuspects; ++i) {
      if (leverage <= leverages[i]) continue;
      std::swap(leverage, leverages[i]);
      std::swap(suspect, suspects[i]);
    }
  }
  return suspects;
}

// How else to hear the rows if some are rejected at the present state; none otherwise. The rows are
// shared between copies of a problem: all this is found out before the first move.
std::size_t WaysElsewhere(const PointProblem& problem,
                          std::array<Hearing, OtherModes::kMost>* ways) {
  std::size_t count = 0;
  for (const PointProblem::Row& row : problem.rows()) {
    if (count == kMostBelieved) break;
    const double core_share = EvaluateRangeError(row.error, problem.Residual(row)).core_share;
    if (core_share < 0.5 && problem.IsObservable(row)) (*ways)[count++] = {nullptr, &row};
  }
  if (count == 0) return 0;
  Normals normals(problem.unknowns());
  ModelNormals(problem, &normals.matrix, &normals.right);
  const Eigen::LLT<PointMatrix, Eigen::Upper> factor(normals.matrix);
  if (factor.info() != Eigen::Success) return count;
  for (const PointProblem::Row& row : problem.rows()) {
    if (count == ways->size()) break;
    if (!problem.IsObservable(row)) continue;
    const PointVector slope = problem.Slope(row);
    const PointVector gain = factor.solve(slope);
    const double core_share = EvaluateRangeError(row.error, problem.Residual(row)).core_share;
    const double leverage = core_share * slope.dot(gain) / (row.error.sigma_m * row.error.sigma_m);
    if (leverage > kMuchLeverage) (*ways)[count++] = {&row, nullptr};
  }
  return count;
}

}  // namespace

void ModelNormals(const PointProblem& problem, PointMatrix* normal, PointVector* right) {
  constexpr double kFloor = 0.05;
  for (const PointProblem::Row& row : problem.rows()) {
    const RangeErrorTerms terms = EvaluateRangeError(row.error, problem.Residual(row));
    const double information = 1.0 / (row.error.sigma_m * row.error.sigma_m);
    problem.Accumulate(row, information * std::max(terms.core_share, kFloor), terms.slope_pm,
                       normal, right);
  }
  problem.AccumulatePriors(normal, right);
}

bool Approach(PointProblem* problem, bool robust) { return ApproachHearing(problem, robust, {}); }

int Descend(PointProblem* problem, int largest_iterations) {
  double cost = Cost(*problem);
  for (int i = 1; i <= largest_iterations; ++i) {
    Normals normals(problem->unknowns());
    ModelNormals(*problem, &normals.matrix, &normals.right);
    PointVector step;
    if (!normals.Solve(&step)) return -1;
    const Eigen::Vector3d point = problem->point_in_ecef();
    const PointVector clocks = problem->clock_state();
    const double zenith_delay_m = problem->zenith_delay_m();
    double scale = 1.0;
    double new_cost = cost;
    bool better = false;
    for (int halving = 0; halving < 6; ++halving, scale *= 0.4) {
      problem->clock_state() = clocks;
      problem->zenith_delay_m() = zenith_delay_m;
      problem->MoveTo(point);
      problem->Step(scale * step);
      new_cost = Cost(*problem);
      if (new_cost <= cost + kCostRounding) {
        better = true;
        break;
      }
    }
    if (!better) {
      problem->clock_state() = clocks;
      problem->zenith_delay_m() = zenith_delay_m;
      problem->MoveTo(point);
      return i;
    }
    const double gain = cost - new_cost;
    cost = new_cost;
    if (scale * step.norm() < kConverged_m || (gain < kSmallGain && scale * step.norm() < 0.02)) {
      return i;
    }
  }
  return largest_iterations;
}

void Reconsider(PointProblem* problem, int largest_iterations) {
  if (Surprise(*problem) <= kSurprising) return;
  PointProblem best = *problem;
  double least = Cost(best);
  for (const PointProblem::Row* suspect : Suspects(*problem)) {
    if (suspect == nullptr || !ApproachHearing(problem, true, {suspect, nullptr})) continue;
    if (Descend(problem, largest_iterations) < 0) continue;
    const double cost = Cost(*problem);
    if (!(cost < least)) continue;
    least = cost;
    best = *problem;
  }
  *problem = best;
  problem->MoveTo(problem->point_in_ecef());  // the rows are shared
}

OtherModes FindOtherModes(PointProblem* problem, int largest_iterations, double risk) {
  OtherModes others;
  PointProblem best = *problem;
  const double least = Cost(best);
  std::array<Hearing, OtherModes::kMost> ways;
  const std::size_t count = WaysElsewhere(best, &ways);
  for (std::size_t i = 0; i < count; ++i) {
    *problem = best;
    problem->MoveTo(best.point_in_ecef());
    if (!ApproachHearing(problem, true, ways[i])) continue;
    if (Descend(problem, largest_iterations) < 0) continue;
    if (Cost(*problem) - least > -std::log(risk)) continue;
    Normals normals(problem->unknowns());
    ModelNormals(*problem, &normals.matrix, &normals.right);
    const Eigen::LLT<PointMatrix, Eigen::Upper> factor(normals.matrix);
    if (factor.info() != Eigen::Success) continue;
    OtherModes::Mode& mode = others.modes[others.count];
    mode.point_in_ecef = problem->point_in_ecef();
    mode.covariance_enu_m2 =
        factor.solve(PointMatrix::Identity(problem->unknowns(), problem->unknowns()))
            .topLeftCorner<3, 3>();
    const Eigen::Vector3d apart_m =
        problem->enu_from_ecef() * (mode.point_in_ecef - best.point_in_ecef());
    const bool same =
        (apart_m.array().abs() < kSameMode * mode.covariance_enu_m2.diagonal().array().sqrt())
            .all();
    if (!same) ++others.count;
  }
  *problem = best;
  if (count > 0) problem->MoveTo(best.point_in_ecef());
  return others;
}

void WidenToModes(const OtherModes& others, const PointProblem& problem, double spread_factor,
                  double risk, ProtectionLevels* levels) {
  const double rows = static_cast<double>(problem.rows().size()) + 1.0;
  const double quantile = spread_factor * -NormalQuantile(0.5 * risk / rows);
  for (const OtherModes::Mode& mode : others.found()) {
    const Eigen::Vector3d apart_m =
        problem.enu_from_ecef() * (mode.point_in_ecef - problem.point_in_ecef());
    const double horizontal_m =
        apart_m.head<2>().norm() + quantile * HorizontalSigma(mode.covariance_enu_m2);
    const double vertical_m =
        std::abs(apart_m.z()) + quantile * std::sqrt(mode.covariance_enu_m2(2, 2));
    if (levels->horizontal_m > 0.0) {
      levels->horizontal_m = std::max(levels->horizontal_m, horizontal_m);
    }
    if (levels->vertical_m > 0.0) levels->vertical_m = std::max(levels->vertical_m, vertical_m);
  }
}

}  // namespace lodemark
