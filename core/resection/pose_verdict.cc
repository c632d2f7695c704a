#include "core/resection/pose_verdict.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

// Pairs of one sight's pixel and another's landmark that are looked at.
constexpr std::size_t kMostPairs = 20'000;

double Log10Choose(double of, double taken) {
  return (std::lgamma(of + 1.0) - std::lgamma(taken + 1.0) - std::lgamma(of - taken + 1.0)) /
         std::numbers::ln10;
}

// How many cells of the gate's width the pixels fall into.
std::size_t OccupiedCells(std::span<const LandmarkSight> sights,
                          std::span<const std::uint8_t> is_inlier, double gate_px) {
  std::vector<std::pair<double, double>> cells;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (is_inlier[i] == 0) continue;
    cells.emplace_back(std::floor(sights[i].pixel.x() / gate_px),
                       std::floor(sights[i].pixel.y() / gate_px));
  }
  std::sort(cells.begin(), cells.end());
  return static_cast<std::size_t>(
      std::distance(cells.begin(), std::unique(cells.begin(), cells.end())));
}

// How often the pixel of one sight lies within the gate of another's landmark, by an even choice of
// all pairs.
double StrayShare(const CameraPose& pose, std::span<const LandmarkSight> sights, const Lens& lens,
                  double gate_px) {
  std::vector<Eigen::Vector2d> predicted;
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const std::optional<Eigen::Vector2d> pixel =
        lens.Project(pose.matrix * (sights[i].landmark_in_enu_m - pose.centre_in_enu_m));
    if (!pixel) continue;
    predicted.push_back(*pixel);
    shown.push_back(i);
  }
  if (shown.empty() || sights.size() < 2) return 0.0;
  // Each landmark with the pixels of the sights that follow it at the same strides.
  const std::size_t others = sights.size() - 1;
  const std::size_t strides = std::clamp<std::size_t>(kMostPairs / shown.size(), 1, others);
  std::size_t hits = 0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    for (std::size_t s = 0; s < strides; ++s) {
      const std::size_t other = (shown[k] + 1 + s * others / strides) % sights.size();
      const double own_px = gate_px * sights[other].pixel_sigma_px;
      if ((sights[other].pixel - predicted[k]).squaredNorm() < own_px * own_px) ++hits;
    }
  }
  // Landmarks that the lens does not show agree with nothing.
  return static_cast<double>(hits) /
         (static_cast<double>(strides) * static_cast<double>(sights.size()));
}

}  // namespace

double Log10BinomialTail(std::size_t successes, std::size_t trials, double probability) {
  if (successes == 0 || probability >= 1.0) return 0.0;
  if (successes > trials || probability <= 0.0) return -std::numeric_limits<double>::infinity();
  const double n = static_cast<double>(trials);
  const double k = static_cast<double>(successes);
  const double first = Log10Choose(n, k) + k * std::log10(probability) +
                       (n - k) * std::log1p(-probability) / std::numbers::ln10;
  // Sum relative to the first term.
  const double odds = probability / (1.0 - probability);
  double term = 1.0;
  double sum = 1.0;
  for (double i = k; i < n; i += 1.0) {
    term *= odds * (n - i) / (i + 1.0);
    sum += term;
    if (term < 1e-12 * sum) break;
  }
  return std::min(first + std::log10(sum), 0.0);
}

double Log10Chance(const CameraPose& pose, std::span<const LandmarkSight> sights,
                   std::span<const std::uint8_t> is_inlier, const Lens& lens, double gate_px,
                   int sights_per_sample) {
  const std::size_t drawn = static_cast<std::size_t>(sights_per_sample);
  const std::size_t agreeing = OccupiedCells(sights, is_inlier, gate_px);
  const double n = static_cast<double>(sights.size());
  // Poses that a sample leaves: four of three points, two of two and the vertical.
  const double poses = sights_per_sample == 2 ? 2.0 : 4.0;
  const double log10_tests = std::log10(poses) + Log10Choose(n, sights_per_sample);
  if (agreeing <= drawn) return log10_tests;
  const double image_px2 = static_cast<double>(lens.parameters().width_px) *
                           static_cast<double>(lens.parameters().height_px);
  double own_variance = 0.0;
  for (const LandmarkSight& sight : sights) {
    own_variance += sight.pixel_sigma_px * sight.pixel_sigma_px / n;
  }
  const double share = std::max(kPi * gate_px * gate_px * own_variance / image_px2,
                                StrayShare(pose, sights, lens, gate_px));
  return log10_tests +
         Log10BinomialTail(agreeing - drawn, sights.size() - drawn, std::min(share, 1.0));
}

LandmarkSpread SpreadOf(std::span<const LandmarkSight> sights,
                        std::span<const std::uint8_t> is_used) {
  LandmarkSpread spread;
  double count = 0.0;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (!is_used.empty() && is_used[i] == 0) continue;
    spread.mean += sights[i].landmark_in_enu_m;
    count += 1.0;
  }
  if (count < 1.0) return spread;
  spread.mean /= count;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (!is_used.empty() && is_used[i] == 0) continue;
    const Eigen::Vector3d from_mean = sights[i].landmark_in_enu_m - spread.mean;
    second += from_mean * from_mean.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(second);
  if (eigen.info() != Eigen::Success) return spread;
  spread.sigma_m = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
  spread.axes = eigen.eigenvectors().rowwise().reverse();
  return spread;
}

CameraPose ReversedPose(const CameraPose& pose, const LandmarkSpread& spread) {
  // Two reflections: of the target in its own plane, and of what is seen along the line of sight.
  const Eigen::Vector3d mean_in_camera = pose.matrix * (spread.mean - pose.centre_in_enu_m);
  const Eigen::Vector3d sight = mean_in_camera.normalized();
  const Eigen::Vector3d normal = spread.axes.col(2);
  const Eigen::Matrix3d about_plane =
      Eigen::Matrix3d::Identity() - 2.0 * normal * normal.transpose();
  const Eigen::Matrix3d along_sight = Eigen::Matrix3d::Identity() - 2.0 * sight * sight.transpose();
  const Eigen::Matrix3d rotation = along_sight * pose.matrix * about_plane;
  const Eigen::Quaterniond turned(rotation);
  return CameraPose(Rigid3(turned, mean_in_camera - turned * spread.mean));
}

}  // namespace lodemark
