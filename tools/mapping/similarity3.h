// A scale, a rotation and a translation: where a model of unknown size lies in the world.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "core/geo/rigid3.h"

namespace lodemark {

// Named target_from_source.
struct Similarity3 {
  double scale = 1.0;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return scale * (rotation * point) + translation;
  }
};

// A camera of the source frame in the target frame: the same camera, whose axes keep the target's
// scale.
Rigid3 CameraFromTarget(const Rigid3& camera_from_source, const Similarity3& target_from_source);

// The similarity that brings the sources to their targets with the least sum of weighted squares
// (Umeyama 1991, "Least-squares estimation of transformation parameters between two point
// patterns"). No weights mean equal ones. Nothing if fewer than three points, or those of positive
// weight lie on one line, in either frame.
std::optional<Similarity3> SimilarityFromPoints(std::span<const Eigen::Vector3d> sources,
                                                std::span<const Eigen::Vector3d> targets,
                                                std::span<const double> weights);

}  // namespace lodemark
