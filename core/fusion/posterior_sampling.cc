#include "core/fusion/posterior_sampling.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr int kMostRounds = 6;

// Share of the samples that must be effective for a round to be the last.
constexpr double kEnough = 0.3;

double RadicalInverse(int index, int base) {
  double result = 0.0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) result += digit * (index % base);
  return result;
}

// Pairs of uniform numbers to pairs of normal ones (Box and Muller).
Eigen::Vector2d NormalPair(double u, double v) {
  const double radius = std::sqrt(-2.0 * std::log(u));
  return {radius * std::cos(2.0 * kPi * v), radius * std::sin(2.0 * kPi * v)};
}

}  // namespace

PosteriorSampling::PosteriorSampling(int samples) {
  const auto count = static_cast<std::size_t>(std::max(samples, 16));
  normal_points_.reserve(count);
  for (int i = 1; i <= static_cast<int>(count); ++i) {
    Eigen::Vector4d point;
    point.head<2>() = NormalPair(RadicalInverse(i, 2), RadicalInverse(i, 3));
    point.tail<2>() = NormalPair(RadicalInverse(i, 5), RadicalInverse(i, 7));
    normal_points_.push_back(point);
  }
  log_weights_.resize(count);
  points_.resize(count);
}

PosteriorMoments PosteriorSampling::Round(const PointProblem& problem, const Eigen::Vector4d& mean,
                                          const Eigen::Matrix4d& covariance) {
  const Eigen::LLT<Eigen::Matrix4d> factor(covariance);
  const Eigen::Matrix4d root = factor.matrixL();
  double largest = -1e300;
  for (std::size_t s = 0; s < normal_points_.size(); ++s) {
    const Eigen::Vector4d point = mean + root * normal_points_[s];
    points_[s] = point;
    double log_density = 0.0;
    double product = 1.0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Line& line = lines_[i];
      const double residual_m =
          line.residual_m + line.direction.dot(point.head<3>()) - line.clock * point[3];
      product *= tables_[i](residual_m);
      if (product < 1e-200) {
        log_density += std::log(product);
        product = 1.0;
      }
    }
    log_density += std::log(product);
    if (problem.height()) {
      const double u = problem.height_residual_m(point[2]) / problem.height()->sigma_m;
      log_density -= 0.5 * u * u;
    }
    log_weights_[s] = log_density + 0.5 * normal_points_[s].squaredNorm();
    largest = std::max(largest, log_weights_[s]);
  }
  PosteriorMoments moments;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (std::size_t s = 0; s < points_.size(); ++s) {
    const double weight = std::exp(log_weights_[s] - largest);
    log_weights_[s] = weight;
    sum += weight;
    sum_of_squares += weight * weight;
    moments.mean += weight * points_[s];
  }
  moments.mean /= sum;
  for (std::size_t s = 0; s < points_.size(); ++s) {
    const Eigen::Vector4d off = points_[s] - moments.mean;
    moments.covariance += log_weights_[s] / sum * off * off.transpose();
  }
  moments.effective_samples = sum * sum / sum_of_squares;
  return moments;
}

PosteriorMoments PosteriorSampling::Run(const PointProblem& problem,
                                        const Eigen::Matrix4d& proposal) {
  tables_.resize(problem.rows().size());
  lines_.resize(problem.rows().size());
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const PointProblem::Row& row = problem.rows()[i];
    tables_[i].Fill(row.error);
    lines_[i] = {row.direction, problem.Residual(row), row.clock < 0 ? 0.0 : 1.0};
  }
  PosteriorMoments moments = Round(problem, Eigen::Vector4d::Zero(), proposal);
  const double enough = kEnough * static_cast<double>(points_.size());
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
