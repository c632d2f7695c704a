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

// Rows whose densities, each at least 1e-7, may be multiplied before a double needs new room.
constexpr std::size_t kRowsPerScale = 32;

// Of the logarithm of a density against that at the mode; more would be an overflow.
constexpr double kMostGain = 300.0;

double RadicalInverse(int index, int base) {
  double result = 0.0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) result += digit * (index % base);
  return result;
}

// Proposals are Student's t with so many degrees of freedom, scaled to the covariance asked for:
// late errors make tails that fall more slowly than a normal density, and samples that reach there
// must not be rare.
constexpr double kFreedom = 6.0;

// Newton's steps from the mode of the density, from where they cannot overshoot.
double ChiSquareQuantileOfSix(double probability) {
  double x = 4.0;
  for (int i = 0; i < 12; ++i) {
    const double tail = std::exp(-0.5 * x);
    const double excess = 1.0 - tail * (1.0 + 0.5 * x * (1.0 + 0.25 * x)) - probability;
    const double step = excess / (0.0625 * x * x * tail);
    x -= step;
    if (std::abs(step) < 1e-9 * x) break;
  }
  return x;
}

}  // namespace

PosteriorSampling::PosteriorSampling(int samples) : samples_(std::max(samples, 16)) {
  // Halton's points turned into normal ones by pairs (Box and Muller), spread by a fifth dimension,
  // and each with its mirror image: what is symmetric has its mean in the middle.
  std::vector<double> logarithms;
  for (std::size_t k = 0; k < samples_.count(); ++k) {
    const int i = static_cast<int>(k / 2) + 1;
    const double radius = std::sqrt(-2.0 * std::log(RadicalInverse(i, 2)));
    const double angle = 2.0 * kPi * RadicalInverse(i, 3);
    const double other_radius = std::sqrt(-2.0 * std::log(RadicalInverse(i, 5)));
    const double other_angle = 2.0 * kPi * RadicalInverse(i, 7);
    const Eigen::Vector4d normal(radius * std::cos(angle), radius * std::sin(angle),
                                 other_radius * std::cos(other_angle),
                                 other_radius * std::sin(other_angle));
    const Eigen::Vector4d point =
        std::sqrt((kFreedom - 2.0) / ChiSquareQuantileOfSix(RadicalInverse(i, 11))) * normal;
    samples_.SetPoint(k, k % 2 == 0 ? point : Eigen::Vector4d(-point));
    logarithms.push_back(0.5 * (kFreedom + 4.0) *
                         std::log1p(point.squaredNorm() / (kFreedom - 2.0)));
  }
  const double largest = *std::max_element(logarithms.begin(), logarithms.end());
  for (const double logarithm : logarithms) {
    inverse_of_proposal_.push_back(std::exp(logarithm - largest));
  }
}

PosteriorMoments PosteriorSampling::Round(const PointProblem& problem, const Eigen::Vector4d& mean,
                                          const Eigen::Matrix4d& covariance) {
  const Eigen::LLT<Eigen::Matrix4d> factor(covariance);
  const Eigen::Matrix4d root = factor.matrixL();
  std::copy(inverse_of_proposal_.begin(), inverse_of_proposal_.end(), samples_.weights().begin());
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const double centre_m = line.residual_m + line.slope.dot(mean);
    const Eigen::Vector4d slope_m = root.transpose() * line.slope;
    samples_.Multiply(tables_[i], static_cast<float>(centre_m), slope_m.cast<float>());
    if ((i + 1) % kRowsPerScale == 0) samples_.Normalise();
  }
  if (problem.height()) {
    for (std::size_t k = 0; k < samples_.count(); ++k) {
      const double up_m = mean[2] + root(2, 0) * samples_.coordinate(0, k) +
                          root(2, 1) * samples_.coordinate(1, k) +
                          root(2, 2) * samples_.coordinate(2, k);
      const double u = problem.height_residual_m(up_m) / problem.height()->sigma_m;
      samples_.weights()[k] *= std::exp(-0.5 * u * u);
    }
  }
  if (problem.place()) {
    const double at_state = problem.place()->CostAt(problem.place_offset_m());
    for (std::size_t k = 0; k < samples_.count(); ++k) {
      const Eigen::Vector4d standard(samples_.coordinate(0, k), samples_.coordinate(1, k),
                                     samples_.coordinate(2, k), samples_.coordinate(3, k));
      const Eigen::Vector3d step_m = (mean + root * standard).head<3>();
      const double gain = at_state - problem.place()->CostAt(problem.place_offset_m() + step_m);
      samples_.weights()[k] *= std::exp(std::min(gain, kMostGain));
    }
  }
  samples_.Normalise();

  // Moments of the weighted standard points, then turned into metres.
  const WeightedSums sums = samples_.Sum();
  const Eigen::Vector4d first = sums.first / sums.weights;
  const Eigen::Matrix4d second = sums.second / sums.weights;
  PosteriorMoments moments;
  moments.mean = mean + root * first;
  moments.covariance = root * (second - first * first.transpose()) * root.transpose();
  moments.effective_samples = sums.weights * sums.weights / sums.squared_weights;
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
  const double enough = kEnough * static_cast<double>(samples_.count());
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
