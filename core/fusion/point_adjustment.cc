#include "core/fusion/point_adjustment.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/fusion/point_modes.h"
#include "core/fusion/protection.h"
#include "core/fusion/range_error.h"

namespace lodemark {
namespace {

// Ranges in doubt, in sum of probabilities, below which mode and mean are one. Where a range is as
// good as certainly a gross error, none of the places in question explains it: it weighs them
// alike.
constexpr double kDoubtful = 0.5;

// So few ranges beyond what determines the unknowns.
constexpr int kHardlyRedundant = 2;

// Reflections last and come in families, so an epoch with many tells less than independent errors
// would: the covariance grows by this much times their share.
constexpr double kReflectionsAlike = 3.0;

// Ranges, in sum of probabilities, that must fit the error model beyond those that determine the
// unknowns, as far as there are more: any three spheres and a clock meet somewhere. The slack is
// for what even good ranges lack to certainty.
constexpr double kAgreeingBeyondNeeded = 1.0;
constexpr double kAgreementSlack = 0.5;

// Ranges that must be likelier noise than anything else, in sum of probabilities. Where a receiver
// has hardly a lock, the error model can explain everything as late and still be tens of
// kilometres off; then none of its ranges looks like ordinary noise.
constexpr double kFewestOrdinary = 2.0;

// What a statement about the place fixes no better it does not know.
constexpr double kUnknownPlace_m = 1e3;

// A proposal for the sampling where the place is known from elsewhere: no more than a few times as
// wide as that knowledge.
Eigen::Matrix4d NoWiderThan(const PositionStatement& place, const Eigen::Matrix4d& proposal) {
  constexpr double kWidth = 6.0;
  Eigen::Matrix4d information = proposal.inverse();
  information.topLeftCorner<3, 3>() += place.information_pm2 / kWidth;
  return information.inverse();
}

// What the uncertainty of the unknowns that the sampling holds adds to the covariance of those that
// it does not (law of total covariance). covariance: of all unknowns, at the mode.
Eigen::Matrix4d FromHeldUnknowns(const PointProblem& problem, const PointMatrix& covariance) {
  std::array<Eigen::Index, kMaxPointUnknowns> held = {};
  Eigen::Index count = 0;
  for (int k = 4; k < problem.unknowns(); ++k) {
    const int clock = k - 3;
    if (clock >= problem.clocks() || problem.IsShared(clock)) {
      held[static_cast<std::size_t>(count++)] = k;
    }
  }
  if (count == 0) return Eigen::Matrix4d::Zero();
  PointMatrix of_held(count, count);
  PointMatrix with_sampled(count, 4);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = held[static_cast<std::size_t>(i)];
    with_sampled.row(i) = covariance.block<1, 4>(k, 0);
    for (Eigen::Index j = 0; j < count; ++j) {
      of_held(i, j) = covariance(k, held[static_cast<std::size_t>(j)]);
    }
  }
  const Eigen::LDLT<PointMatrix> factor(of_held);
  const PointMatrix gain = factor.solve(with_sampled);
  return with_sampled.transpose() * gain;
}

// information: the normal matrix; weights: the information of each row in it.
GroupMisfit MisfitOf(const PointProblem& problem, const PointMatrix& information,
                     std::span<const double> weights) {
  const Eigen::LLT<PointMatrix, Eigen::Upper> factor(information);
  if (factor.info() != Eigen::Success) return {};
  GroupMisfit misfit;
  for (std::size_t i = 0; i < problem.rows().size(); ++i) {
    const PointProblem::Row& row = problem.rows()[i];
    const PointVector slope = problem.Slope(row);
    const PointVector gain = factor.solve(slope);
    const double residual_m = problem.Residual(row);
    const double share = weights[i] * row.error.sigma_m * row.error.sigma_m;
    misfit.squares += weights[i] * residual_m * residual_m;
    misfit.redundancy += share * std::max(1.0 - weights[i] * slope.dot(gain), 0.0);
  }
  return misfit;
}

}  // namespace

PointStatus PointAdjustment::Solve(std::span<const RangeObservation> observations,
                                   const Eigen::Vector3d& start_in_ecef, const ClockBiases& biases,
                                   const PointOptions& options, PointEstimate* estimate,
                                   std::vector<ObservationVerdict>* verdicts) {
  *estimate = PointEstimate();
  verdicts->assign(observations.size(), ObservationVerdict());
  PointProblem problem(observations, biases, options.height, &rows_);
  problem.Believe(options.place);
  if (options.zenith_delay_sigma_m > 0.0) {
    problem.EstimateZenithDelay(options.zenith_delay_sigma_m);
  }
  problem.MoveTo(start_in_ecef);
  problem.GuessClocks();

  // Groups nobody knows take one observation each to find their clock.
  int redundancy = static_cast<int>(observations.size()) - 3 + (options.height ? 1 : 0);
  for (int clock = 0; clock < problem.clocks(); ++clock) {
    if (clock == 0 || problem.prior_sigma_m(clock) > kUnknownBias_m) --redundancy;
  }
  const int stated = options.place ? options.place->Rank(kUnknownPlace_m) : 0;
  redundancy += stated;
  estimate->redundancy = redundancy;
  if (redundancy < 0 || (observations.empty() && stated < 3)) {
    return estimate->status = PointStatus::kTooFew;
  }

  if (!Approach(&problem, redundancy > 0)) {
    return estimate->status = PointStatus::kNotConverged;
  }
  estimate->iterations = Descend(&problem, options.largest_iterations);
  if (estimate->iterations < 0) return estimate->status = PointStatus::kNotConverged;
  if (redundancy > 1) Reconsider(&problem, options.largest_iterations);

  // Information at the mode.
  Normals normals(problem.unknowns());
  ModelNormals(problem, &normals.matrix, &normals.right);
  const Eigen::LLT<PointMatrix, Eigen::Upper> factor(normals.matrix);
  if (factor.info() != Eigen::Success) return estimate->status = PointStatus::kNotConverged;
  const PointMatrix covariance =
      factor.solve(PointMatrix::Identity(problem.unknowns(), problem.unknowns()));
  estimate->covariance_enu_m2 = covariance.topLeftCorner<3, 3>();
  estimate->information_pm2 = estimate->covariance_enu_m2.inverse();
  if (options.place) estimate->stated_information_pm2 = options.place->information_pm2;
  estimate->clock_variance_m2 = problem.clocks() > 0 ? covariance(3, 3) : 0.0;

  double doubtful = 0.0;
  for (const PointProblem::Row& row : problem.rows()) {
    const RangeErrorTerms terms = EvaluateRangeError(row.error, problem.Residual(row));
    const double gross_share = 1.0 - terms.core_share - terms.late_share;
    doubtful += 1.0 - std::max(terms.core_share, gross_share);
  }
  // Samples go to the other modes by themselves; where hardly a range contradicts, too few do.
  const bool asks_elsewhere = options.posterior_mean && redundancy > 0;
  const bool samples = asks_elsewhere && problem.clocks() > 0 && doubtful > kDoubtful;
  OtherModes others;
  if (asks_elsewhere && (!samples || redundancy <= kHardlyRedundant)) {
    others = FindOtherModes(&problem, options.largest_iterations, options.integrity_risk);
  }
  if (samples) {
    if (!sampling_ || samples_ != options.posterior_samples) {
      samples_ = options.posterior_samples;
      sampling_.emplace(samples_);
    }
    Eigen::Matrix4d proposal = 6.0 * covariance.topLeftCorner<4, 4>();
    proposal += Eigen::Vector4d(25.0, 25.0, 50.0, 25.0).asDiagonal();
    if (options.place) proposal = NoWiderThan(*options.place, proposal);
    const PosteriorMoments moments = sampling_->Run(problem, proposal);
    if (moments.effective_samples > 4.0 && moments.mean.allFinite()) {
      PointVector step = PointVector::Zero(problem.unknowns());
      step.head<4>() = moments.mean;
      problem.Step(step);
      const Eigen::Matrix4d sum = moments.covariance + FromHeldUnknowns(problem, covariance);
      estimate->covariance_enu_m2 = sum.topLeftCorner<3, 3>();
      estimate->clock_variance_m2 = sum(3, 3);
    }
  }

  estimate->position_in_ecef = problem.point_in_ecef();
  estimate->zenith_delay_m = problem.zenith_delay_m();
  const double pivot_bias_m = problem.clocks() > 0 ? biases[problem.group(0)].mean_m : 0.0;
  estimate->clock_m = problem.clocks() > 0 ? problem.clock_state()[0] - pivot_bias_m : 0.0;
  for (int clock = 0; clock < problem.clocks(); ++clock) {
    const int group = problem.group(clock);
    estimate->groups_seen |= 1u << group;
    ClockBias& bias = estimate->biases[static_cast<std::size_t>(group)];
    bias = biases[group];
    if (clock == 0) continue;
    const double sigma_m =
        std::sqrt(covariance(3 + clock, 3 + clock) +
                  biases[problem.group(0)].sigma_m * biases[problem.group(0)].sigma_m);
    if (sigma_m < bias.sigma_m) {
      bias = {pivot_bias_m + problem.clock_state()[clock], sigma_m};
    }
  }

  double explained = 0.0;  // rows whose error is noise or a reflection
  double ordinary = 0.0;   // rows whose error is noise
  double late = 0.0;
  weights_.assign(observations.size(), 0.0);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const PointProblem::Row& row = problem.rows()[i];
    ObservationVerdict& verdict = (*verdicts)[i];
    verdict.residual_m = problem.Residual(row);
    const RangeErrorTerms terms = EvaluateRangeError(row.error, verdict.residual_m);
    verdict.weight = terms.core_share;
    verdict.late_share = terms.late_share;
    verdict.used = verdict.weight >= 0.5;
    verdict.observable = problem.IsObservable(row);
    if (verdict.used) ++estimate->used;
    explained += terms.core_share + terms.late_share;
    ordinary += terms.core_share;
    late += terms.late_share;
    weights_[i] = terms.core_share / (row.error.sigma_m * row.error.sigma_m);
  }
  const double needed = static_cast<double>(observations.size()) - redundancy;
  const double beyond = std::min(kAgreeingBeyondNeeded, 0.5 * redundancy) - kAgreementSlack;
  // A place that is stated whole needs no range to agree with it.
  if (stated < 3 && (explained < needed + beyond || ordinary < kFewestOrdinary)) {
    return estimate->status = PointStatus::kInconsistent;
  }

  // Where the place is known from elsewhere, reflections matter as far as ranges do.
  const double from_place =
      options.place
          ? (covariance.topLeftCorner<3, 3>() * options.place->information_pm2).trace() / 3.0
          : 0.0;
  const double late_share = late / std::max(1.0, static_cast<double>(observations.size()));
  const double growth = 1.0 + kReflectionsAlike * late_share * std::max(1.0 - from_place, 0.0);
  estimate->covariance_growth = growth;
  estimate->covariance_enu_m2 *= growth;
  estimate->clock_variance_m2 *= growth;
  Normals at_solution(problem.unknowns());
  ModelNormals(problem, &at_solution.matrix, &at_solution.right);
  if (options.misfit) estimate->misfit = MisfitOf(problem, at_solution.matrix, weights_);
  const double trace_m2 = covariance.topLeftCorner<3, 3>().trace();
  const double spread_factor =
      std::sqrt(std::max(1.0, estimate->covariance_enu_m2.trace() / trace_m2));
  ProtectionLevels levels = SeparationLevels(problem, at_solution.matrix, weights_, spread_factor,
                                             options.integrity_risk);
  WidenToModes(others, problem, spread_factor, options.integrity_risk, &levels);
  estimate->protection_level_m = levels.horizontal_m;
  estimate->vertical_protection_level_m = levels.vertical_m;
  const DilutionOfPrecision dilution = Dilution(problem, weights_, kUnknownBias_m);
  estimate->hdop = dilution.horizontal;
  estimate->vdop = dilution.vertical;
  estimate->pdop = dilution.position;
  estimate->tdop = dilution.time;
  return estimate->status = PointStatus::kGood;
}

}  // namespace lodemark
