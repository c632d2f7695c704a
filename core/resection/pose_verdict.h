// Whether a pose is one to believe: against chance, against another pose, against bad geometry.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera/lens.h"
#include "core/resection/collinearity.h"
#include "core/resection/sights.h"

namespace lodemark {

// Decimal logarithm of the expected number of poses of random sights that agree so well: the number
// of samples there are, times the probability that as many further sights agree by chance with one
// (Moisan and Stival's a-contrario criterion). The probability of one is the larger of the gate's
// share of the image and how often the pixel of one sight lies within the gate of another sight's
// landmark. Inliers that lie within one gate of each other count once.
//
// gate_px: radius within which a sight of each own sigma agrees.
double Log10Chance(const CameraPose& pose, std::span<const LandmarkSight> sights,
                   std::span<const std::uint8_t> is_inlier, const Lens& lens, double gate_px,
                   int sights_per_sample);

// Decimal logarithm of the probability that at least successes of trials succeed.
double Log10BinomialTail(std::size_t successes, std::size_t trials, double probability);

// How landmarks lie: standard deviations along their principal axes, the longest first, and those
// axes as columns.
struct LandmarkSpread {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};
LandmarkSpread SpreadOf(std::span<const LandmarkSight> sights,
                        std::span<const std::uint8_t> is_used);

// Where a flat, distant target leaves a second answer: the pose turned so that the landmarks' plane
// leans the other way about the line of sight (Necker's reversal). A start for refinement.
CameraPose ReversedPose(const CameraPose& pose, const LandmarkSpread& spread);

}  // namespace lodemark
