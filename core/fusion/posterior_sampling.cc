#include "core/fusion/posterior_sampling.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr int kMostRounds = 6;

// Share of the samples that must be effective for a round to be the last.
constexpr double kEnough = 0.2;

// Rows whose densities, each at least 1e-7, may be multiplied before a double needs its logarithm.
constexpr std::size_t kRowsPerLogarithm = 32;

double RadicalInverse(int index, int base) {
  double result = 0.0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) result += digit * (index % base);
  return result;
}

}  // namespace

PosteriorSampling::PosteriorSampling(int samples) : samples_(std::max(samples, 16)) {
  // Halton's points turned into normal ones by pairs (Box and Muller).
  for (int i = 1; i <= samples_; ++i) {
    const double radius = std::sqrt(-2.0 * std::log(RadicalInverse(i, 2)));
    const double angle = 2.0 * kPi * RadicalInverse(i, 3);
    const double other_radius = std::sqrt(-2.0 * std::log(RadicalInverse(i, 5)));
    const double other_angle = 2.0 * kPi * RadicalInverse(i, 7);
    normal_[0].push_back(static_cast<float>(radius * std::cos(angle)));
    normal_[1].push_back(static_cast<float>(radius * std::sin(angle)));
    normal_[2].push_back(static_cast<float>(other_radius * std::cos(other_angle)));
    normal_[3].push_back(static_cast<float>(other_radius * std::sin(other_angle)));
    log_of_proposal_.push_back(0.5 * (radius * radius + other_radius * other_radius));
  }
  const auto count = static_cast<std::size_t>(samples_);
  residuals_m_.resize(count);
  products_.resize(count);
  log_weights_.resize(count);
}

PosteriorMoments PosteriorSampling::Round(const PointProblem& problem, const Eigen::Vector4d& mean,
                                          const Eigen::Matrix4d& covariance) {
  const Eigen::LLT<Eigen::Matrix4d> factor(covariance);
  const Eigen::Matrix4d root = factor.matrixL();
  const std::size_t count = log_weights_.size();
  const float* n0 = normal_[0].data();
  const float* n1 = normal_[1].data();
  const float* n2 = normal_[2].data();
  const float* n3 = normal_[3].data();
  std::copy(log_of_proposal_.begin(), log_of_proposal_.end(), log_weights_.begin());
  std::fill(products_.begin(), products_.end(), 1.0);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const auto centre_m = static_cast<float>(line.residual_m + line.slope.dot(mean));
    const Eigen::Vector4f s = (root.transpose() * line.slope).cast<float>();
    for (std::size_t k = 0; k < count; ++k) {
      residuals_m_[k] = centre_m + s[0] * n0[k] + s[1] * n1[k] + s[2] * n2[k] + s[3] * n3[k];
    }
    const DensityTable& table = tables_[i];
    for (std::size_t k = 0; k < count; ++k) {
      products_[k] *= static_cast<double>(table(residuals_m_[k]));
    }
    if ((i + 1) % kRowsPerLogarithm == 0 || i + 1 == lines_.size()) {
      for (std::size_t k = 0; k < count; ++k) {
        log_weights_[k] += std::log(products_[k]);
        products_[k] = 1.0;
      }
    }
  }
  double largest = -1e300;
  for (std::size_t k = 0; k < count; ++k) {
    if (problem.height()) {
      const double up_m = mean[2] + root(2, 0) * static_cast<double>(n0[k]) +
                          root(2, 1) * static_cast<double>(n1[k]) +
                          root(2, 2) * static_cast<double>(n2[k]);
      const double u = problem.height_residual_m(up_m) / problem.height()->sigma_m;
      log_weights_[k] -= 0.5 * u * u;
    }
    largest = std::max(largest, log_weights_[k]);
  }

  // Moments of the weighted standard points, then turned into metres.
  double sum = 0.0;
  double sum_of_squares = 0.0;
  Eigen::Vector4d first = Eigen::Vector4d::Zero();
  Eigen::Matrix4d second = Eigen::Matrix4d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const double exponent = log_weights_[k] - largest;
    if (exponent < -30.0) continue;
    const double weight = std::exp(exponent);
    const Eigen::Vector4d point(static_cast<double>(n0[k]), static_cast<double>(n1[k]),
                                static_cast<double>(n2[k]), static_cast<double>(n3[k]));
    sum += weight;
    sum_of_squares += weight * weight;
    first += weight * point;
    second.noalias() += weight * point * point.transpose();
  }
  first /= sum;
  PosteriorMoments moments;
  moments.mean = mean + root * first;
  moments.covariance = root * (second / sum - first * first.transpose()) * root.transpose();
  moments.effective_samples = sum * sum / sum_of_squares;
  return moments;
}

PosteriorMoments PosteriorSampling::Run(const PointProblem& problem,
                                        const Eigen::Matrix4d& proposal) {
  tables_.resize(problem.rows().size());
  lines_.clear();
  for (const PointProblem::Row& row : problem.rows()) {
    // Holding a clock that this range alone determines would make the range tell something.
    if (row.clock > 0 && !problem.IsShared(row.clock)) continue;
    tables_[lines_.size()].Fill(row.error);
    Line& line = lines_.emplace_back();
    line.slope << row.direction, (row.clock < 0 ? 0.0 : -1.0);
    line.residual_m = problem.Residual(row);
  }
  PosteriorMoments moments = Round(problem, Eigen::Vector4d::Zero(), proposal);
  const double enough = kEnough * static_cast<double>(samples_);
  for (int round = 1; round < kMostRounds; ++round) {
    // A few lucky samples must not narrow the next round to nothing.
    const double keep = 1.0 / std::max(1.0, moments.effective_samples / 8.0);
    const Eigen::Matrix4d covariance =
        1.5 * moments.covariance + 0.25 * keep * proposal + 0.01 * Eigen::Matrix4d::Identity();
    moments = Round(problem, moments.mean, covariance);
    if (moments.effective_samples > enough) break;
  }
  return moments;
}

}  // namespace lodemark
