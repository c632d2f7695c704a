#include "core/fusion/motion_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// Position and velocity before and after, the drift of the receiver's clock then, and by how much
// the clock changed in between.
constexpr int kVelocity = 3;
constexpr int kAfter = 6;
constexpr int kDrift = 12;
constexpr int kClockChange = 13;
constexpr int kUnknowns = 14;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// 1 sigma an axis of a velocity that nobody knows, and of its vertical part.
constexpr double kAnySpeed_mps = 15.0;
constexpr double kAnyClimb_mps = 2.0;

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

Eigen::Matrix3d Turned(const Eigen::Matrix3d& enu_from_ecef, const Eigen::Vector3d& diagonal) {
  return enu_from_ecef.transpose() * diagonal.asDiagonal() * enu_from_ecef;
}

double Kernel(double u) { return 1.0 / ((1.0 + u * u) * (1.0 + u * u)); }

// The observations of one time update, linearised around where the state alone would go.
class TimeUpdate {
 public:
  TimeUpdate(const MotionVector& state, const MotionMatrix& covariance, double seconds,
             const MotionModel& model)
      : velocity_(state.tail<3>()), seconds_(seconds) {
    const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(GeodeticFromEcef(state.head<3>()));
    const Eigen::Matrix3d density = Turned(enu_from_ecef, model.acceleration_density_m2ps3);
    const double t = seconds;
    MotionMatrix noise;
    noise << density * (t * t * t / 3.0), density * (t * t / 2.0), density * (t * t / 2.0),
        density * t;
    MotionMatrix transition = MotionMatrix::Identity();
    transition.topRightCorner<3, 3>() = t * Eigen::Matrix3d::Identity();
    const MotionMatrix information = noise.ldlt().solve(MotionMatrix::Identity());
    prior_.setZero();
    prior_.topLeftCorner<6, 6>() = covariance.ldlt().solve(MotionMatrix::Identity()) +
                                   transition.transpose() * information * transition;
    prior_.block<6, 6>(0, kAfter) = -transition.transpose() * information;
    prior_.block<6, 6>(kAfter, 0) = prior_.block<6, 6>(0, kAfter).transpose();
    prior_.block<6, 6>(kAfter, kAfter) = information;
    prior_(kDrift, kDrift) = 1.0 / (kAnyDrift_mps * kAnyDrift_mps);
    prior_(kClockChange, kClockChange) = 1.0 / (kAnyDrift_mps * kAnyDrift_mps);
    unknowns_.setZero();
  }

  double Residual(const RangeRateObservation& rate) const {
    const Eigen::Vector3d velocity = velocity_ + unknowns_.segment<3>(kAfter + kVelocity);
    return rate.rate_mps + rate.direction_in_ecef.dot(velocity) - unknowns_[kDrift];
  }
  double Residual(const RangeChangeObservation& change) const {
    const Eigen::Vector3d moved =
        seconds_ * velocity_ + unknowns_.segment<3>(kAfter) - unknowns_.head<3>();
    return change.change_m + change.direction_in_ecef.dot(moved) - unknowns_[kClockChange];
  }

  void Begin() {
    normal_ = prior_;
    right_ = -prior_ * unknowns_;
  }
  // Only the lower triangle, which is all that the factorisation looks at.
  void Add(const RangeRateObservation& rate, double weight) {
    const Eigen::Vector3d& u = rate.direction_in_ecef;
    const double pull = weight * Residual(rate);
    normal_.block<3, 3>(kAfter + kVelocity, kAfter + kVelocity).noalias() +=
        weight * u * u.transpose();
    normal_.block<1, 3>(kDrift, kAfter + kVelocity) -= weight * u.transpose();
    normal_(kDrift, kDrift) += weight;
    right_.segment<3>(kAfter + kVelocity) -= pull * u;
    right_[kDrift] += pull;
  }
  void Add(const RangeChangeObservation& change, double weight) {
    const Eigen::Vector3d& u = change.direction_in_ecef;
    const double pull = weight * Residual(change);
    const Eigen::Matrix3d square = weight * u * u.transpose();
    normal_.block<3, 3>(0, 0) += square;
    normal_.block<3, 3>(kAfter, 0) -= square;
    normal_.block<3, 3>(kAfter, kAfter) += square;
    normal_.block<1, 3>(kClockChange, 0) += weight * u.transpose();
    normal_.block<1, 3>(kClockChange, kAfter) -= weight * u.transpose();
    normal_(kClockChange, kClockChange) += weight;
    right_.head<3>() += pull * u;
    right_.segment<3>(kAfter) -= pull * u;
    right_[kClockChange] += pull;
  }
  // Returns how far the state moved, in metres and metres a second; negative if it cannot.
  double Step() {
    factor_.compute(normal_);
    if (factor_.info() != Eigen::Success) return -1.0;
    const Vector step = factor_.solve(right_);
    if (!step.allFinite()) return -1.0;
    unknowns_ += step;
    return step.segment<6>(kAfter).norm();
  }

  const Vector& unknowns() const { return unknowns_; }
  void Restart() { unknowns_.setZero(); }
  Matrix Covariance() const { return factor_.solve(Matrix::Identity()); }

 private:
  Eigen::Vector3d velocity_;
  double seconds_;
  Matrix prior_;
  Matrix normal_;
  Vector right_;
  Vector unknowns_;
  Eigen::LDLT<Matrix> factor_;
};

template <typename Observation>
double SigmaOf(const Observation& observation) {
  if constexpr (std::is_same_v<Observation, RangeRateObservation>) {
    return observation.sigma_mps;
  } else {
    return observation.sigma_m;
  }
}

// How many times their stated variance the residuals have, at least 1.
template <typename Observation>
double VarianceFactor(const TimeUpdate& update, std::span<const Observation> observations,
                      std::vector<MotionVerdict>* verdicts) {
  double cost = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    MotionVerdict& verdict = (*verdicts)[i];
    verdict.residual = update.Residual(observations[i]);
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

}  // namespace

void MotionFilter::Start(const Eigen::Vector3d& position_in_ecef,
                         const Eigen::Matrix3d& covariance_enu_m2) {
  started_ = true;
  step_ = MotionStep();
  step_.filtered.mean.head<3>() = position_in_ecef;
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(GeodeticFromEcef(position_in_ecef));
  MotionMatrix& covariance = step_.filtered.covariance;
  covariance.topLeftCorner<3, 3>() = enu_from_ecef.transpose() * covariance_enu_m2 * enu_from_ecef;
  covariance.bottomRightCorner<3, 3>() = Turned(
      enu_from_ecef, Eigen::Vector3d(kAnySpeed_mps * kAnySpeed_mps, kAnySpeed_mps * kAnySpeed_mps,
                                     kAnyClimb_mps * kAnyClimb_mps));
}

void MotionFilter::Advance(double seconds, std::span<const RangeRateObservation> rates,
                           std::span<const RangeChangeObservation> changes,
                           const MotionModel& model, MotionVerdicts* verdicts) {
  verdicts->rates.assign(rates.size(), MotionVerdict());
  verdicts->changes.assign(changes.size(), MotionVerdict());
  verdicts->rates_agree = !rates.empty();
  verdicts->changes_agree = changes.size() >= kFewestChanges;
  TimeUpdate update(step_.filtered.mean, step_.filtered.covariance, seconds, model);
  double rate_factor = 1.0;
  double change_factor = 1.0;
  const auto fill = [&](double width) {
    update.Begin();
    for (std::size_t i = 0; verdicts->rates_agree && i < rates.size(); ++i) {
      MotionVerdict& verdict = verdicts->rates[i];
      verdict.weight = Kernel(update.Residual(rates[i]) / (width * rates[i].sigma_mps));
      update.Add(rates[i],
                 verdict.weight / (rate_factor * rates[i].sigma_mps * rates[i].sigma_mps));
    }
    for (std::size_t i = 0; verdicts->changes_agree && i < changes.size(); ++i) {
      MotionVerdict& verdict = verdicts->changes[i];
      verdict.weight = Kernel(update.Residual(changes[i]) / (width * changes[i].sigma_m));
      update.Add(changes[i],
                 verdict.weight / (change_factor * changes[i].sigma_m * changes[i].sigma_m));
    }
  };
  const auto descend = [&] {
    update.Restart();
    // Everything counts at first, whatever the scale of the outliers.
    double width = 1e9;
    for (int i = 0; i < kLargestIterations; ++i) {
      fill(width);
      const double moved = update.Step();
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
    rate_factor = VarianceFactor(update, rates, &verdicts->rates);
    change_factor = VarianceFactor(update, changes, &verdicts->changes);
    fill(kNarrowest);
    done = update.Step() >= 0.0;
  }
  if (!done) {
    update.Restart();
    update.Begin();
    update.Step();
    verdicts->rates_agree = false;
    verdicts->changes_agree = false;
  }
  const Matrix covariance = update.Covariance();
  const MotionMatrix after = covariance.block<6, 6>(kAfter, kAfter);
  const MotionVector& state = step_.filtered.mean;
  MotionStep next;
  next.begins = false;
  next.before = {state + update.unknowns().head<6>(), covariance.topLeftCorner<6, 6>()};
  next.predicted.mean = state + update.unknowns().segment<6>(kAfter);
  next.predicted.mean.head<3>() += seconds * state.tail<3>();
  next.predicted.covariance = 0.5 * (after + after.transpose());
  next.gain = next.predicted.covariance.ldlt().solve(covariance.block<6, 6>(kAfter, 0)).transpose();
  next.filtered = next.predicted;
  started_ = next.predicted.mean.allFinite() && next.predicted.covariance.allFinite() &&
             next.predicted.covariance.diagonal().minCoeff() > 0.0;
  if (!started_) return;
  step_ = next;
  clock_drift_mps_ = update.unknowns()[kDrift];
}

PositionStatement MotionFilter::Place() const {
  PositionStatement place;
  place.around_in_ecef = step_.filtered.mean.head<3>();
  place.information_pm2 = PositionCovarianceEnu().ldlt().solve(Eigen::Matrix3d::Identity());
  return place;
}

void MotionFilter::Hear(const PositionStatement& said) {
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(step_.filtered.mean.head<3>()));
  const Eigen::Matrix3d information =
      enu_from_ecef.transpose() * said.information_pm2 * enu_from_ecef;
  MotionMatrix& covariance = step_.filtered.covariance;
  const Eigen::Matrix<double, 6, 3> cross = covariance.leftCols<3>();
  // (I + L P)^-1 L is the inverse of the innovation's covariance P + L^-1, L deficient or not.
  const Eigen::Matrix3d shrink =
      (Eigen::Matrix3d::Identity() + information * covariance.topLeftCorner<3, 3>()).inverse();
  step_.filtered.mean += cross * (shrink * (enu_from_ecef.transpose() * said.pull_pm));
  const MotionMatrix after = covariance - cross * (shrink * information) * cross.transpose();
  covariance = 0.5 * (after + after.transpose());
}

Eigen::Matrix3d MotionFilter::CovarianceEnu(Eigen::Index first) const {
  const Eigen::Matrix3d enu_from_ecef =
      EnuFromEcefRotation(GeodeticFromEcef(step_.filtered.mean.head<3>()));
  return enu_from_ecef * step_.filtered.covariance.block<3, 3>(first, first) *
         enu_from_ecef.transpose();
}

}  // namespace lodemark
