// Directions as points of an ideal image, the plane or the equidistant one.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera/lens_distortion.h"

namespace lodemark {

// Where a point in camera axes appears in an ideal image. Nothing for the camera's own centre, for
// what is not in front of the plane, and straight back for the equidistant image.
std::optional<Eigen::Vector2d> ToIdeal(IdealImage ideal_image, const Eigen::Vector3d& point);

// The derivative of the same, for a point that appears at ideal.
Eigen::Matrix<double, 2, 3> IdealByPoint(IdealImage ideal_image, const Eigen::Vector3d& point,
                                         const Eigen::Vector2d& ideal);

// The unit direction that appears at ideal.
Eigen::Vector3d FromIdeal(IdealImage ideal_image, const Eigen::Vector2d& ideal);

}  // namespace lodemark
