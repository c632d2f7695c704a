#include "core/vision/feature_budget.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace lodemark {
namespace {

// Features a cell holds when the budget is spent evenly: few enough to spread, enough that the best
// of a cell differ.
constexpr double kFeaturesInCell = 12.0;

bool IsBefore(const Keypoint& a, const Keypoint& b) {
  return std::tie(b.response, a.y_px, a.x_px, a.angle_rad, a.size_px) <
         std::tie(a.response, b.y_px, b.x_px, b.angle_rad, b.size_px);
}

int CellAlong(float position_px, double cell_px, int cells) {
  return std::clamp(static_cast<int>(position_px / cell_px), 0, cells - 1);
}

}  // namespace

std::vector<std::uint32_t> SpreadOverImage(std::span<const Keypoint> keypoints, int width_px,
                                           int height_px, int most) {
  std::vector<std::uint32_t> order(keypoints.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return IsBefore(keypoints[a], keypoints[b]);
  });
  const std::size_t budget = static_cast<std::size_t>(std::max(most, 0));
  if (order.size() <= budget) return order;

  const double area_px2 = static_cast<double>(width_px) * height_px;
  const double cell_px =
      std::max(1.0, std::sqrt(area_px2 * kFeaturesInCell / static_cast<double>(budget + 1)));
  const int columns = std::max(1, static_cast<int>(std::ceil(width_px / cell_px)));
  const int rows = std::max(1, static_cast<int>(std::ceil(height_px / cell_px)));

  // How many of its own cell come before each feature.
  std::vector<std::uint32_t> taken(static_cast<std::size_t>(columns) *
                                   static_cast<std::size_t>(rows));
  std::vector<std::uint32_t> rank(keypoints.size());
  for (const std::uint32_t i : order) {
    const int column = CellAlong(keypoints[i].x_px, cell_px, columns);
    const int row = CellAlong(keypoints[i].y_px, cell_px, rows);
    rank[i] = taken[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)]++;
  }

  // The lowest ranks; among equal ranks the larger response.
  std::vector<std::uint32_t> kept = order;
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return rank[a] < rank[b]; });
  kept.resize(budget);
  std::vector<std::uint8_t> is_kept(keypoints.size());
  for (const std::uint32_t i : kept) is_kept[i] = 1;
  std::erase_if(order, [&](std::uint32_t i) { return is_kept[i] == 0; });
  return order;
}

}  // namespace lodemark
