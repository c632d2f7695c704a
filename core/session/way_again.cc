#include "core/session/way_again.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "core/fusion/motion_filter.h"
#include "core/geo/geodetic.h"
#include "core/session/error_persistence.h"
#include "core/session/explained.h"
#include "core/session/trust_around.h"

namespace lodemark {
namespace {

// Nobody knows the first place but by what is heard.
constexpr double kAnywhere_m = 1000.0;

// Epochs are judged all at once, each by what the others said before, so what they say swings
// around where it ends up: every time it takes half of the new. The swing then falls to a few
// centimetres within so many times.
constexpr int kTimes = 4;
constexpr double kHalf = 0.5;

// Between epochs where none is before.
constexpr double kUsual_s = 1.0;

Eigen::Matrix3d EnuFromEcef(const Eigen::Vector3d& place_in_ecef) {
  return EnuFromEcefRotation(GeodeticFromEcef(place_in_ecef));
}

Eigen::Matrix3d Inverse(const Eigen::Matrix3d& symmetric) {
  return symmetric.ldlt().solve(Eigen::Matrix3d::Identity());
}

Eigen::Matrix3d NotNegative(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(symmetric);
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() *
         axes.eigenvectors().transpose();
}

PositionStatement Part(double share, const PositionStatement& said) {
  return {said.around_in_ecef, share * said.information_pm2, share * said.pull_pm};
}

// The same statement around another place.
PositionStatement Around(const Eigen::Vector3d& place_in_ecef, const PositionStatement& said) {
  PositionStatement nothing;
  nothing.around_in_ecef = place_in_ecef;
  return Together(nothing, said);
}

// What a state says of its place without one of the statements that it was made from; around the
// place that this states, so that an epoch which finds it again pulls nowhere.
PositionStatement Without(const PositionStatement& said, const MotionState& state) {
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcef(state.mean.head<3>());
  const PositionStatement own = Around(state.mean.head<3>(), said);
  const Eigen::Matrix3d covariance =
      enu_from_ecef * state.covariance.topLeftCorner<3, 3>() * enu_from_ecef.transpose();
  PositionStatement others;
  others.information_pm2 = NotNegative(Inverse(covariance) - own.information_pm2);
  const Eigen::Matrix3d information =
      others.information_pm2 + Eigen::Matrix3d::Identity() / (kAnywhere_m * kAnywhere_m);
  others.around_in_ecef =
      state.mean.head<3>() - enu_from_ecef.transpose() * information.ldlt().solve(own.pull_pm);
  return others;
}

bool AllFinite(const std::vector<MotionState>& states) {
  return std::all_of(states.begin(), states.end(), [](const MotionState& state) {
    return state.mean.allFinite() && state.covariance.allFinite();
  });
}

class WayAgain {
 public:
  explicit WayAgain(std::span<const HeardStep> heard)
      : heard_(heard), said_(heard.size()), verdicts_(heard.size()) {
    for (std::size_t i = 0; i < heard.size(); ++i) said_[i] = heard[i].of_epoch;
  }

  // Judges every epoch from the states of the time before.
  void Judge(std::span<const MotionState> states) {
    ErrorPersistence persistence;
    fresh_.assign(heard_.size(), PositionStatement());
    for (std::size_t i = 0; i < heard_.size(); ++i) {
      verdicts_[i].clear();
      if (heard_[i].ranges.empty()) continue;
      fresh_[i] = Ask(i, Without(said_[i], states[i]));
      persistence.Learn(heard_[i].epoch_seconds, heard_[i].sources, verdicts_[i]);
    }
    const RangedErrors errors = persistence.Shares();
    for (std::size_t i = 0; i < heard_.size(); ++i) {
      if (heard_[i].ranges.empty()) continue;
      const double seconds = heard_[i].epoch_seconds > 0.0 ? heard_[i].epoch_seconds : kUsual_s;
      const double share = 1.0 / errors.AlikeEpochs(seconds);
      said_[i] = Together(Part(kHalf * share, fresh_[i]), Part(1.0 - kHalf, said_[i]));
    }
    factors_ = SigmaFactorsAround(heard_, verdicts_);
  }

  // Steps by what was judged.
  std::vector<MotionStep> Go(std::span<const MotionStep> before,
                             std::span<const MotionState> states) {
    std::vector<MotionStep> steps(heard_.size());
    MotionFilter filter;
    for (std::size_t i = 0; i < heard_.size(); ++i) {
      const bool same_moment = i > 0 && heard_[i].time_ns == heard_[i - 1].time_ns;
      if (i == 0 || (before[i].begins && !same_moment)) {
        filter.Start(states[i].mean.head<3>(),
                     kAnywhere_m * kAnywhere_m * Eigen::Matrix3d::Identity());
      } else if (!same_moment) {
        Advance(i, &filter);
      }
      if (!filter.started()) return {before.begin(), before.end()};
      steps[i] = filter.step();
      if (same_moment) {
        steps[i].begins = false;
        steps[i].before = steps[i].predicted = steps[i - 1].filtered;
        steps[i].gain.setIdentity();
      }
      filter.Hear(Around(filter.position_in_ecef(), heard_[i].of_photos));
      filter.Hear(Around(filter.position_in_ecef(), said_[i]));
      steps[i].filtered = filter.step().filtered;
    }
    return steps;
  }

 private:
  // Since the moment before; 0 for the first.
  double SecondsTo(std::size_t i) const {
    return i == 0 ? 0.0 : 1e-9 * static_cast<double>(heard_[i].time_ns - heard_[i - 1].time_ns);
  }

  // What an epoch says beyond what all others do, as if it were independent of them.
  PositionStatement Ask(std::size_t i, const PositionStatement& others) {
    const HeardStep& step = heard_[i];
    PointOptions options = step.options;
    options.place = others;
    PointEstimate point;
    PositionStatement said;
    said.around_in_ecef = others.around_in_ecef;
    if (!others.information_pm2.allFinite() || !others.around_in_ecef.allFinite()) return said;
    if (adjustment_.Solve(step.ranges, others.around_in_ecef, step.biases, options, &point,
                          &verdicts_[i]) != PointStatus::kGood) {
      verdicts_[i].clear();
      return said;
    }
    if (!Explained(verdicts_[i])) return said;
    const Eigen::Matrix3d information = point.covariance_growth * Inverse(point.covariance_enu_m2);
    said.information_pm2 = NotNegative(information - others.information_pm2);
    said.pull_pm = information * (EnuFromEcef(others.around_in_ecef) *
                                  (point.position_in_ecef - others.around_in_ecef));
    // Errors that are alike tell less than they seem to.
    return Part(1.0 / point.covariance_growth, said);
  }

  void Advance(std::size_t i, MotionFilter* filter) {
    const HeardStep& step = heard_[i];
    rates_ = step.rates;
    changes_ = step.changes;
    for (std::size_t k = 0; k < rates_.size(); ++k) rates_[k].sigma_mps *= factors_[i].rates[k];
    for (std::size_t k = 0; k < changes_.size(); ++k) changes_[k].sigma_m *= factors_[i].changes[k];
    filter->Advance(SecondsTo(i), rates_, changes_, step.motion, &motion_verdicts_);
  }

  std::span<const HeardStep> heard_;
  // Of each moment: what its epoch says, as it is heard; before it is shared out; how it fared.
  std::vector<PositionStatement> said_;
  std::vector<PositionStatement> fresh_;
  std::vector<std::vector<ObservationVerdict>> verdicts_;
  std::vector<MomentSigmaFactors> factors_;
  PointAdjustment adjustment_;
  std::vector<RangeRateObservation> rates_;
  std::vector<RangeChangeObservation> changes_;
  MotionVerdicts motion_verdicts_;
};

}  // namespace

std::vector<MotionState> GoAgain(std::span<const MotionStep> steps,
                                 std::span<const HeardStep> heard) {
  std::vector<MotionState> states = SmoothMotion(steps);
  if (heard.size() != steps.size()) return states;
  WayAgain way(heard);
  for (int time = 0; time < kTimes; ++time) {
    way.Judge(states);
    std::vector<MotionState> again = SmoothMotion(way.Go(steps, states));
    if (!AllFinite(again)) break;
    states = std::move(again);
  }
  return states;
}

}  // namespace lodemark
