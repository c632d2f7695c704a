#include "tools/mapping/georegistration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Jacobian = Eigen::Matrix<double, 3, 7>;

constexpr int kParameters = 7;
constexpr int kMostSamples = 3000;
// That a sample of three points that agree was not missed.
constexpr double kConfidence = 0.999999;
constexpr int kMostIterations = 50;
// Where the Cauchy kernel begins to doubt, in sigmas of a residual of three dimensions.
constexpr double kCauchySigmas = 2.5;
// A sample whose triangle is flatter says nothing about the turn around its longest side.
constexpr double kFlattestSample = 1e-3;

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond TurnBy(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle < 1e-12) return Eigen::Quaterniond(1.0, turn.x() / 2, turn.y() / 2, turn.z() / 2);
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

// The residual of a tie point, and its Cholesky factor to weigh it with.
Eigen::Vector3d ResidualOf(const TiePoint& tie, const Similarity3& similarity) {
  return tie.in_enu_m - similarity * tie.in_model;
}

Eigen::LLT<Eigen::Matrix3d> WeightOf(const TiePoint& tie, const Similarity3& similarity) {
  const Eigen::Matrix3d turn = similarity.scale * similarity.rotation.toRotationMatrix();
  const Eigen::Matrix3d covariance =
      tie.covariance_m2 + turn * tie.covariance_in_model * turn.transpose();
  return Eigen::LLT<Eigen::Matrix3d>(covariance);
}

double SigmasOf(const TiePoint& tie, const Similarity3& similarity) {
  const Eigen::Vector3d whitened =
      WeightOf(tie, similarity).matrixL().solve(ResidualOf(tie, similarity));
  const double sigmas = whitened.norm();
  return std::isfinite(sigmas) ? sigmas : std::numeric_limits<double>::infinity();
}

class Registration {
 public:
  Registration(std::span<const TiePoint> ties, const GeoregistrationOptions& options)
      : ties_(ties), options_(options), weights_(ties.size(), 0.0) {}

  // Sum of truncated squares: what the samples compete in.
  double Score(const Similarity3& similarity) const {
    const double most = options_.mistaken_sigmas * options_.mistaken_sigmas;
    double score = 0.0;
    for (const TiePoint& tie : ties_) {
      const double sigmas = SigmasOf(tie, similarity);
      score += std::min(sigmas * sigmas, most);
    }
    return score;
  }

  std::optional<Similarity3> Propose(const std::array<std::size_t, 3>& sample) const {
    std::array<Eigen::Vector3d, 3> sources;
    std::array<Eigen::Vector3d, 3> targets;
    for (std::size_t i = 0; i < 3; ++i) {
      sources[i] = ties_[sample[i]].in_model;
      targets[i] = ties_[sample[i]].in_enu_m;
    }
    for (const auto& corners : {sources, targets}) {
      const Eigen::Vector3d a = corners[1] - corners[0];
      const Eigen::Vector3d b = corners[2] - corners[0];
      const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
      if (!(a.cross(b).norm() > kFlattestSample * longest * longest)) return std::nullopt;
    }
    return SimilarityFromPoints(sources, targets, {});
  }

  // Robust weights for where the points lie now.
  void WeighByCauchy(const Similarity3& similarity) {
    for (std::size_t i = 0; i < ties_.size(); ++i) {
      const double relative = SigmasOf(ties_[i], similarity) / kCauchySigmas;
      weights_[i] = 1.0 / (1.0 + relative * relative);
    }
  }

  // Weight one for the points that agree; their number.
  int WeighByAgreement(const Similarity3& similarity) {
    int used = 0;
    for (std::size_t i = 0; i < ties_.size(); ++i) {
      const bool agrees = SigmasOf(ties_[i], similarity) <= options_.mistaken_sigmas;
      weights_[i] = agrees ? 1.0 : 0.0;
      used += agrees ? 1 : 0;
    }
    return used;
  }

  Eigen::Vector3d WeightedCentre() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double total = 0.0;
    for (std::size_t i = 0; i < ties_.size(); ++i) {
      sum += weights_[i] * ties_[i].in_model;
      total += weights_[i];
    }
    return total > 0.0 ? Eigen::Vector3d(sum / total) : sum;
  }

  // Half the weighted sum of squares, with the normal equations about the centre.
  double Linearise(const Similarity3& similarity, const Eigen::Vector3d& centre, Matrix7* normal,
                   Vector7* gradient) const {
    normal->setZero();
    gradient->setZero();
    double cost = 0.0;
    for (std::size_t i = 0; i < ties_.size(); ++i) {
      if (!(weights_[i] > 0.0)) continue;
      const Eigen::LLT<Eigen::Matrix3d> weight = WeightOf(ties_[i], similarity);
      const Eigen::Vector3d arm =
          similarity.scale * (similarity.rotation * (ties_[i].in_model - centre));
      Jacobian jacobian;
      jacobian << Eigen::Matrix3d::Identity(), -CrossMatrix(arm), arm;
      const Jacobian whitened = weight.matrixL().solve(jacobian);
      const Eigen::Vector3d residual = weight.matrixL().solve(ResidualOf(ties_[i], similarity));
      *normal += weights_[i] * whitened.transpose() * whitened;
      *gradient += weights_[i] * whitened.transpose() * residual;
      cost += 0.5 * weights_[i] * residual.squaredNorm();
    }
    return cost;
  }

  // Levenberg-Marquardt with the weights there are.
  Similarity3 Refine(Similarity3 similarity, int iterations) const {
    const Eigen::Vector3d centre = WeightedCentre();
    double damping = 1e-6;
    Matrix7 normal;
    Vector7 gradient;
    double cost = Linearise(similarity, centre, &normal, &gradient);
    for (int i = 0; i < iterations; ++i) {
      Matrix7 damped = normal;
      damped.diagonal() += damping * normal.diagonal() + Vector7::Constant(1e-300);
      const Eigen::LDLT<Matrix7> factor(damped);
      const Vector7 step = factor.solve(gradient);
      if (factor.info() != Eigen::Success || !step.allFinite()) break;
      const Similarity3 tried = Moved(similarity, centre, step);
      Matrix7 tried_normal;
      Vector7 tried_gradient;
      const double tried_cost = Linearise(tried, centre, &tried_normal, &tried_gradient);
      if (!(tried_cost <= cost)) {
        damping = std::max(damping, 1e-9) * 10.0;
        if (damping > 1e12) break;
        continue;
      }
      const bool settled = cost - tried_cost <= 1e-14 * cost;
      similarity = tried;
      cost = tried_cost;
      normal = tried_normal;
      gradient = tried_gradient;
      damping *= 0.1;
      if (settled) break;
    }
    return similarity;
  }

  static Similarity3 Moved(const Similarity3& similarity, const Eigen::Vector3d& centre,
                           const Vector7& step) {
    const Eigen::Vector3d centre_in_enu = similarity * centre + step.head<3>();
    Similarity3 moved;
    moved.rotation = (TurnBy(step.segment<3>(3)) * similarity.rotation).normalized();
    moved.scale = similarity.scale * std::exp(std::clamp(step(6), -1.0, 1.0));
    moved.translation = centre_in_enu - moved.scale * (moved.rotation * centre);
    return moved;
  }

  std::span<const double> weights() const { return weights_; }

 private:
  std::span<const TiePoint> ties_;
  const GeoregistrationOptions& options_;
  std::vector<double> weights_;
};

// The best of what samples of three propose; each new best is improved at once on all that agree
// with it (Chum, Matas, Kittler 2003, "Locally optimized RANSAC").
std::optional<Similarity3> BestProposal(std::span<const TiePoint> ties, Registration* registration,
                                        std::uint64_t seed) {
  Random random(seed);
  std::optional<Similarity3> best;
  double best_score = std::numeric_limits<double>::infinity();
  const std::size_t n = ties.size();
  int samples = kMostSamples;
  for (int k = 0; k < samples; ++k) {
    std::array<std::size_t, 3> sample = {random.Index(n), random.Index(n - 1), random.Index(n - 2)};
    if (sample[1] >= sample[0]) ++sample[1];
    for (const std::size_t taken :
         {std::min(sample[0], sample[1]), std::max(sample[0], sample[1])}) {
      if (sample[2] >= taken) ++sample[2];
    }
    std::optional<Similarity3> proposed = registration->Propose(sample);
    if (!proposed) continue;
    double score = registration->Score(*proposed);
    if (!(score < best_score)) continue;
    if (registration->WeighByAgreement(*proposed) >= 3) {
      const Similarity3 improved = registration->Refine(*proposed, 5);
      const double improved_score = registration->Score(improved);
      if (improved_score < score) {
        proposed = improved;
        score = improved_score;
      }
    }
    best = proposed;
    best_score = score;
    const double share = registration->WeighByAgreement(*best) / static_cast<double>(n);
    const double missed = 1.0 - share * share * share;
    if (missed < 1.0) {
      const double needed = std::log(1.0 - kConfidence) / std::log(std::max(missed, 1e-12));
      samples = std::min(samples, std::max(50, static_cast<int>(std::ceil(needed))));
    }
  }
  return best;
}

Error Degenerate(double turn_sigma_rad, double scale_sigma) {
  char text[200];
  if (turn_sigma_rad < 1e3) {
    std::snprintf(text, sizeof text,
                  "the places do not fix the model: they lie near one line, its turn would be "
                  "known to %.0f degrees and its scale to %.0f %% only",
                  turn_sigma_rad * kDegreesPerRadian, 100.0 * scale_sigma);
    return {ErrorCode::kBadData, text};
  }
  return {ErrorCode::kBadData, "the places do not fix the model: they lie on one line"};
}

// The tie points' common line or place leaves the model free to turn.
bool AllOnOneLine(std::span<const TiePoint> ties) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const TiePoint& tie : ties) mean += tie.in_model / static_cast<double>(ties.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const TiePoint& tie : ties) {
    spread += (tie.in_model - mean) * (tie.in_model - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> extents(spread, Eigen::EigenvaluesOnly);
  return !(extents.eigenvalues()(1) > kFlattestSample * kFlattestSample * extents.eigenvalues()(2));
}

}  // namespace

Eigen::Matrix3d Georegistration::CovarianceAt(const Eigen::Vector3d& place_in_enu_m) const {
  const Eigen::Vector3d arm = place_in_enu_m - centre_in_enu_m;
  Jacobian jacobian;
  jacobian << Eigen::Matrix3d::Identity(), -CrossMatrix(arm), arm;
  return jacobian * covariance * jacobian.transpose();
}

Result<Georegistration> Georegister(std::span<const TiePoint> ties,
                                    const GeoregistrationOptions& options) {
  if (ties.size() < 3) {
    return Error{ErrorCode::kBadData, "three places are needed to lay the model on the earth, " +
                                          std::to_string(ties.size()) + " are known"};
  }
  Registration registration(ties, options);
  std::optional<Similarity3> best = BestProposal(ties, &registration, options.seed);
  if (!best) {
    if (AllOnOneLine(ties)) return Degenerate(std::numeric_limits<double>::infinity(), 0.0);
    return Error{ErrorCode::kBadData,
                 "no three of the places have the shape they have in the model"};
  }
  Similarity3 similarity = *best;
  for (int i = 0; i < kMostIterations / 5; ++i) {
    registration.WeighByCauchy(similarity);
    similarity = registration.Refine(similarity, 5);
  }
  int used = registration.WeighByAgreement(similarity);
  for (int i = 0; i < 3 && used >= 3; ++i) {
    similarity = registration.Refine(similarity, kMostIterations);
    const int now = registration.WeighByAgreement(similarity);
    if (now == used) break;
    used = now;
  }
  // Chance lets any three agree in shape well enough; one more must confirm them where there is
  // one.
  if (used < 3 || (used == 3 && ties.size() > 4)) {
    return Error{ErrorCode::kBadData,
                 "no more than three of " + std::to_string(ties.size()) +
                     " places agree with the model: wrong names, wrong sigmas, or another model?"};
  }

  Georegistration result;
  result.enu_from_model = similarity;
  result.used = used;
  const Eigen::Vector3d centre = registration.WeightedCentre();
  result.centre_in_enu_m = similarity * centre;
  Matrix7 normal;
  Vector7 gradient;
  const double cost = registration.Linearise(similarity, centre, &normal, &gradient);
  const Eigen::SelfAdjointEigenSolver<Matrix7> eigen(normal);
  const int redundancy = 3 * used - kParameters;
  result.unit_sigma = std::sqrt(2.0 * cost / redundancy);
  const double variance = std::max(1.0, result.unit_sigma * result.unit_sigma);
  if (!(eigen.eigenvalues()(0) > 1e-15 * eigen.eigenvalues()(6))) {
    return Degenerate(std::numeric_limits<double>::infinity(), 0.0);
  }
  result.covariance = variance * eigen.eigenvectors() *
                      eigen.eigenvalues().cwiseInverse().asDiagonal() *
                      eigen.eigenvectors().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> turn(result.covariance.block<3, 3>(3, 3),
                                                            Eigen::EigenvaluesOnly);
  const double turn_sigma_rad = std::sqrt(turn.eigenvalues()(2));
  const double scale_sigma = std::sqrt(result.covariance(6, 6));
  if (!(turn_sigma_rad <= options.largest_turn_sigma_rad) ||
      !(scale_sigma <= options.largest_scale_sigma)) {
    return Degenerate(turn_sigma_rad, scale_sigma);
  }
  for (std::size_t i = 0; i < ties.size(); ++i) {
    result.residuals.push_back({ResidualOf(ties[i], similarity), SigmasOf(ties[i], similarity),
                                registration.weights()[i] > 0.0});
  }
  return result;
}

}  // namespace lodemark
