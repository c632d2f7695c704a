// OpenCV's camera files, yml and xml, as its calibration programs write them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/camera/lens.h"

namespace lodemark {

// What a file may leave open.
struct OpenCvCameraChoice {
  int camera = 1;    // of a stereo file, whose matrices are M1 D1 and M2 D2
  int width_px = 0;  // of the image where the file does not say; 0 if it must
  int height_px = 0;
};

// Reads camera_matrix and distortion_coefficients in their usual spellings, image_width and
// image_height, and fisheye_model, for which 1 means OpenCV's fisheye. Without distortion, or where
// all of it is 0, the lens is a pinhole. Error if something is missing or makes no Lens; it names
// the path and the field.
Result<LensParameters> ParseOpenCvCameraFile(const std::string& path, std::string_view text,
                                             const OpenCvCameraChoice& choice = {});

// The same of a file of at most 16 megabytes.
Result<LensParameters> ReadOpenCvCameraFile(const std::string& path,
                                            const OpenCvCameraChoice& choice = {});

enum class OpenCvFileForm : std::uint8_t { kYaml, kXml };

// The text of a file that reads back to the same bits. Error for the thin-prism fisheye, which
// OpenCV has not, and for what makes no Lens.
Result<std::string> FormatOpenCvCameraFile(const LensParameters& lens, OpenCvFileForm form);

}  // namespace lodemark
