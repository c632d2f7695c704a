#include "core/resection/refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/resection/collinearity.h"

namespace lodemark {
namespace {

constexpr double kFirstDamping = 1e-5;
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e10;

// Squared step in units of its own standard deviation, below which nothing more is gained: a
// hundred-thousandth of a sigma.
constexpr double kConverged = 1e-10;

// A sight and the weight that it keeps throughout: the covariance of its residual at the start.
struct WeighedSight {
  const LandmarkSight* sight = nullptr;
  Eigen::Matrix2d weight_ppx2 = Eigen::Matrix2d::Identity();
};

std::vector<WeighedSight> WeighedSights(const CameraPose& start,
                                        std::span<const LandmarkSight> sights,
                                        std::span<const std::uint8_t> is_used, const Lens& lens,
                                        double noise_px, bool keep_unseen) {
  std::vector<WeighedSight> weighed;
  weighed.reserve(sights.size());
  LinearSight linear;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (!is_used.empty() && is_used[i] == 0) continue;
    const bool seen = Linearise(sights[i], start, lens, &linear);
    if (!seen && !keep_unseen) continue;
    if (!seen) linear.by_landmark.setZero();
    const Eigen::Matrix2d covariance = PixelCovariance(sights[i], linear.by_landmark, noise_px);
    const Eigen::Matrix2d weight = covariance.inverse();
    if (weight.allFinite()) weighed.push_back({&sights[i], weight});
  }
  return weighed;
}

// Cost and normal equations at one pose.
struct Normals {
  double cost = 0.0;
  Matrix6d information = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
};

// limit: squared sigmas beyond which a sight stops counting. Without one, no sight may leave the
// lens's field.
Normals NormalsAt(const CameraPose& pose, const std::vector<WeighedSight>& sights, const Lens& lens,
                  const ResectionPriors& priors, double limit) {
  Normals normals;
  LinearSight linear;
  for (const WeighedSight& weighed : sights) {
    if (!Linearise(*weighed.sight, pose, lens, &linear)) {
      normals.cost += 0.5 * limit;
      continue;
    }
    const Eigen::Vector2d weighted = weighed.weight_ppx2 * linear.residual_px;
    const double square = weighted.dot(linear.residual_px);
    if (!(square < limit)) {
      normals.cost += 0.5 * limit;
      continue;
    }
    normals.cost += 0.5 * square;
    const Eigen::Matrix<double, 2, 6> by_pose = weighed.weight_ppx2 * linear.by_pose;
    normals.information.noalias() += linear.by_pose.transpose() * by_pose;
    normals.right.noalias() += linear.by_pose.transpose() * weighted;
  }
  normals.cost += PriorCost(priors, pose, &normals.information, &normals.right);
  return normals;
}

}  // namespace

RefinedPose RefinePose(const Rigid3& start_camera_from_enu, std::span<const LandmarkSight> sights,
                       std::span<const std::uint8_t> is_used, const Lens& lens,
                       const ResectionPriors& priors, const RefinementOptions& options) {
  const bool robust = options.kernel_sigmas > 0.0;
  const double limit = robust ? options.kernel_sigmas * options.kernel_sigmas
                              : std::numeric_limits<double>::infinity();
  CameraPose pose(start_camera_from_enu);
  const std::vector<WeighedSight> weighed =
      WeighedSights(pose, sights, is_used, lens, options.noise_px, robust);
  Normals normals = NormalsAt(pose, weighed, lens, priors, limit);

  RefinedPose refined;
  double damping = kFirstDamping;
  while (refined.iterations < options.most_iterations && damping < kMostDamping) {
    ++refined.iterations;
    Matrix6d damped = normals.information;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += std::numeric_limits<double>::min();
    const Eigen::LDLT<Matrix6d> factor(damped);
    const Vector6d step = factor.solve(normals.right);
    if (factor.info() != Eigen::Success || !step.allFinite()) break;
    const bool is_newton = damping < 1e-3;
    if (is_newton && step.dot(normals.information * step) < kConverged) {
      refined.converged = true;
      break;
    }
    const CameraPose moved = pose.Moved(step);
    const Normals there = NormalsAt(moved, weighed, lens, priors, limit);
    if (there.cost < normals.cost) {
      pose = moved;
      normals = there;
      damping = std::max(damping * 0.1, kLeastDamping);
    } else {
      // At the bottom, rounding decides which cost is less.
      if (is_newton && step.dot(normals.right) < 1e-9 * (1.0 + normals.cost)) {
        refined.converged = true;
        break;
      }
      damping = std::max(damping * 10.0, 1e-4);
    }
  }
  refined.camera_from_enu = refined.iterations > 0 ? pose.camera_from_enu() : start_camera_from_enu;
  refined.cost = normals.cost;
  refined.information = normals.information;
  return refined;
}

}  // namespace lodemark
