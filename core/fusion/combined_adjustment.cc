#include "core/fusion/combined_adjustment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// What a witness fixes no better it does not know.
constexpr double kUnknownPlace_m = 1e3;

// Sigmas are never taken for more wrong than so many times.
constexpr double kLargestFactor = 10.0;

// Components are found when none changes by more, and where they are not found so soon, taken.
constexpr double kSameFactor = 0.01;
constexpr int kMostComponentRounds = 8;

// An estimate is one if every direction is known so well.
constexpr double kNoPlace_m = 1e3;

// Log density of an error of the satellites by themselves. They are given the tails of Student's t,
// with as many degrees of freedom as ranges are redundant: with none, nobody has checked them.
double LogDensity(const Eigen::Vector3d& apart_m, const Eigen::Matrix3d& covariance_m2,
                  int redundancy) {
  const double square = apart_m.dot(covariance_m2.inverse() * apart_m);
  const double freedom = 1.0 + std::max(redundancy, 0);
  return std::lgamma(0.5 * (freedom + 3.0)) - std::lgamma(0.5 * freedom) -
         1.5 * std::log(freedom * kPi) - 0.5 * std::log(covariance_m2.determinant()) -
         0.5 * (freedom + 3.0) * std::log1p(square / freedom);
}

// Log of how much likelier satellites and witness speak of one place than of two, one beside the
// other or anywhere.
double LogOddsOfOnePlace(const PointEstimate& alone, const PositionStatement& statement,
                         const CombinedOptions& options) {
  Eigen::Vector3d offset_m;
  Eigen::Matrix3d covariance_m2;
  statement.Moments(kUnknownPlace_m, &offset_m, &covariance_m2);
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(statement.around_in_ecef));
  const Eigen::Vector3d apart_m =
      offset_m + enu_from_ecef * (statement.around_in_ecef - alone.position_in_ecef);
  covariance_m2 += alone.covariance_enu_m2;
  const double one_place = LogDensity(apart_m, covariance_m2, alone.redundancy);
  const DisplacementRisk& displacement = options.displacement;
  double two_places = options.elsewhere_probability / options.elsewhere_volume_m3;
  if (displacement.probability > 0.0) {
    covariance_m2.diagonal().array() += displacement.sigma_m * displacement.sigma_m;
    two_places +=
        displacement.probability * std::exp(LogDensity(apart_m, covariance_m2, alone.redundancy));
  }
  return one_place + std::log1p(-options.elsewhere_probability - displacement.probability) -
         std::log(two_places);
}

double SigmasMoved(const PointEstimate& estimate, const Eigen::Vector3d& from_in_ecef) {
  const Eigen::Vector3d moved_m = EnuFromEcefRotation(GeodeticFromEcef(from_in_ecef)) *
                                  (estimate.position_in_ecef - from_in_ecef);
  return std::sqrt(moved_m.dot(estimate.information_pm2 * moved_m));
}

// A group as it is stated; whether its misfit, as it is stated, tells enough.
GroupScale ScaleAsStated(const GroupMisfit& misfit, double fewest) {
  return {1.0, misfit.redundancy, misfit.redundancy >= fewest && misfit.squares > 0.0};
}

// The component of one group, of the same again with its sigmas scaled by it so far.
GroupScale ScaleFrom(const GroupMisfit& misfit, const GroupScale& before) {
  GroupScale scale = before;
  scale.redundancy = misfit.redundancy;
  if (!scale.estimated || !(misfit.redundancy > 0.0) || !(misfit.squares > 0.0)) return scale;
  scale.sigma_factor = before.sigma_factor * std::sqrt(misfit.squares / misfit.redundancy);
  scale.sigma_factor = std::clamp(scale.sigma_factor, 1.0 / kLargestFactor, kLargestFactor);
  return scale;
}

bool IsPlace(const PointEstimate& estimate) {
  return estimate.covariance_enu_m2.allFinite() &&
         estimate.covariance_enu_m2.diagonal().maxCoeff() < kNoPlace_m * kNoPlace_m;
}

}  // namespace

PointStatus CombinedAdjustment::SolveAsWeighted(
    std::span<const RangeObservation> observations, const Eigen::Vector3d& start_in_ecef,
    const ClockBiases& biases, const CombinedOptions& options, PositionWitness* witness,
    CombinedEstimate* estimate, std::vector<ObservationVerdict>* verdicts) {
  *estimate = CombinedEstimate();
  const PointStatus alone = adjustment_.Solve(observations, start_in_ecef, biases, options.point,
                                              &estimate->satellites_alone, &verdicts_alone_);
  estimate->has_satellites_alone = alone == PointStatus::kGood;
  const auto without_witness = [&] {
    estimate->point = estimate->satellites_alone;
    *verdicts = verdicts_alone_;
    return alone;
  };

  if (!witness->is_proven() && !estimate->has_satellites_alone) return without_witness();
  Eigen::Vector3d point = start_in_ecef;
  PositionStatement statement = witness->At(point);
  if (!statement.information_pm2.allFinite() || statement.Rank(kUnknownPlace_m) == 0) {
    return without_witness();
  }
  if (estimate->has_satellites_alone &&
      LogOddsOfOnePlace(estimate->satellites_alone, statement, options) < 0.0) {
    estimate->witness = WitnessVerdict::kContradicted;
    return without_witness();
  }

  PointOptions point_options = options.point;
  point_options.posterior_mean = false;
  bool settled = false;
  PointStatus status = PointStatus::kNotConverged;
  while (estimate->rounds < options.most_rounds) {
    ++estimate->rounds;
    point_options.place =
        options.point.place ? Together(statement, *options.point.place) : statement;
    // The mean over the error model once the mode is found.
    point_options.posterior_mean = settled && options.point.posterior_mean;
    status =
        adjustment_.Solve(observations, point, biases, point_options, &estimate->point, verdicts);
    if (status != PointStatus::kGood) break;
    if (settled) break;
    settled = SigmasMoved(estimate->point, point) < options.converged_sigmas;
    point = estimate->point.position_in_ecef;
    statement = witness->At(point);
    if (!statement.information_pm2.allFinite() || statement.Rank(kUnknownPlace_m) == 0) break;
  }
  const bool agrees = witness->Agrees();
  if (status != PointStatus::kGood || !settled || !agrees || !IsPlace(estimate->point)) {
    if (!agrees) estimate->witness = WitnessVerdict::kDisagreeing;
    // The witness alone leads nowhere: where satellites do, it is left out.
    if (estimate->has_satellites_alone) return without_witness();
    return status == PointStatus::kGood ? PointStatus::kNotConverged : status;
  }
  estimate->witness = WitnessVerdict::kUsed;
  WidenByParts(*witness, statement, options.displacement,
               estimate->has_satellites_alone ? &estimate->satellites_alone : nullptr,
               options.point.integrity_risk, &estimate->point);
  return PointStatus::kGood;
}

// Helmert's components, simplified to one factor a group: its squared residuals against what they
// should be, the adjustment done again, until both agree.
PointStatus CombinedAdjustment::Solve(std::span<const RangeObservation> observations,
                                      const Eigen::Vector3d& start_in_ecef,
                                      const ClockBiases& biases, const CombinedOptions& options,
                                      PositionWitness* witness, CombinedEstimate* estimate,
                                      std::vector<ObservationVerdict>* verdicts) {
  CombinedOptions asked = options;
  asked.point.misfit = options.estimate_variance_components;
  PointStatus status =
      SolveAsWeighted(observations, start_in_ecef, biases, asked, witness, estimate, verdicts);
  const bool has_both = status == PointStatus::kGood && estimate->witness == WitnessVerdict::kUsed;
  if (!options.estimate_variance_components || !has_both) return status;
  GroupScale satellites;
  GroupScale landmarks;
  for (int round = 0; round < kMostComponentRounds; ++round) {
    if (status != PointStatus::kGood || estimate->witness != WitnessVerdict::kUsed) break;
    const PointEstimate& point = estimate->point;
    const double satellite_factor = satellites.sigma_factor;
    const double landmark_factor = landmarks.sigma_factor;
    const GroupMisfit of_landmarks =
        witness->MisfitBeside(point.information_pm2 - point.stated_information_pm2);
    if (round == 0) {
      satellites = ScaleAsStated(point.misfit, options.fewest_for_component);
      landmarks = ScaleAsStated(of_landmarks, options.fewest_for_component);
    }
    satellites = ScaleFrom(point.misfit, satellites);
    landmarks = ScaleFrom(of_landmarks, landmarks);
    const bool same =
        std::abs(satellites.sigma_factor - satellite_factor) < kSameFactor * satellite_factor &&
        std::abs(landmarks.sigma_factor - landmark_factor) < kSameFactor * landmark_factor;
    if (same) break;
    scaled_.assign(observations.begin(), observations.end());
    for (RangeObservation& range : scaled_) range.error.sigma_m *= satellites.sigma_factor;
    witness->ScaleSigmas(landmarks.sigma_factor);
    const Eigen::Vector3d near_by = point.position_in_ecef;
    status = SolveAsWeighted(scaled_, near_by, biases, asked, witness, estimate, verdicts);
  }
  if (status != PointStatus::kGood || estimate->witness != WitnessVerdict::kUsed) {
    // Nothing to tell components from: as stated.
    witness->ScaleSigmas(1.0);
    return SolveAsWeighted(observations, start_in_ecef, biases, asked, witness, estimate, verdicts);
  }
  estimate->satellite_scale = satellites;
  estimate->landmark_scale = landmarks;
  return status;
}

}  // namespace lodemark
