// Where each pixel of a lens looks to.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/base/result.h"
#include "core/camera/lens.h"

namespace lodemark {

// A pixel's direction in camera axes, and how it changes towards the next pixel.
struct PixelRay {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // zero where the lens sees nothing
  Eigen::Vector3d by_x = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_y = Eigen::Vector3d::Zero();
};

// Lens::Unproject of every pixel, worked out once. Within a pixel a direction is linear to well
// below 0.001 px.
class ViewRays {
 public:
  // Error above 50 megapixels, whose table would not fit.
  static Result<ViewRays> Of(const Lens& lens);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  PixelRay At(int x_px, int y_px) const;

  // How far apart the directions of neighbouring pixels are in the middle of the image.
  double pixel_angle_rad() const { return pixel_angle_rad_; }

 private:
  ViewRays() = default;
  // With a margin of one pixel all round.
  const Eigen::Vector3d& Stored(int x_px, int y_px) const {
    return directions_[static_cast<std::size_t>(y_px + 1) *
                           static_cast<std::size_t>(width_px_ + 2) +
                       static_cast<std::size_t>(x_px + 1)];
  }

  int width_px_ = 0;
  int height_px_ = 0;
  double pixel_angle_rad_ = 0.0;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace lodemark
