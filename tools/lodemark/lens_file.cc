#include "tools/lodemark/lens_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "core/camera/opencv_camera_file.h"
#include "core/logs/camera_file.h"
#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

// How much the sides of a scaled copy may miss the exact ratio: the rounding of one pixel.
constexpr double kRounding_px = 1.0;

lodemark_lens ToC(const LensParameters& from) {
  lodemark_lens to = {};
  to.struct_size = sizeof to;
  to.model = static_cast<std::int32_t>(from.model);
  to.width_px = from.width_px;
  to.height_px = from.height_px;
  to.fx_px = from.fx_px;
  to.fy_px = from.fy_px;
  to.cx_px = from.cx_px;
  to.cy_px = from.cy_px;
  std::memcpy(to.coefficients, from.coefficients.data(), sizeof to.coefficients);
  return to;
}

}  // namespace

Result<LensFile> ReadLensFile(const std::string& path) {
  LensFile file;
  file.path = path;
  file.resect.struct_size = sizeof file.resect;
  if (path.ends_with(".yml") || path.ends_with(".yaml") || path.ends_with(".xml")) {
    const Result<LensParameters> lens = ReadOpenCvCameraFile(path);
    if (!lens) return lens.error();
    file.lens = ToC(*lens);
    return file;
  }
  const Result<CameraFile> camera = ReadCameraFile(path);
  if (!camera) return camera.error();
  file.lens = ToC(camera->lens);
  if (camera->covariance) {
    file.resect.present |= LODEMARK_RESECT_HAS_INTRINSICS_COVARIANCE;
    for (Eigen::Index i = 0; i < camera->covariance->rows(); ++i) {
      for (Eigen::Index k = 0; k < camera->covariance->cols(); ++k) {
        file.resect.intrinsics_covariance[i * LODEMARK_LENS_INTRINSICS + k] =
            (*camera->covariance)(i, k);
      }
    }
  }
  return file;
}

Result<LensFile> LensFor(const Photo& photo, const LensFile& file) {
  const lodemark_lens& lens = file.lens;
  if (photo.width_px == lens.width_px && photo.height_px == lens.height_px) return file;
  const double scale_x = static_cast<double>(photo.width_px) / lens.width_px;
  if (std::abs(scale_x * lens.height_px - photo.height_px) > kRounding_px) {
    const bool turned = photo.width_px == lens.height_px && photo.height_px == lens.width_px;
    return Error{ErrorCode::kBadData,
                 photo.path +
                     Format(": is %d x %d pixels, the lens of ", photo.width_px, photo.height_px) +
                     file.path + Format(" takes %d x %d; ", lens.width_px, lens.height_px) +
                     (turned ? "turn the photograph back by 90 degrees"
                             : "name the file of the camera that took it")};
  }
  const double scale_y = static_cast<double>(photo.height_px) / lens.height_px;
  LensFile scaled = file;
  scaled.lens.width_px = photo.width_px;
  scaled.lens.height_px = photo.height_px;
  // Centres of pixels: x' + 0.5 = scale (x + 0.5).
  scaled.lens.fx_px = scale_x * lens.fx_px;
  scaled.lens.fy_px = scale_y * lens.fy_px;
  scaled.lens.cx_px = scale_x * (lens.cx_px + 0.5) - 0.5;
  scaled.lens.cy_px = scale_y * (lens.cy_px + 0.5) - 0.5;
  const double scales[4] = {scale_x, scale_y, scale_x, scale_y};  // fx fy cx cy
  for (int i = 0; i < LODEMARK_LENS_INTRINSICS; ++i) {
    for (int k = 0; k < LODEMARK_LENS_INTRINSICS; ++k) {
      scaled.resect.intrinsics_covariance[i * LODEMARK_LENS_INTRINSICS + k] *=
          (i < 4 ? scales[i] : 1.0) * (k < 4 ? scales[k] : 1.0);
    }
  }
  return scaled;
}

}  // namespace lodemark
