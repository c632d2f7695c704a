#include "tools/renderer/view_rays.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

namespace lodemark {
namespace {

constexpr std::int64_t kLargest_px = 50'000'000;

// Of three directions in a row, of which the outer ones may be missing.
Eigen::Vector3d Slope(const Eigen::Vector3d& before, const Eigen::Vector3d& at,
                      const Eigen::Vector3d& after) {
  const bool has_before = before.squaredNorm() > 0.0;
  const bool has_after = after.squaredNorm() > 0.0;
  if (has_before && has_after) return 0.5 * (after - before);
  if (has_after) return after - at;
  if (has_before) return at - before;
  return Eigen::Vector3d::Zero();
}

}  // namespace

Result<ViewRays> ViewRays::Of(const Lens& lens) {
  const LensParameters& parameters = lens.parameters();
  if (static_cast<std::int64_t>(parameters.width_px) * parameters.height_px > kLargest_px) {
    return Error{ErrorCode::kUnsupported,
                 "a photograph of " + std::to_string(parameters.width_px) + " x " +
                     std::to_string(parameters.height_px) +
                     " pixels is too large to make; at most 50 megapixels"};
  }
  ViewRays rays;
  rays.width_px_ = parameters.width_px;
  rays.height_px_ = parameters.height_px;
  const auto columns = static_cast<std::size_t>(parameters.width_px) + 2;
  const auto rows = static_cast<std::size_t>(parameters.height_px) + 2;
  rays.directions_.resize(columns * rows, Eigen::Vector3d::Zero());
  std::vector<Eigen::Vector2d> pixels(columns);
  std::vector<std::uint8_t> valid(columns);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      pixels[column] = {static_cast<double>(column) - 1.0, static_cast<double>(row) - 1.0};
    }
    lens.Unproject(pixels, std::span(rays.directions_).subspan(row * columns, columns), valid);
  }
  rays.pixel_angle_rad_ = 1.0 / std::sqrt(parameters.fx_px * parameters.fy_px);
  return rays;
}

PixelRay ViewRays::At(int x_px, int y_px) const {
  PixelRay ray;
  ray.direction = Stored(x_px, y_px);
  if (!(ray.direction.squaredNorm() > 0.0)) return ray;
  ray.by_x = Slope(Stored(x_px - 1, y_px), ray.direction, Stored(x_px + 1, y_px));
  ray.by_y = Slope(Stored(x_px, y_px - 1), ray.direction, Stored(x_px, y_px + 1));
  return ray;
}

}  // namespace lodemark
