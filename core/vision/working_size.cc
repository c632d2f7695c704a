#include "core/vision/working_size.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// A panorama has rows so long that all of it may be held: 130 bytes a pixel.
constexpr double kMostSiftPixels = 12.5e6;

}  // namespace

WorkingSize WorkingSizeOf(int width_px, int height_px, const DetectorOptions& options) {
  double scale = 1.0;
  if (options.longest_side_px > 0) {
    scale = static_cast<double>(options.longest_side_px) / std::max(width_px, height_px);
  }
  if (options.kind == DescriptorKind::kRootSift) {
    const double pixels = static_cast<double>(width_px) * height_px;
    scale = std::min(scale, std::sqrt(kMostSiftPixels / pixels));
  }
  if (!(scale < 1.0)) return {width_px, height_px};
  return {std::max(1, static_cast<int>(std::lround(width_px * scale))),
          std::max(1, static_cast<int>(std::lround(height_px * scale)))};
}

}  // namespace lodemark
