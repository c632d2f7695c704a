#include "core/session/epoch_solver.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/fusion/coarse_position.h"
#include "core/geo/geodetic.h"
#include "core/session/distinct_satellites.h"
#include "core/session/lost_place.h"
#include "core/session/redundancy.h"
#include "core/session/stated_accuracy.h"

namespace lodemark {
namespace {

constexpr double kFarFromStart_m = 1000.0;

// What the errors of orbits, clocks and atmosphere have in common moves a position whatever the
// residuals say: 1 sigma east, north, up.
const Eigen::Vector3d kCommon_m(0.5, 0.5, 1.0);

// Satellites that a position takes at least, with a height known from elsewhere or not.
constexpr int kFewestSatellites = 4;

// What a tropospheric model leaves in the zenith at worst, and what there is without one.
constexpr double kZenithDelaySigma_m = 0.2;
constexpr double kWholeZenithDelay_m = 2.5;

void FillPlace(const Eigen::Vector3d& position_in_ecef, const Eigen::Matrix3d& covariance_enu_m2,
               const Eigen::Matrix3d& by_ranges, SessionEstimate* estimate) {
  estimate->position_in_ecef = position_in_ecef;
  estimate->position = GeodeticFromEcef(position_in_ecef);
  // What is common to all ranges moves the position as far as it rests on them.
  estimate->covariance_enu_m2 =
      covariance_enu_m2 + by_ranges * kCommon_m.cwiseAbs2().asDiagonal() * by_ranges.transpose();
}

EstimateStatus StatusOf(PointStatus status) {
  switch (status) {
    case PointStatus::kGood:
      return EstimateStatus::kFix;
    case PointStatus::kTooFew:
      return EstimateStatus::kTooFewSatellites;
    case PointStatus::kNotConverged:
      return EstimateStatus::kNotConverged;
    case PointStatus::kInconsistent:
      break;
  }
  return EstimateStatus::kInconsistent;
}

SatelliteVerdict VerdictOf(const ObservationVerdict& verdict) {
  if (!verdict.observable) return SatelliteVerdict::kUnobservable;
  if (verdict.weight >= 0.5) return SatelliteVerdict::kUsed;
  return verdict.weight >= 0.1 ? SatelliteVerdict::kDownWeighted : SatelliteVerdict::kOutlier;
}

PhotoOutcome OutcomeOf(WitnessVerdict verdict) {
  switch (verdict) {
    case WitnessVerdict::kUsed:
      return PhotoOutcome::kUsed;
    case WitnessVerdict::kContradicted:
      return PhotoOutcome::kContradicted;
    case WitnessVerdict::kDisagreeing:
      return PhotoOutcome::kDisagreeing;
    case WitnessVerdict::kNothing:
      break;
  }
  return PhotoOutcome::kNotRecognised;
}

// Whether it is orbits that are missing for a position, not measurements.
bool LacksOrbits(std::span<const SatelliteStatus> statuses) {
  DistinctSatellites with_orbit;
  DistinctSatellites measured;
  for (const SatelliteStatus& status : statuses) {
    if (status.verdict == SatelliteVerdict::kSystemOff ||
        status.verdict == SatelliteVerdict::kNotTracking ||
        status.verdict == SatelliteVerdict::kUnknownSignal) {
      continue;
    }
    measured.Add(status.satellite);
    if (status.verdict != SatelliteVerdict::kNoEphemeris &&
        status.verdict != SatelliteVerdict::kEphemerisTooOld) {
      with_orbit.Add(status.satellite);
    }
  }
  return with_orbit.count() < kFewestSatellites && measured.count() >= kFewestSatellites;
}

}  // namespace

EpochSolver::EpochSolver(const SessionOptions& options, const SensorBuffer* sensors)
    : options_(options),
      model_(options),
      weights_(options),
      filter_(options.estimator == Estimator::kSmoother, sensors) {}

void EpochSolver::Solve(const ObservationEpoch& epoch, const PhotoPart& photo,
                        SessionEstimate* estimate, std::vector<SatelliteStatus>* statuses) {
  if (last_gps_ns_ != 0 && epoch.time_gps_ns > last_gps_ns_) {
    biases_.Advance(1e-9 * static_cast<double>(epoch.time_gps_ns - last_gps_ns_));
  }
  last_gps_ns_ = epoch.time_gps_ns;
  statuses->assign(epoch.signals.size(), SatelliteStatus());
  estimate->status = SolvePosition(estimate->time_ns, epoch, photo, statuses);
  estimate->photo = photo_;
  if (estimate->status == EstimateStatus::kTooFewSatellites && LacksOrbits(*statuses)) {
    estimate->status = EstimateStatus::kNoEphemeris;
  }
  if (estimate->status != EstimateStatus::kFix) {
    last_place_in_ecef_.reset();
    Coast(estimate);
    return;
  }
  if (filters()) {
    LookForLostFilter(point_.position_in_ecef, PointOptionsAt(epoch.time_gps_ns));
    filter_.HearEpoch(model_, point_, verdicts_);
    filter_.Remember(ranges_, biases_, PointOptionsAt(epoch.time_gps_ns));
  }
  last_place_in_ecef_ = point_.position_in_ecef;
  // So few ranges only help what the motion carries on.
  if (filters() && ranges_.size() < static_cast<std::size_t>(kFewestSatellites) &&
      !Coast(estimate)) {
    estimate->status = EstimateStatus::kTooFewSatellites;
    return;
  }
  FillPosition(estimate);
  Judge(estimate, statuses);
  SolveVelocity(estimate, statuses);
  Learn();
  if (options_.height_memory) height_.Learn(*estimate);
}

PointOptions EpochSolver::PointOptionsAt(std::int64_t time_gps_ns) const {
  PointOptions point_options;
  if (options_.height_memory) point_options.height = height_.At(time_gps_ns);
  if (options_.estimate_zenith_delay) {
    point_options.zenith_delay_sigma_m = options_.troposphere == TroposphereChoice::kNone
                                             ? kWholeZenithDelay_m
                                             : kZenithDelaySigma_m;
  }
  return point_options;
}

EstimateStatus EpochSolver::SolvePosition(std::int64_t time_ns, const ObservationEpoch& epoch,
                                          const PhotoPart& photo,
                                          std::vector<SatelliteStatus>* statuses) {
  photo_ = PhotoOutcome::kNone;
  modelled_ = false;
  model_.FindSatellites(epoch, orbits_, statuses);
  model_.NoteStrengths(epoch, &weights_);
  const std::vector<double>& disagreements_m = code_rate_.Update(epoch);
  std::optional<Eigen::Vector3d> place = last_place_in_ecef_;
  if (filters() && filter_.started()) place = filter_.PlaceAt(time_ns);
  if (!place) place = CoarsePosition(model_.CoarseRanges(epoch));
  if (!place) place = photo.start_in_ecef;
  if (!place) return EstimateStatus::kTooFewSatellites;
  PointOptions point_options = PointOptionsAt(epoch.time_gps_ns);
  PointStatus status = PointStatus::kTooFew;
  for (int pass = 0; pass < 3; ++pass) {
    model_.Model(epoch, *place, ionosphere_, weights_, disagreements_m, statuses);
    modelled_ = true;
    if (filters() && pass == 0) {
      filter_.Advance(time_ns, epoch, model_);
      point_options.place = filter_.Place();
    }
    status = Adjust(*place, photo, options_.scheme != Scheme::kVision, point_options);
    if (status != PointStatus::kGood) break;
    const double moved_m = (point_.position_in_ecef - *place).norm();
    place = point_.position_in_ecef;
    if (moved_m < kFarFromStart_m) break;
  }
  return StatusOf(status);
}

PointStatus EpochSolver::Adjust(const Eigen::Vector3d& place, const PhotoPart& photo,
                                bool with_epoch, const PointOptions& options) {
  ranges_.clear();
  if (with_epoch) ranges_.insert(ranges_.end(), model_.ranges().begin(), model_.ranges().end());
  satellite_ranges_ = ranges_.size();
  ranges_.insert(ranges_.end(), photo.ranges.begin(), photo.ranges.end());
  const Eigen::Vector3d start = photo.start_in_ecef.value_or(place);
  combined_ = CombinedEstimate();
  if (photo.witness == nullptr) {
    const PointStatus status = adjustment_.Solve(ranges_, photo.ranges.empty() ? place : start,
                                                 biases_, options, &point_, &verdicts_);
    photo_ = photo.ranges.empty() ? PhotoOutcome::kNone : PhotoOutcome::kUsed;
    return status;
  }
  CombinedOptions combined_options;
  combined_options.point = options;
  combined_options.estimate_variance_components = options_.estimate_variance_components;
  const PointStatus status = combined_adjustment_.Solve(ranges_, start, biases_, combined_options,
                                                        photo.witness, &combined_, &verdicts_);
  point_ = combined_.point;
  photo_ = OutcomeOf(combined_.witness);
  return status;
}

void EpochSolver::SolvePhoto(const PhotoPart& photo, bool with_epoch, SessionEstimate* estimate) {
  photo_ = PhotoOutcome::kNone;
  const bool carried = filters() && filter_.started();
  std::optional<Eigen::Vector3d> place =
      photo.start_in_ecef ? photo.start_in_ecef : last_place_in_ecef_;
  if (!place && carried) place = filter_.position_in_ecef();
  PointStatus status = PointStatus::kTooFew;
  if (place && !photo.empty()) {
    PointOptions point_options = PointOptionsAt(last_gps_ns_);
    // The filter has heard the epoch.
    if (carried) point_options.place = filter_.Place();
    status = Adjust(*place, photo, with_epoch && modelled_ && !carried, point_options);
  }
  estimate->status = StatusOf(status);
  estimate->photo = photo_;
  if (filters() && estimate->status == EstimateStatus::kFix && photo_ == PhotoOutcome::kUsed) {
    filter_.HearPhoto(estimate->time_ns, photo.taken_ns, point_);
  }
  if (estimate->status != EstimateStatus::kFix) {
    Coast(estimate);
    return;
  }
  FillPosition(estimate);
  DistinctSatellites used;
  for (std::size_t i = 0; i < satellite_ranges_; ++i) {
    if (verdicts_[i].used && verdicts_[i].observable) {
      used.Add(model_.used_signals()[i].satellite_id);
    }
  }
  estimate->satellites_used = used.count();
}

std::int64_t EpochSolver::MomentFor(std::int64_t time_ns, std::int64_t reach_ns) {
  if (!filter_.started()) return time_ns;
  if (std::abs(time_ns - filter_.time_ns()) <= reach_ns) return filter_.time_ns();
  if (time_ns > filter_.time_ns()) filter_.Advance(time_ns);
  return filter_.time_ns();
}

std::span<const ObservationVerdict> EpochSolver::visual_verdicts() const {
  if (verdicts_.size() < satellite_ranges_) return {};
  return std::span<const ObservationVerdict>(verdicts_).subspan(satellite_ranges_);
}

void EpochSolver::FillPosition(SessionEstimate* estimate) const {
  if (filters()) {
    FillFromFilter(estimate);
  } else {
    const Eigen::Matrix3d by_ranges =
        Eigen::Matrix3d::Identity() -
        point_.information_pm2.inverse() * point_.stated_information_pm2;
    FillPlace(point_.position_in_ecef, point_.covariance_enu_m2, by_ranges, estimate);
    StateAccuracy(estimate);
    const Eigen::Vector3d common_m = (by_ranges * kCommon_m.asDiagonal()).rowwise().norm();
    if (point_.protection_level_m > 0.0) {
      estimate->protection_level_m = point_.protection_level_m + common_m.head<2>().maxCoeff();
    }
    if (point_.vertical_protection_level_m > 0.0) {
      estimate->vertical_protection_level_m = point_.vertical_protection_level_m + common_m.z();
    }
  }
  estimate->clock_bias_m = point_.clock_m;
  estimate->hdop = point_.hdop;
  estimate->vdop = point_.vdop;
  estimate->pdop = point_.pdop;
  estimate->tdop = point_.tdop;
  if (combined_.satellite_scale.estimated) {
    estimate->satellite_sigma_factor = combined_.satellite_scale.sigma_factor;
  }
  if (combined_.landmark_scale.estimated) {
    estimate->landmark_sigma_factor = combined_.landmark_scale.sigma_factor;
  }
  if (satellite_ranges_ > 1) estimate->sources |= kSourceGnss;
  if (photo_ == PhotoOutcome::kUsed) estimate->sources |= kSourceVision;
}

void EpochSolver::Judge(SessionEstimate* estimate, std::vector<SatelliteStatus>* statuses) const {
  if (satellite_ranges_ != model_.used_signals().size()) return;  // not asked
  DistinctSatellites used;
  for (std::size_t i = 0; i < model_.used_signals().size(); ++i) {
    const PreparedSignal& prepared = model_.used_signals()[i];
    SatelliteStatus& satellite = (*statuses)[prepared.index];
    satellite.has_residual = true;
    satellite.residual_m = verdicts_[i].residual_m;
    satellite.sigma_m = prepared.weight.error.sigma_m;
    satellite.weight = verdicts_[i].weight;
    satellite.verdict = VerdictOf(verdicts_[i]);
    if (verdicts_[i].used && verdicts_[i].observable) used.Add(prepared.satellite_id);
  }
  estimate->satellites_used = used.count();
  // What was merged into another signal of its satellite fares as that does.
  for (const MergedSignal& merged : model_.merged_signals()) {
    const SatelliteStatus& whole = (*statuses)[merged.into];
    SatelliteStatus& part = (*statuses)[merged.index];
    part.has_residual = whole.has_residual;
    part.residual_m = whole.residual_m;
    part.sigma_m = whole.sigma_m;
    part.weight = whole.weight;
    part.verdict = whole.verdict;
  }
}

void EpochSolver::SolveVelocity(SessionEstimate* estimate, std::vector<SatelliteStatus>* statuses) {
  const auto note = [&](std::size_t signal, double residual_mps) {
    (*statuses)[signal].has_rate_residual = true;
    (*statuses)[signal].range_rate_residual_mps = residual_mps;
  };
  if (filters()) {
    const std::span<const MotionVerdict> verdicts = filter_.rate_verdicts();
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      note(filter_.rate_signals()[i], verdicts[i].residual);
    }
    return;
  }
  if (!AdjustVelocity(model_.rates(), &velocity_, &rate_verdicts_)) return;
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(estimate->position);
  estimate->has_velocity = true;
  estimate->velocity_enu_mps = enu_from_ecef * velocity_.velocity_in_ecef_mps;
  estimate->velocity_covariance_enu_m2ps2 =
      enu_from_ecef * velocity_.covariance_ecef_m2ps2 * enu_from_ecef.transpose();
  StateAccuracy(estimate);
  estimate->clock_drift_mps = velocity_.clock_drift_mps;
  for (std::size_t i = 0; i < rate_verdicts_.size(); ++i) {
    note(model_.rate_signals()[i], rate_verdicts_[i].residual_mps);
  }
}

void EpochSolver::FillFromFilter(SessionEstimate* estimate) const {
  FillPlace(filter_.position_in_ecef(), filter_.PositionCovarianceEnu(), filter_.ranged_share(),
            estimate);
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(estimate->position);
  estimate->has_velocity = true;
  estimate->velocity_enu_mps = enu_from_ecef * filter_.velocity_in_ecef_mps();
  estimate->velocity_covariance_enu_m2ps2 = filter_.VelocityCovarianceEnu();
  StateAccuracy(estimate);
  estimate->clock_drift_mps = filter_.clock_drift_mps();
}

void EpochSolver::LookForLostFilter(const Eigen::Vector3d& place, PointOptions options) {
  const std::optional<PositionStatement> expected = filter_.Place();
  if (!expected) return;
  if (!LooksLost(*expected, point_, verdicts_)) {
    filter_.NoteFound();
    return;
  }
  options.place.reset();
  const PointStatus status =
      adjustment_.Solve(ranges_, place, biases_, options, &alone_, &verdicts_alone_);
  if (status != PointStatus::kGood) return;
  const double likelier =
      LogLikelihood(ranges_, verdicts_alone_) - LogLikelihood(ranges_, verdicts_);
  if (!filter_.ProvesLost(likelier)) return;
  point_ = alone_;
  verdicts_ = verdicts_alone_;
}

bool EpochSolver::Coast(SessionEstimate* estimate) const {
  if (!filters() || !filter_.started()) return false;
  SessionEstimate carried = *estimate;
  FillFromFilter(&carried);
  if (carried.accuracy_m > kWorstCoasted_m) return false;
  *estimate = carried;
  estimate->status = EstimateStatus::kFix;
  return true;
}

void EpochSolver::Learn() {
  const std::vector<PreparedSignal>& signals = model_.used_signals();
  if (satellite_ranges_ == 0) return;
  if (point_.redundancy > 0) {
    const double share =
        std::min(static_cast<double>(point_.redundancy) / static_cast<double>(signals.size()), 1.0);
    redundancy_.assign(signals.size(), share);
    if (options_.estimate_variance_components) {
      RedundancyNumbers(model_.ranges(), verdicts_, point_.position_in_ecef, biases_, &redundancy_);
    }
    for (std::size_t i = 0; i < signals.size(); ++i) {
      weights_.Learn(signals[i].clock_group, signals[i].weight, verdicts_[i].residual_m,
                     redundancy_[i], verdicts_[i].weight, verdicts_[i].late_share);
    }
    weights_.FinishEpoch();
  }
  if (!options_.learn_biases) return;
  for (int group = 0; group < kMaxClockGroups; ++group) {
    if (point_.groups_seen >> group & 1u) {
      biases_.Set(group, point_.biases[static_cast<std::size_t>(group)]);
    }
  }
}

EpochMemory::EpochMemory(const SessionOptions& options)
    : model(options),
      weights(options),
      filter(options.estimator == Estimator::kSmoother, nullptr) {}

void EpochSolver::Save(EpochMemory* memory) const {
  memory->model = model_;
  memory->weights = weights_;
  memory->code_rate = code_rate_;
  memory->biases = biases_;
  memory->height = height_;
  memory->filter = filter_;
  memory->modelled = modelled_;
  memory->last_place_in_ecef = last_place_in_ecef_;
  memory->last_gps_ns = last_gps_ns_;
}

void EpochSolver::GoBackTo(const EpochMemory& memory) {
  model_ = memory.model;
  weights_ = memory.weights;
  code_rate_ = memory.code_rate;
  biases_ = memory.biases;
  height_ = memory.height;
  filter_.GoBackTo(memory.filter);
  modelled_ = memory.modelled;
  last_place_in_ecef_ = memory.last_place_in_ecef;
  last_gps_ns_ = memory.last_gps_ns;
}

void EpochSolver::ForgetTime() {
  filter_.Forget();
  code_rate_.Forget();
  height_.Forget();
  last_gps_ns_ = 0;
}

void EpochSolver::Forget() {
  modelled_ = false;
  filter_.ForgetSteps();
  ForgetTime();
  model_.Forget();
  weights_.Forget();
  biases_.Forget();
  last_place_in_ecef_.reset();
}

}  // namespace lodemark
