#include "core/session/epoch_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geo/geodetic.h"
#include "core/session/explained.h"

namespace lodemark {
namespace {

// After a longer silence the place is looked for anew.
constexpr double kLongestSilence_s = 120.0;

// Nothing moves within less.
constexpr double kShortest_s = 1e-3;

// Most ranges fit nothing for so long: the place is lost.
constexpr double kLongestUnexplained_s = 5.0;

// A place of its own fits an epoch's ranges better anyway, the more so the more are reflections;
// beyond that, as much as makes one in a thousand certain.
constexpr double kLikelierAnyway = 8.0;
constexpr double kProof = 8.0;

// Without ranges for so long, what the motion adds outweighs how the first epochs are counted.
constexpr double kLongestCounting_s = 2.0;

// An epoch's ranges fix a place no worse than this.
constexpr double kWorstAlone_m = 50.0;

// Between epochs, before it is known.
constexpr double kUsual_s = 1.0;

// What lasts follows the satellites in view within so many epochs.
constexpr double kLastingGain = 0.02;

// Photographs err alike as long as they show much the same landmarks.
constexpr double kPhotosAlike_s = 3.0;

// So many that more change nothing.
constexpr double kVeryMany = 1e6;

double Seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

// Covariance of the place by the epoch's ranges alone.
Eigen::Matrix3d Alone(const PointEstimate& point) {
  const Eigen::Matrix3d information = point.information_pm2 - point.stated_information_pm2;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information);
  const Eigen::Vector3d variances =
      axes.eigenvalues().cwiseMax(1.0 / (kWorstAlone_m * kWorstAlone_m)).cwiseInverse();
  return axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose();
}

Eigen::Matrix3d Inverse(const Eigen::Matrix3d& symmetric) {
  return symmetric.ldlt().solve(Eigen::Matrix3d::Identity());
}

}  // namespace

std::optional<Eigen::Vector3d> EpochFilter::PlaceAt(std::int64_t time_ns) const {
  if (!filter_.started()) return std::nullopt;
  const double seconds = Seconds(time_ns_, time_ns);
  if (!(seconds >= 0.0) || seconds > kLongestSilence_s) return filter_.position_in_ecef();
  return filter_.position_in_ecef() + seconds * filter_.velocity_in_ecef_mps();
}

void EpochFilter::Advance(std::int64_t time_ns, const ObservationEpoch& epoch,
                          const GnssEpochModel& model) {
  const Eigen::Vector3d place = PlaceAt(time_ns).value_or(model.place_in_ecef());
  const std::span<const RangeChangeObservation> changes =
      phases_.Update(epoch.time_gps_ns, place, model.phases());
  // Phases tell what became of the last epoch's place, not of any other's.
  const bool from_epoch = time_ns_ == epoch_ns_;
  seconds_ = epoch_ns_ == 0 ? 0.0 : Seconds(epoch_ns_, time_ns);
  epoch_ns_ = time_ns;
  rates_ = model.rates();
  rate_signals_ = model.rate_signals();
  rate_satellites_.clear();
  for (const std::size_t signal : rate_signals_) {
    rate_satellites_.push_back(epoch.signals[signal].satellite);
  }
  changes_.clear();
  if (from_epoch) changes_.assign(changes.begin(), changes.end());
  change_satellites_.clear();
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    change_satellites_.push_back(epoch.signals[phases_.signals()[i]].satellite);
  }
  const Eigen::Vector3d velocity_before = filter_.velocity_in_ecef_mps();
  const double silent_before_s = silent_s_;
  Move(time_ns);
  if (!filter_.started() || (!verdicts_.rates_agree && !verdicts_.changes_agree)) return;
  silent_s_ = 0.0;
  if (silent_before_s > 0.0) return;
  accelerations_.Learn(seconds_, EnuFromEcefRotation(GeodeticFromEcef(place)) *
                                     (filter_.velocity_in_ecef_mps() - velocity_before));
}

void EpochFilter::Advance(std::int64_t time_ns) {
  rates_.clear();
  changes_.clear();
  rate_satellites_.clear();
  change_satellites_.clear();
  Move(time_ns);
}

void EpochFilter::Move(std::int64_t time_ns) {
  verdicts_.rates_agree = false;
  const double seconds = Seconds(time_ns_, time_ns);
  if (filter_.started() && seconds >= 0.0 && seconds < kShortest_s) {
    verdicts_ = MotionVerdicts();
    return;
  }
  steps_.MakeRoom(remembers_);
  HeardStep heard;
  if (remembers_) heard = MotionHeard(time_ns);
  const std::int64_t from_ns = time_ns_;
  time_ns_ = time_ns;
  if (!filter_.started()) return;
  if (!(seconds > 0.0) || seconds > kLongestSilence_s) {
    filter_.Stop();
    return;
  }
  silent_s_ += seconds;
  if (silent_s_ > kLongestCounting_s) epochs_ = kVeryMany;
  heard.motion = accelerations_.After(silent_s_);
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    rates_[i].sigma_mps *= trust_.SigmaFactor(rate_satellites_[i]);
  }
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    changes_[i].sigma_m *= trust_.SigmaFactor(change_satellites_[i]);
  }
  filter_.Advance(from_ns, time_ns, rates_, changes_, heard.motion, &verdicts_);
  if (filter_.started()) NoteStep(std::move(heard));
}

void EpochFilter::Start(const Eigen::Vector3d& position_in_ecef,
                        const Eigen::Matrix3d& covariance_enu_m2) {
  steps_.MakeRoom(remembers_);
  filter_.Start(position_in_ecef, covariance_enu_m2);
  silent_s_ = kUsual_s;
  unexplained_s_ = 0.0;
  HeardStep heard;
  heard.time_ns = time_ns_;
  NoteStep(std::move(heard));
}

HeardStep EpochFilter::MotionHeard(std::int64_t time_ns) const {
  HeardStep heard;
  heard.time_ns = time_ns;
  heard.rates = rates_;
  heard.rate_satellites = rate_satellites_;
  heard.changes = changes_;
  heard.change_satellites = change_satellites_;
  return heard;
}

// Room for it was made before anything changed: where memory runs out later, the steps are no
// longer those of the filter.
void EpochFilter::NoteStep(HeardStep heard) {
  epoch_said_ = PositionStatement();
  photos_said_ = PositionStatement();
  if (!remembers_) return;
  steps_.list.Push(filter_.step());
  steps_.heard.Push(std::move(heard));
  steps_taken_ = steps_.list.end();
}

void EpochFilter::NoteSaid(const PositionStatement& said, bool ranged) {
  if (!remembers_) return;
  PositionStatement& sum = ranged ? epoch_said_ : photos_said_;
  sum = Together(said, sum);
  HeardStep& heard = steps_.heard[steps_taken_ - 1];
  heard.of_epoch = epoch_said_;
  heard.of_photos = photos_said_;
}

void EpochFilter::Remember(std::span<const RangeObservation> ranges, const ClockBiases& biases,
                           const PointOptions& options) {
  if (!remembers_ || !filter_.started() || ranges.size() != sources_.size()) return;
  std::vector<RangeObservation> heard(ranges.begin(), ranges.end());
  std::vector<RangeSource> sources = sources_;
  HeardStep& step = steps_.heard[steps_taken_ - 1];
  step.ranges = std::move(heard);
  step.sources = std::move(sources);
  step.biases = biases;
  step.options = options;
  step.epoch_seconds = seconds_;
}

std::optional<PositionStatement> EpochFilter::Place() const {
  if (!filter_.started()) return std::nullopt;
  return filter_.Place();
}

void EpochFilter::Doubt(double likelier) {
  const double seconds = seconds_ > 0.0 ? seconds_ : kUsual_s;
  const double share = 1.0 / persistence_.Shares().AlikeEpochs(seconds);
  lost_ = std::max(0.0, lost_ + share * (likelier - kLikelierAnyway));
}

void EpochFilter::BeginAnew() {
  filter_.Stop();
  ++restarts_;
}

bool EpochFilter::ProvesLost(double likelier) {
  Doubt(likelier);
  if (lost_ < kProof) return false;
  BeginAnew();
  return true;
}

void EpochFilter::HearEpoch(const GnssEpochModel& model, const PointEstimate& point,
                            std::span<const ObservationVerdict> verdicts) {
  sources_.clear();
  for (const PreparedSignal& signal : model.used_signals()) {
    sources_.push_back({signal.satellite_id, signal.band, signal.weight.error.sigma_m});
  }
  trust_.Learn(seconds_, sources_, verdicts);
  const RangedErrors errors = persistence_.Shares();
  if (!filter_.started()) {
    lost_ = 0.0;
    epochs_ = 1.0;
    lasting_m2_ = errors.lasting * point.covariance_enu_m2;
    ranged_share_.setIdentity();
    const Eigen::Matrix3d covariance = errors.AlikeEpochs(kUsual_s) * point.covariance_enu_m2;
    Start(point.position_in_ecef, covariance);
    NoteSaid({point.position_in_ecef, Inverse(covariance), Eigen::Vector3d::Zero()}, true);
    return;
  }
  if (verdicts.empty()) return;
  if (!Explained(verdicts)) {
    unexplained_s_ += seconds_;
    if (unexplained_s_ > kLongestUnexplained_s) BeginAnew();
    return;
  }
  unexplained_s_ = 0.0;
  const double seconds = seconds_ > 0.0 ? seconds_ : kUsual_s;
  Hear(point, 1.0 / errors.AlikeEpochs(seconds), true);
  epochs_ += 1.0;
  lasting_m2_ += kLastingGain * (errors.lasting * Alone(point) - lasting_m2_);
  persistence_.Learn(seconds_, sources_, verdicts);
}

void EpochFilter::HearPhoto(std::int64_t time_ns, std::int64_t taken_ns,
                            const PointEstimate& point) {
  if (!filter_.started()) {
    time_ns_ = time_ns;
    ranged_share_.setZero();
    Start(point.position_in_ecef, point.covariance_enu_m2);
    NoteSaid({point.position_in_ecef, Inverse(point.covariance_enu_m2), Eigen::Vector3d::Zero()},
             false);
  } else {
    const double since_s = photo_ns_ == 0 ? kPhotosAlike_s : std::abs(Seconds(photo_ns_, taken_ns));
    Hear(point, std::min(1.0, since_s / kPhotosAlike_s), false);
  }
  epochs_ = kVeryMany;
  photo_ns_ = taken_ns;
}

void EpochFilter::Hear(const PointEstimate& point, double share, bool ranged) {
  const PositionStatement before = filter_.Place();
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(before.around_in_ecef));
  // What was added, as a normal error; of a direction less may be known than before.
  const Eigen::Matrix3d information = Inverse(point.covariance_enu_m2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information - before.information_pm2);
  PositionStatement said;
  said.around_in_ecef = before.around_in_ecef;
  said.information_pm2 = share * axes.eigenvectors() *
                         axes.eigenvalues().cwiseMax(0.0).asDiagonal() *
                         axes.eigenvectors().transpose();
  said.pull_pm =
      share * information * (enu_from_ecef * (point.position_in_ecef - before.around_in_ecef));
  filter_.Hear(said);
  NoteSaid(said, ranged);
  if (remembers_) steps_.list[steps_taken_ - 1] = filter_.step();
  const Eigen::Matrix3d gain = filter_.PositionCovarianceEnu() * said.information_pm2;
  ranged_share_ -= gain * ranged_share_;
  if (ranged) ranged_share_ += gain;
}

// Each epoch counts alike, so the first are believed less than they are worth.
Eigen::Matrix3d EpochFilter::FilteredCovarianceEnu() const {
  const RangedErrors errors = persistence_.Shares();
  const double seconds = seconds_ > 0.0 ? seconds_ : kUsual_s;
  const double worth = errors.OfMean(epochs_, seconds) * epochs_ / errors.AlikeEpochs(seconds);
  return worth * filter_.PositionCovarianceEnu();
}

Eigen::Matrix3d EpochFilter::PositionCovarianceEnu() const {
  return FilteredCovarianceEnu() + ranged_share_ * lasting_m2_ * ranged_share_.transpose();
}

void EpochFilter::GoBackTo(const EpochFilter& copy) {
  EpochFilter restored = copy;
  *this = std::move(restored);  // which takes no memory any more
  if (!remembers_) return;
  steps_.list.CutFrom(steps_taken_);
  steps_.heard.CutFrom(steps_taken_);
  if (!filter_.started() || !steps_.list.Has(steps_taken_ - 1)) return;
  // It may have heard more since it was copied.
  steps_.list[steps_taken_ - 1] = filter_.step();
  steps_.heard[steps_taken_ - 1].of_epoch = epoch_said_;
  steps_.heard[steps_taken_ - 1].of_photos = photos_said_;
}

void EpochFilter::Forget() {
  *this = EpochFilter(remembers_, sensors_);
  steps_taken_ = steps_.list.end();
}

void EpochFilter::ForgetSteps() {
  steps_.list.Clear();
  steps_.heard.Clear();
  steps_taken_ = 0;
}

}  // namespace lodemark
