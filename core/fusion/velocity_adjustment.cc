#include "core/fusion/velocity_adjustment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

constexpr int kFewest = 4;

// A rate of less weight, beyond some 4 sigma, contradicts the others.
constexpr double kContradicts = 0.1;

}  // namespace

bool AdjustVelocity(std::span<const RangeRateObservation> observations, VelocityEstimate* estimate,
                    std::vector<RateVerdict>* verdicts) {
  *estimate = VelocityEstimate();
  verdicts->assign(observations.size(), RateVerdict());
  if (observations.size() < kFewest) return false;

  Eigen::Vector4d state = Eigen::Vector4d::Zero();  // velocity, clock drift
  Eigen::Matrix4d normal;
  // Kernels that shrink from "everything counts" to a redescending one of three sigma.
  double width = 1e6;
  for (int i = 0; i < 14; ++i) {
    normal.setZero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t k = 0; k < observations.size(); ++k) {
      const RangeRateObservation& observation = observations[k];
      Eigen::Vector4d row;
      row << -observation.direction_in_ecef, 1.0;
      const double residual_mps = observation.rate_mps - row.dot(state);
      const double u = residual_mps / (width * observation.sigma_mps);
      const double share = 1.0 / ((1.0 + u * u) * (1.0 + u * u));
      const double weight = share / (observation.sigma_mps * observation.sigma_mps);
      normal.noalias() += weight * row * row.transpose();
      right += weight * residual_mps * row;
      (*verdicts)[k] = {residual_mps, share};
    }
    const Eigen::LDLT<Eigen::Matrix4d> factor(normal);
    if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() <= 1e-9) return false;
    const Eigen::Vector4d step = factor.solve(right);
    state += step;
    if (width > 3.0) {
      width = i == 0 ? 64.0 : std::max(3.0, 0.5 * width);
    } else if (step.norm() < 1e-4) {
      break;
    }
  }
  double cost = 0.0;
  double count = 0.0;
  bool contradicted = false;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    RateVerdict& verdict = (*verdicts)[k];
    Eigen::Vector4d row;
    row << -observations[k].direction_in_ecef, 1.0;
    verdict.residual_mps = observations[k].rate_mps - row.dot(state);
    const double u = verdict.residual_mps / observations[k].sigma_mps;
    cost += verdict.weight * u * u;
    count += verdict.weight;
    if (verdict.weight >= 0.5) ++estimate->used;
    contradicted = contradicted || verdict.weight < kContradicts;
  }
  // Any four rates agree; to prove another wrong takes a fifth.
  if (estimate->used < kFewest + (contradicted ? 1 : 0)) return false;
  // The spread found, if it exceeds the stated one.
  const double factor = std::max(1.0, cost / std::max(1.0, count - 4.0));
  const Eigen::Matrix4d covariance = factor * normal.ldlt().solve(Eigen::Matrix4d::Identity());
  estimate->velocity_in_ecef_mps = state.head<3>();
  estimate->clock_drift_mps = state[3];
  estimate->covariance_ecef_m2ps2 = covariance.topLeftCorner<3, 3>();
  return true;
}

}  // namespace lodemark
