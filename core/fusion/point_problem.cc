#include "core/fusion/point_problem.h"

#include <algorithm>
#include <cmath>

#include "core/geo/geodetic.h"

namespace lodemark {

PointProblem::PointProblem(std::span<const RangeObservation> observations,
                           const ClockBiases& biases, const std::optional<HeightPrior>& height,
                           std::vector<Row>* rows)
    : observations_(observations), height_(height), rows_(rows) {
  std::array<int, kMaxClockGroups> count = {};
  for (const RangeObservation& observation : observations) {
    if (observation.clock_group >= 0) ++count[static_cast<std::size_t>(observation.clock_group)];
  }
  // The pivot is the group best known; of equals, the larger.
  int pivot = -1;
  for (int g = 0; g < kMaxClockGroups; ++g) {
    const auto i = static_cast<std::size_t>(g);
    if (count[i] == 0) continue;
    if (pivot < 0 || biases[g].sigma_m < biases[pivot].sigma_m ||
        (biases[g].sigma_m == biases[pivot].sigma_m &&
         count[i] > count[static_cast<std::size_t>(pivot)])) {
      pivot = g;
    }
  }
  std::array<int, kMaxClockGroups> dense;
  dense.fill(-1);
  const auto take = [&](int g) {
    const auto i = static_cast<std::size_t>(clocks_);
    group_of_[i] = g;
    members_[i] = count[static_cast<std::size_t>(g)];
    prior_m_[i] = biases[g].mean_m - biases[pivot].mean_m;
    prior_sigma_m_[i] = std::hypot(biases[g].sigma_m, biases[pivot].sigma_m);
    dense[static_cast<std::size_t>(g)] = clocks_++;
  };
  if (pivot >= 0) take(pivot);
  for (int g = 0; g < kMaxClockGroups; ++g) {
    if (g != pivot && count[static_cast<std::size_t>(g)] > 0) take(g);
  }
  clock_state_ = PointVector::Zero(clocks_);
  rows_->resize(observations.size());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    Row& row = (*rows_)[i];
    const int g = observations[i].clock_group;
    row.clock = g < 0 ? -1 : dense[static_cast<std::size_t>(g)];
    row.zenith_delay_factor = observations[i].zenith_delay_factor;
    row.error = observations[i].error;
  }
}

void PointProblem::MoveTo(const Eigen::Vector3d& point_in_ecef) {
  point_in_ecef_ = point_in_ecef;
  const Geodetic geodetic = GeodeticFromEcef(point_in_ecef);
  enu_from_ecef_ = EnuFromEcefRotation(geodetic);
  height_m_ = geodetic.height_m;
  if (place_) place_offset_m_ = enu_from_ecef_ * (point_in_ecef - place_->around_in_ecef);
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    const Eigen::Vector3d line = observations_[i].point_in_ecef - point_in_ecef;
    const double distance_m = line.norm();
    Row& row = (*rows_)[i];
    row.direction = enu_from_ecef_ * (line / distance_m);
    row.misclosure_m = observations_[i].range_m - distance_m;
  }
}

void PointProblem::Step(const PointVector& step) {
  clock_state_ += step.segment(3, clocks_);
  if (unknowns() > 3 + clocks_) zenith_delay_m_ += step[3 + clocks_];
  MoveTo(point_in_ecef_ + enu_from_ecef_.transpose() * step.head<3>());
}

bool PointProblem::IsShared(int clock) const {
  if (members(clock) > 1) return true;
  if (clock > 0) return prior_sigma_m(clock) <= kUnknownBias_m;
  for (int other = 1; other < clocks_; ++other) {
    if (prior_sigma_m(other) <= kUnknownBias_m) return true;
  }
  return false;
}

double PointProblem::ClockOf(const Row& row) const {
  if (row.clock < 0) return 0.0;
  return row.clock == 0 ? clock_state_[0] : clock_state_[0] + clock_state_[row.clock];
}

void PointProblem::GuessClocks() {
  std::array<double, 64> values;
  for (int clock = 0; clock < clocks_; ++clock) {
    std::size_t count = 0;
    for (const Row& row : *rows_) {
      if (row.clock == clock && count < values.size()) values[count++] = row.misclosure_m;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
    if (clock == 0) {
      clock_state_[0] = *middle;
    } else if (prior_sigma_m(clock) < 100.0) {
      clock_state_[clock] = prior_m(clock);
    } else {
      clock_state_[clock] = *middle - clock_state_[0];
    }
  }
}

void PointProblem::Accumulate(const Row& row, double weight, double weighted_residual,
                              PointMatrix* normal, PointVector* right) const {
  // The range grows when the receiver moves away: its derivative is minus the direction.
  const Eigen::Vector3d slope = -row.direction;
  normal->topLeftCorner<3, 3>() += weight * slope * slope.transpose();
  right->head<3>() += weighted_residual * slope;
  const int zenith = 3 + clocks_;
  if (unknowns() > zenith && row.zenith_delay_factor != 0.0) {
    const double factor = row.zenith_delay_factor;
    normal->block<3, 1>(0, zenith) += weight * factor * slope;
    (*normal)(zenith, zenith) += weight * factor * factor;
    (*right)[zenith] += weighted_residual * factor;
    if (row.clock >= 0) (*normal)(3, zenith) += weight * factor;
    if (row.clock > 0) (*normal)(3 + row.clock, zenith) += weight * factor;
  }
  if (row.clock < 0) return;
  normal->block<3, 1>(0, 3) += weight * slope;
  (*normal)(3, 3) += weight;
  (*right)[3] += weighted_residual;
  if (row.clock == 0) return;
  const int k = 3 + row.clock;
  normal->block<3, 1>(0, k) += weight * slope;
  (*normal)(3, k) += weight;
  (*normal)(k, k) += weight;
  (*right)[k] += weighted_residual;
}

PointVector PointProblem::Slope(const Row& row) const {
  PointVector slope = PointVector::Zero(unknowns());
  slope.head<3>() = -row.direction;
  if (row.clock >= 0) slope[3] = 1.0;
  if (row.clock > 0) slope[3 + row.clock] = 1.0;
  if (unknowns() > 3 + clocks_) slope[3 + clocks_] = row.zenith_delay_factor;
  return slope;
}

void PointProblem::AccumulatePriors(PointMatrix* normal, PointVector* right) const {
  for (int clock = 1; clock < clocks_; ++clock) {
    const double information = 1.0 / (prior_sigma_m(clock) * prior_sigma_m(clock));
    (*normal)(3 + clock, 3 + clock) += information;
    (*right)[3 + clock] += information * (prior_m(clock) - clock_state_[clock]);
  }
  if (unknowns() > 3 + clocks_) {
    const double information = 1.0 / (zenith_delay_sigma_m_ * zenith_delay_sigma_m_);
    (*normal)(3 + clocks_, 3 + clocks_) += information;
    (*right)[3 + clocks_] -= information * zenith_delay_m_;
  }
  if (height_) {
    const double information = 1.0 / (height_->sigma_m * height_->sigma_m);
    (*normal)(2, 2) += information;
    (*right)[2] += information * height_residual_m(0.0);
  }
  if (place_) {
    normal->topLeftCorner<3, 3>() += place_->information_pm2;
    right->head<3>() += place_->pull_pm - place_->information_pm2 * place_offset_m_;
  }
}

double PointProblem::height_residual_m(double up_m) const {
  return height_->height_m - height_m_ - up_m;
}

double PointProblem::PriorCost() const {
  double cost = 0.0;
  for (int clock = 1; clock < clocks_; ++clock) {
    const double u = (prior_m(clock) - clock_state_[clock]) / prior_sigma_m(clock);
    cost += 0.5 * u * u;
  }
  if (unknowns() > 3 + clocks_) {
    const double u = zenith_delay_m_ / zenith_delay_sigma_m_;
    cost += 0.5 * u * u;
  }
  if (height_) {
    const double u = height_residual_m(0.0) / height_->sigma_m;
    cost += 0.5 * u * u;
  }
  if (place_) cost += place_->CostAt(place_offset_m_);
  return cost;
}

}  // namespace lodemark
