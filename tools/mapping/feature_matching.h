// Which features of two photographs with known poses show the same thing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/mapping/reconstruction.h"

namespace lodemark {

struct MatchingOptions {
  double epipolar_px = 3.0;    // how far a feature may lie from where the other photograph puts it
  double largest_ratio = 0.8;  // nearest to second nearest descriptor
};

struct FeatureMatch {
  std::uint32_t first = 0;   // index into the features of the first image
  std::uint32_t second = 0;  // and of the second
  double ratio = 1.0;
};

// What matching needs of each image again and again.
class MatchableImage {
 public:
  explicit MatchableImage(const ReconstructedImage& image);

  const ReconstructedImage& image() const { return *image_; }
  const Eigen::Vector3d& centre() const { return centre_; }
  // Unit directions in the world, one column for each feature; zero where the lens has none.
  const Eigen::Matrix3Xf& rays() const { return rays_; }
  double pixels_per_radian() const { return pixels_per_radian_; }

 private:
  const ReconstructedImage* image_;
  Eigen::Vector3d centre_;
  Eigen::Matrix3Xf rays_;
  double pixels_per_radian_;
};

// Nearest in both directions among the features near the epipolar curve; no feature twice. In
// ascending order of the first. None if both were taken from the same place.
std::vector<FeatureMatch> MatchFeatures(const MatchableImage& first, const MatchableImage& second,
                                        const MatchingOptions& options);

}  // namespace lodemark
