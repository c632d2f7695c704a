// Any bytes as camera.json: what is read makes a lens, and is written and read back the same.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/camera/lens.h"
#include "core/logs/camera_file.h"

namespace {

// The lens answers rightly or not at all.
void CheckLens(const lodemark::LensParameters& parameters) {
  const auto lens = lodemark::Lens::Create(parameters);
  if (!lens.ok()) std::abort();
  for (double x = -0.5; x <= 1.5; x += 0.25) {
    for (double y = -0.5; y <= 1.5; y += 0.25) {
      const Eigen::Vector2d pixel(x * parameters.width_px, y * parameters.height_px);
      const auto bearing = lens->Unproject(pixel);
      if (!bearing) continue;
      const auto again = lens->Project(*bearing);
      // Rounding: of the pixel, and of its place relative to a principal point far away.
      const double most_px =
          1e-9 + 1e-12 * (pixel.norm() + std::abs(parameters.cx_px) + std::abs(parameters.cy_px));
      if (!again || !((*again - pixel).norm() <= most_px)) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto file = lodemark::ParseCameraFile("camera.json", text);
  if (!file.ok()) {
    if (file.error().message.find("camera.json: ") != 0) std::abort();
    return 0;
  }
  CheckLens(file->lens);
  const auto written = lodemark::FormatCameraFile(*file);
  if (!written.ok()) std::abort();
  const auto again = lodemark::ParseCameraFile("camera.json", *written);
  if (!again.ok() || again->lens.coefficients != file->lens.coefficients ||
      again->lens.fx_px != file->lens.fx_px || again->rms_px != file->rms_px ||
      again->covariance.has_value() != file->covariance.has_value() ||
      (file->covariance && *again->covariance != *file->covariance)) {
    std::abort();
  }
  return 0;
}
