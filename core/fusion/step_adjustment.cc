#include "core/fusion/step_adjustment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Displacement, velocity, the drift of the receiver's clock now, and by how much the clock changed
// in between.
constexpr int kVelocity = 3;
constexpr int kDrift = 6;
constexpr int kClockChange = 7;
constexpr int kUnknowns = 8;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// Of a clock that nobody knows.
constexpr double kAnyDrift_mps = 1e5;

// Kernels shrink from "everything counts" to a redescending one of so many sigmas.
constexpr double kNarrowest = 3.0;
constexpr double kWidest = 64.0;
constexpr int kLargestIterations = 14;

// A displacement and a clock are four unknowns: what five agree on is proven by one.
constexpr int kFewestChanges = 5;
// Of those that could, so many have to agree.
constexpr double kAgreeingChanges = 0.5;
constexpr double kAgreeingRates = 0.4;

double Kernel(double u) { return 1.0 / ((1.0 + u * u) * (1.0 + u * u)); }

double SigmaOf(const RangeRateObservation& rate) { return rate.sigma_mps; }
double SigmaOf(const RangeChangeObservation& change) { return change.sigma_m; }

// The normal equations of deviations from what is known.
class StepEquations {
 public:
  explicit StepEquations(const StepKnowledge& known) : known_(known) {
    prior_.setZero();
    prior_.topLeftCorner<6, 6>() = known.covariance.ldlt().solve(StepMatrix::Identity());
    prior_(kDrift, kDrift) = 1.0 / (kAnyDrift_mps * kAnyDrift_mps);
    prior_(kClockChange, kClockChange) = 1.0 / (kAnyDrift_mps * kAnyDrift_mps);
    unknowns_.setZero();
  }

  double Residual(const RangeRateObservation& rate) const {
    const Eigen::Vector3d velocity = known_.mean.tail<3>() + unknowns_.segment<3>(kVelocity);
    return rate.rate_mps + rate.direction_in_ecef.dot(velocity) - unknowns_[kDrift];
  }
  double Residual(const RangeChangeObservation& change) const {
    const Eigen::Vector3d moved = known_.mean.head<3>() + unknowns_.head<3>();
    return change.change_m + change.direction_in_ecef.dot(moved) - unknowns_[kClockChange];
  }

  void Begin() {
    normal_ = prior_;
    right_ = -prior_ * unknowns_;
  }
  void Add(const RangeRateObservation& rate, double weight) {
    Add(rate.direction_in_ecef, kVelocity, kDrift, Residual(rate), weight);
  }
  void Add(const RangeChangeObservation& change, double weight) {
    Add(change.direction_in_ecef, 0, kClockChange, Residual(change), weight);
  }
  // Returns how far the state moved, in metres and metres a second; negative if it cannot.
  double Step() {
    factor_.compute(normal_);
    if (factor_.info() != Eigen::Success) return -1.0;
    const Vector step = factor_.solve(right_);
    if (!step.allFinite()) return -1.0;
    unknowns_ += step;
    return step.head<6>().norm();
  }
  void Restart() { unknowns_.setZero(); }

  StepKnowledge Result() const {
    const Matrix covariance = factor_.solve(Matrix::Identity());
    StepKnowledge result;
    result.mean = known_.mean + unknowns_.head<6>();
    result.covariance =
        0.5 * (covariance.topLeftCorner<6, 6>() + covariance.topLeftCorner<6, 6>().transpose());
    result.clock_drift_mps = unknowns_[kDrift];
    return result;
  }

 private:
  // Only the lower triangle, which is all that the factorisation looks at.
  void Add(const Eigen::Vector3d& u, int first, int clock, double residual, double weight) {
    normal_.block<3, 3>(first, first).noalias() += weight * u * u.transpose();
    normal_.block<1, 3>(clock, first) -= weight * u.transpose();
    normal_(clock, clock) += weight;
    right_.segment<3>(first) -= weight * residual * u;
    right_[clock] += weight * residual;
  }

  const StepKnowledge& known_;
  Matrix prior_;
  Matrix normal_;
  Vector right_;
  Vector unknowns_;
  Eigen::LDLT<Matrix> factor_;
};

// How many times their stated variance the residuals have, at least 1.
template <typename Observation>
double VarianceFactor(const StepEquations& equations, std::span<const Observation> observations,
                      std::vector<MotionVerdict>* verdicts) {
  double cost = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    MotionVerdict& verdict = (*verdicts)[i];
    verdict.residual = equations.Residual(observations[i]);
    const double u = verdict.residual / SigmaOf(observations[i]);
    cost += verdict.weight * u * u;
    count += verdict.weight;
  }
  return std::max(1.0, cost / std::max(1.0, count - 4.0));
}

double Agreeing(const std::vector<MotionVerdict>& verdicts) {
  double sum = 0.0;
  for (const MotionVerdict& verdict : verdicts) sum += verdict.weight;
  return sum;
}

void Discard(std::vector<MotionVerdict>* verdicts) {
  for (MotionVerdict& verdict : *verdicts) verdict.weight = 0.0;
}

template <typename Observation>
void AddWeighed(std::span<const Observation> observations, double width, double variance_factor,
                StepEquations* equations, std::vector<MotionVerdict>* verdicts) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const double sigma = SigmaOf(observations[i]);
    MotionVerdict& verdict = (*verdicts)[i];
    verdict.weight = Kernel(equations->Residual(observations[i]) / (width * sigma));
    equations->Add(observations[i], verdict.weight / (variance_factor * sigma * sigma));
  }
}

}  // namespace

StepKnowledge AdjustStep(const StepKnowledge& known, std::span<const RangeRateObservation> rates,
                         std::span<const RangeChangeObservation> changes,
                         MotionVerdicts* verdicts) {
  verdicts->rates.assign(rates.size(), MotionVerdict());
  verdicts->changes.assign(changes.size(), MotionVerdict());
  verdicts->rates_agree = !rates.empty();
  verdicts->changes_agree = changes.size() >= kFewestChanges;
  StepEquations equations(known);
  double rate_factor = 1.0;
  double change_factor = 1.0;
  const auto fill = [&](double width) {
    equations.Begin();
    if (verdicts->rates_agree) {
      AddWeighed(rates, width, rate_factor, &equations, &verdicts->rates);
    }
    if (verdicts->changes_agree) {
      AddWeighed(changes, width, change_factor, &equations, &verdicts->changes);
    }
  };
  const auto descend = [&] {
    equations.Restart();
    // Everything counts at first, whatever the scale of the outliers.
    double width = 1e9;
    for (int i = 0; i < kLargestIterations; ++i) {
      fill(width);
      const double moved = equations.Step();
      if (moved < 0.0) return false;
      if (width > kNarrowest) {
        width = i == 0 ? kWidest : std::max(kNarrowest, 0.5 * width);
      } else if (moved < 1e-4) {
        break;
      }
    }
    return true;
  };
  bool done = descend();
  if (done && verdicts->changes_agree &&
      Agreeing(verdicts->changes) <
          std::max(kFewestChanges - 0.5, kAgreeingChanges * static_cast<double>(changes.size()))) {
    verdicts->changes_agree = false;
    Discard(&verdicts->changes);
    done = descend();
  }
  if (done && verdicts->rates_agree &&
      Agreeing(verdicts->rates) < kAgreeingRates * static_cast<double>(rates.size())) {
    verdicts->rates_agree = false;
    Discard(&verdicts->rates);
    done = descend();
  }
  if (done) {
    rate_factor = VarianceFactor(equations, rates, &verdicts->rates);
    change_factor = VarianceFactor(equations, changes, &verdicts->changes);
    fill(kNarrowest);
    done = equations.Step() >= 0.0;
  }
  if (!done) {
    verdicts->rates_agree = false;
    verdicts->changes_agree = false;
  }
  if (!verdicts->rates_agree && !verdicts->changes_agree) return known;
  return equations.Result();
}

}  // namespace lodemark
