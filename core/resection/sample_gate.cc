#include "core/resection/sample_gate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Sigmas that a prior may be off by.
constexpr double kSigmas = 5.0;
constexpr double kPixelSlack = 5.0;  // sigmas of a sight

double AngleOf(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

}  // namespace

SampleGate::SampleGate(const SightTable& table, const ResectionPriors& priors)
    : table_(table), priors_(priors) {
  double lean_rad = 0.0;
  if (priors.gravity) {
    lean_rad = std::min(kSigmas * priors.gravity->sigma_rad, 3.0);
    least_up_cosine_ = std::cos(lean_rad);
  }
  if (!priors.position) return;
  const Eigen::Vector3d& place = priors.position->position_in_enu_m;
  const Eigen::Matrix3d& covariance = priors.position->covariance_m2;
  // A pose of few sights leans with the gravity it was given, which moves its centre.
  std::vector<double> distances;
  distances.reserve(table.size());
  for (std::size_t row = 0; row < table.size(); ++row) {
    distances.push_back((table.landmark(row) - place).norm());
  }
  double slack_m = 0.0;
  if (priors.gravity && !distances.empty()) {
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    slack_m = priors.gravity->sigma_rad * *middle;
  }
  const Eigen::Matrix3d widened = covariance + slack_m * slack_m * Eigen::Matrix3d::Identity();
  information_pm2_ = Eigen::LLT<Eigen::Matrix3d>(widened).solve(Eigen::Matrix3d::Identity());

  direction_.reserve(table.size());
  doubt_rad_.reserve(table.size());
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Eigen::Vector3d ray = table.landmark(row) - place;
    const double squared_m2 = ray.squaredNorm();
    if (!(squared_m2 > 0.0)) {
      direction_.push_back(Eigen::Vector3d::UnitX());
      doubt_rad_.push_back(10.0);
      continue;
    }
    direction_.push_back(ray / std::sqrt(squared_m2));
    // What the covariance is worth across the ray, at most.
    const double across_m2 =
        covariance.trace() - direction_.back().dot(covariance * direction_.back());
    const double pixels = kPixelSlack / (kSigmas * table.tangent(row).norm());
    const double landmark_m2 = table.spread_m2(row) / table.tangent(row).squaredNorm();
    const double sine = kSigmas * std::sqrt((across_m2 + landmark_m2) / squared_m2);
    doubt_rad_.push_back(sine < 0.9 ? std::asin(sine) + kSigmas * pixels : 10.0);
  }
}

bool SampleGate::AdmitsSight(std::size_t row) const {
  if (!priors_.position || !priors_.gravity || doubt_rad_[row] > 1.5) return true;
  const double seen_rad = AngleOf(table_.bearing(row).dot(priors_.gravity->up_in_camera));
  const double mapped_rad = AngleOf(direction_[row].z());
  return std::abs(seen_rad - mapped_rad) < doubt_rad_[row] + kSigmas * priors_.gravity->sigma_rad;
}

bool SampleGate::AdmitsPair(std::size_t a, std::size_t b) const {
  if (!priors_.position) return true;
  const double doubt_rad = doubt_rad_[a] + doubt_rad_[b];
  if (doubt_rad > 1.5) return true;
  const double seen_rad = AngleOf(table_.bearing(a).dot(table_.bearing(b)));
  const double mapped_rad = AngleOf(direction_[a].dot(direction_[b]));
  return std::abs(seen_rad - mapped_rad) < doubt_rad;
}

bool SampleGate::AdmitsPose(const Rigid3& camera_from_world) const {
  const Eigen::Matrix3d rotation = camera_from_world.rotation().toRotationMatrix();
  if (priors_.gravity && rotation.col(2).dot(priors_.gravity->up_in_camera) < least_up_cosine_) {
    return false;
  }
  if (!priors_.position) return true;
  const Eigen::Vector3d centre = -(rotation.transpose() * camera_from_world.translation());
  const Eigen::Vector3d miss = centre - priors_.position->position_in_enu_m;
  return miss.dot(information_pm2_ * miss) < kSigmas * kSigmas;
}

}  // namespace lodemark
