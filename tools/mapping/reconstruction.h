// Photographs with poses, and points seen in several of them: what a map is made from.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/camera/lens.h"
#include "core/geo/rigid3.h"
#include "core/vision/features.h"

namespace lodemark {

// Told the share of the work that is done, 0 .. 1.
using Progress = std::function<void(double share)>;

struct ReconstructedImage {
  std::string name;
  Lens lens;
  Rigid3 camera_from_world;
  Features features;
};

struct ImageFeature {
  std::uint32_t image = 0;    // index into the images
  std::uint32_t feature = 0;  // index into that image's features

  friend bool operator==(const ImageFeature&, const ImageFeature&) = default;
};

// Features that are taken for one thing.
using FeatureTrack = std::vector<ImageFeature>;

struct ReconstructedPoint {
  Eigen::Vector3d in_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // the world's unit, squared
  std::vector<ImageFeature> seen;                        // in ascending order of image
};

struct Reconstruction {
  DescriptorKind kind = DescriptorKind::kRootSift;
  std::vector<ReconstructedImage> images;
  std::vector<ReconstructedPoint> points;
  double noise_px = 0.0;  // of a feature with relative sigma 1, estimated
};

// How well a feature is placed, relative to others: the larger what was looked at, the worse.
double RelativeSigma_px(DescriptorKind kind, const Keypoint& keypoint);

// Turns tracks into points, and estimates the noise and with it the points' covariances. Tracks
// without a point fall away.
struct TriangulationOptions;
void TriangulateTracks(const std::vector<FeatureTrack>& tracks, const TriangulationOptions& options,
                       const Progress& progress, Reconstruction* reconstruction);

// The same for points that have a place already and keep it. known[i] belongs to tracks[i].
void AppraiseTracks(const std::vector<FeatureTrack>& tracks,
                    const std::vector<Eigen::Vector3d>& known, const TriangulationOptions& options,
                    const Progress& progress, Reconstruction* reconstruction);

}  // namespace lodemark
