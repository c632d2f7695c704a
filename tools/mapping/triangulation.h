// A point from the pixels of several photographs whose poses are known.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera/lens.h"
#include "core/geo/rigid3.h"

namespace lodemark {

// One photograph's view of the point. Lens and pose must outlive it.
struct PointView {
  const Lens* lens = nullptr;
  const Rigid3* camera_from_world = nullptr;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3d bearing = Eigen::Vector3d::Zero();  // what the lens makes of the pixel
  double sigma_px = 1.0;                              // relative to the other views
};

struct TriangulationOptions {
  // Times a view's own sigma: beyond it, a view is mistaken. Those of features are about 0.3 px,
  // and poses and lenses may be out by a pixel.
  double largest_residual_px = 8.0;
  int least_views = 2;                // that agree
  double least_parallax_rad = 0.026;  // 1.5 degrees, between some two of their rays
};

struct TriangulatedPoint {
  Eigen::Vector3d in_world = Eigen::Vector3d::Zero();
  // For views that are out by their sigma: times the square of the noise in pixels.
  Eigen::Matrix3d unit_covariance = Eigen::Matrix3d::Zero();
  std::vector<std::uint8_t> is_used;  // one for each view
  int used = 0;
  double squares = 0.0;  // sum over the views used, in their sigmas
  double parallax_rad = 0.0;
};

// Two views at a time propose, the others vote; the winner is refined on the pixels of all that
// agree. Nothing if too few agree, all look from nearly the same side, or the point would lie
// behind a camera.
std::optional<TriangulatedPoint> Triangulate(std::span<const PointView> views,
                                             const TriangulationOptions& options);

// The same views about a place that is known already, such as a bundle adjustment's: which agree
// with it and what they tell of its covariance. The place stays.
std::optional<TriangulatedPoint> AppraisePoint(const Eigen::Vector3d& in_world,
                                               std::span<const PointView> views,
                                               const TriangulationOptions& options);

}  // namespace lodemark
