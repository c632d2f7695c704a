// Photographs and pictures in files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace lodemark {

// Grey, rows one after another, as the sensor read it: an orientation in the file's EXIF is not
// applied, because a lens belongs to the sensor and not to the way the phone was held.
struct Photo {
  std::string path;
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> pixels;
};

// Errors name the file: not there, a directory, empty, not a photograph, above 200 megapixels.
Result<Photo> ReadPhoto(const std::string& path);

// Blue, green, red of each pixel, rows one after another.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> pixels;
};

// The bytes of a PNG or JPEG file. Error for another ending of path. jpeg_quality is 1 .. 100.
Result<std::string> EncodePicture(const Picture& picture, std::string_view path,
                                  int jpeg_quality = 95);

}  // namespace lodemark
