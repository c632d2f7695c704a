#include "tools/mapping/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "tools/mapping/triangulation.h"

namespace lodemark {
namespace {

// Measured on photographs with surveyed poses; as the look-up weighs the features of a query.
constexpr double kLeastSigma_px = 0.2;
constexpr double kSiftSigmaOfSize = 0.04;
constexpr double kOrbSigmaOfSize = 0.02;

// What is known of one landmark's noise from all others counts as so many of its own redundancies.
constexpr double kCommonRedundancy = 4.0;

// Of chi-square with so many degrees of freedom (Wilson and Hilferty 1931).
double ChiSquareMedian(double freedom) {
  return freedom * std::pow(1.0 - 2.0 / (9.0 * freedom), 3);
}

// How well the views of one landmark agree.
struct Agreement {
  double squares = 0.0;  // of the residuals in their sigmas
  double redundancy = 0.0;
};

// Variance of what is out by its sigma, by the weighted median over landmarks: mistaken views and
// poses that are out do not make all landmarks uncertain.
double CommonVariance(const std::vector<Agreement>& all) {
  std::vector<std::pair<double, double>> variances;  // with the weight of each
  double half = 0.0;
  for (const Agreement& one : all) {
    if (!(one.redundancy > 0.0)) continue;
    variances.emplace_back(one.squares / ChiSquareMedian(one.redundancy), one.redundancy);
    half += 0.5 * one.redundancy;
  }
  std::sort(variances.begin(), variances.end());
  for (const auto& [variance, weight] : variances) {
    half -= weight;
    if (half <= 0.0) return variance;
  }
  return 1.0;
}

using Solver = std::function<std::optional<TriangulatedPoint>(std::size_t track,
                                                              std::span<const PointView> views)>;

void SolveTracks(const std::vector<FeatureTrack>& tracks, const Solver& solve,
                 const Progress& progress, Reconstruction* reconstruction) {
  std::vector<Agreement> agreements;
  std::vector<PointView> views;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (t % 256 == 0) progress(static_cast<double>(t) / static_cast<double>(tracks.size()));
    FeatureTrack seen;
    views.clear();
    for (const ImageFeature& one : tracks[t]) {
      const ReconstructedImage& image = reconstruction->images[one.image];
      const Keypoint& keypoint = image.features.keypoints[one.feature];
      const Eigen::Vector2d pixel(keypoint.x_px, keypoint.y_px);
      const std::optional<Eigen::Vector3d> bearing = image.lens.Unproject(pixel);
      if (!bearing) continue;
      views.push_back({&image.lens, &image.camera_from_world, pixel, *bearing,
                       RelativeSigma_px(image.features.kind, keypoint)});
      seen.push_back(one);
    }
    const std::optional<TriangulatedPoint> solved = solve(t, views);
    if (!solved) continue;
    agreements.push_back({solved->squares, 2.0 * solved->used - 3.0});
    ReconstructedPoint point;
    point.in_world = solved->in_world;
    point.covariance = solved->unit_covariance;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (solved->is_used[i] != 0) point.seen.push_back(seen[i]);
    }
    std::sort(point.seen.begin(), point.seen.end(),
              [](const ImageFeature& a, const ImageFeature& b) { return a.image < b.image; });
    reconstruction->points.push_back(std::move(point));
  }
  const double common = CommonVariance(agreements);
  reconstruction->noise_px = std::sqrt(common);
  for (std::size_t i = 0; i < agreements.size(); ++i) {
    const Agreement& own = agreements[i];
    reconstruction->points[i].covariance *=
        (kCommonRedundancy * common + own.squares) / (kCommonRedundancy + own.redundancy);
  }
  progress(1.0);
}

}  // namespace

double RelativeSigma_px(DescriptorKind kind, const Keypoint& keypoint) {
  const double of_size = kind == DescriptorKind::kOrb ? kOrbSigmaOfSize : kSiftSigmaOfSize;
  return std::hypot(kLeastSigma_px, of_size * static_cast<double>(keypoint.size_px));
}

void TriangulateTracks(const std::vector<FeatureTrack>& tracks, const TriangulationOptions& options,
                       const Progress& progress, Reconstruction* reconstruction) {
  SolveTracks(
      tracks,
      [&](std::size_t, std::span<const PointView> views) { return Triangulate(views, options); },
      progress, reconstruction);
}

void AppraiseTracks(const std::vector<FeatureTrack>& tracks,
                    const std::vector<Eigen::Vector3d>& known, const TriangulationOptions& options,
                    const Progress& progress, Reconstruction* reconstruction) {
  SolveTracks(
      tracks,
      [&](std::size_t track, std::span<const PointView> views) {
        return AppraisePoint(known[track], views, options);
      },
      progress, reconstruction);
}

}  // namespace lodemark
