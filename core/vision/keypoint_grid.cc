#include "core/vision/keypoint_grid.h"

namespace lodemark {
namespace {

constexpr double kMostAlongASide = 256.0;

bool IsFinite(const Keypoint& keypoint) {
  return std::isfinite(keypoint.x_px) && std::isfinite(keypoint.y_px);
}

}  // namespace

KeypointGrid::KeypointGrid(std::span<const Keypoint> keypoints, double radius_px)
    : keypoints_(keypoints), radius_px_(radius_px) {
  bool is_first = true;
  Eigen::Vector2d most_px = Eigen::Vector2d::Zero();
  for (const Keypoint& keypoint : keypoints) {
    if (!IsFinite(keypoint)) continue;
    const Eigen::Vector2d at(keypoint.x_px, keypoint.y_px);
    origin_px_ = is_first ? at : Eigen::Vector2d(origin_px_.cwiseMin(at));
    most_px = is_first ? at : Eigen::Vector2d(most_px.cwiseMax(at));
    is_first = false;
  }
  const Eigen::Vector2d extent_px = most_px - origin_px_;
  cell_px_ = std::max({radius_px, extent_px.maxCoeff() / kMostAlongASide, 1.0});
  columns_ = static_cast<int>(std::min(extent_px.x() / cell_px_ + 1.0, kMostAlongASide));
  rows_ = static_cast<int>(std::min(extent_px.y() / cell_px_ + 1.0, kMostAlongASide));

  begins_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1);
  for (const Keypoint& keypoint : keypoints) {
    if (IsFinite(keypoint)) ++begins_[CellOf(keypoint) + 1];
  }
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
  indices_.resize(begins_.back());
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    if (IsFinite(keypoints[i]))
      indices_[next[CellOf(keypoints[i])]++] = static_cast<std::uint32_t>(i);
  }
}

std::size_t KeypointGrid::CellOf(const Keypoint& keypoint) const {
  const int column = Cell(keypoint.x_px - origin_px_.x(), columns_);
  const int row = Cell(keypoint.y_px - origin_px_.y(), rows_);
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column);
}

}  // namespace lodemark
