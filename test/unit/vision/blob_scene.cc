#include "test/unit/vision/blob_scene.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace lodemark::test {

std::vector<Blob> RandomBlobs(std::uint64_t seed, int count, double width, double height) {
  Random random(seed);
  std::vector<Blob> blobs;
  blobs.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Blob blob;
    blob.centre = {random.Uniform(0.0, width), random.Uniform(0.0, height)};
    blob.sigma = 1.5 * std::exp(random.Exponential(0.6));
    blob.contrast = random.Uniform(20.0, 70.0) * (random.Uniform() < 0.5 ? -1.0 : 1.0);
    blobs.push_back(blob);
  }
  return blobs;
}

Picture Paint(const std::vector<Blob>& blobs, const SceneToImage& image_from_scene, int width_px,
              int height_px) {
  const std::size_t width = static_cast<std::size_t>(width_px);
  std::vector<double> grey(width * static_cast<std::size_t>(height_px), 110.0);
  for (const Blob& blob : blobs) {
    const Eigen::Vector2d centre_px = image_from_scene * blob.centre;
    const double sigma_px = image_from_scene.scale * blob.sigma;
    const double reach_px = 5.0 * sigma_px;
    const int left = static_cast<int>(std::max(0.0, std::floor(centre_px.x() - reach_px)));
    const int top = static_cast<int>(std::max(0.0, std::floor(centre_px.y() - reach_px)));
    const int right =
        static_cast<int>(std::min(width_px - 1.0, std::ceil(centre_px.x() + reach_px)));
    const int bottom =
        static_cast<int>(std::min(height_px - 1.0, std::ceil(centre_px.y() + reach_px)));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const double distance2_px2 = (Eigen::Vector2d(x, y) - centre_px).squaredNorm();
        grey[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] +=
            blob.contrast * std::exp(-0.5 * distance2_px2 / (sigma_px * sigma_px));
      }
    }
  }
  Picture picture{width_px, height_px, width_px, {}};
  picture.pixels.reserve(grey.size());
  for (const double value : grey) {
    picture.pixels.push_back(static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0)));
  }
  return picture;
}

}  // namespace lodemark::test
