// Finds the keypoints near a place in the image.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vision/features.h"

namespace lodemark {

// Keypoints sorted into square cells as wide as the radius, at most 65,536 of them. Keypoints that
// are not finite are never found.
class KeypointGrid {
 public:
  // The keypoints must outlive the grid.
  KeypointGrid(std::span<const Keypoint> keypoints, double radius_px);

  // Calls visit(index) for each keypoint within the radius, in a fixed order.
  template <typename Visit>
  void ForEachNear(const Eigen::Vector2d& pixel, Visit&& visit) const {
    if (!pixel.allFinite()) return;
    const int left = Cell(pixel.x() - radius_px_ - origin_px_.x(), columns_);
    const int right = Cell(pixel.x() + radius_px_ - origin_px_.x(), columns_);
    const int top = Cell(pixel.y() - radius_px_ - origin_px_.y(), rows_);
    const int bottom = Cell(pixel.y() + radius_px_ - origin_px_.y(), rows_);
    for (int row = top; row <= bottom; ++row) {
      const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
      const std::uint32_t begin = begins_[first + static_cast<std::size_t>(left)];
      const std::uint32_t end = begins_[first + static_cast<std::size_t>(right) + 1];
      for (std::uint32_t i = begin; i < end; ++i) {
        const Keypoint& keypoint = keypoints_[indices_[i]];
        const Eigen::Vector2d off_px = Eigen::Vector2d(keypoint.x_px, keypoint.y_px) - pixel;
        if (off_px.squaredNorm() <= radius_px_ * radius_px_) visit(indices_[i]);
      }
    }
  }

 private:
  int Cell(double offset_px, int cells) const {
    return static_cast<int>(std::clamp(std::floor(offset_px / cell_px_), 0.0, cells - 1.0));
  }
  std::size_t CellOf(const Keypoint& keypoint) const;

  std::span<const Keypoint> keypoints_;
  double radius_px_ = 0.0;
  double cell_px_ = 1.0;
  Eigen::Vector2d origin_px_ = Eigen::Vector2d::Zero();
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::uint32_t> begins_;   // where each cell's indices begin, row by row, and the end
  std::vector<std::uint32_t> indices_;  // of keypoints, cell by cell
};

}  // namespace lodemark
