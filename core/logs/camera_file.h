// camera.json: the lens of a recording or of a calibration.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/camera/lens.h"

namespace lodemark {

// Its members: model (PINHOLE, OPENCV, OPENCV_FISHEYE, THIN_PRISM_FISHEYE), width_px, height_px,
// fx_px, fy_px, cx_px, cy_px, coefficients; of a calibration also rms_px and intrinsics_covariance,
// rows of a square matrix whose order is fx fy cx cy and then the coefficients; convention, a
// sentence.
struct CameraFile {
  LensParameters lens;
  // Of the intrinsics, 4 + CoefficientCount(lens.model) square; zero where one was held fixed.
  std::optional<Eigen::MatrixXd> covariance;
  std::optional<double> rms_px;  // of the calibration's residuals
  std::string convention;
};

// Lists of coefficients may end early as OpenCV's do: after 0, 4, 5, 8, 12 or 14. What is read
// makes a Lens, and a covariance is symmetric and not negative. Errors name the path and the
// member.
Result<CameraFile> ParseCameraFile(const std::string& path, std::string_view text);

// The same of a file of at most a megabyte.
Result<CameraFile> ReadCameraFile(const std::string& path);

// The text of the file, which reads back to the same bits. Error if it would not read back at all.
Result<std::string> FormatCameraFile(const CameraFile& file);

}  // namespace lodemark
