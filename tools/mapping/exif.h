// What a camera noted in a JPEG file about where and how it was held: EXIF 2.32.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"

namespace lodemark {

struct ExifPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  // Above mean sea level by the standard; many phones write the height above the ellipsoid.
  std::optional<double> altitude_m;
  std::optional<double> horizontal_error_m;  // GPSHPositioningError, 68 % radius on phones
};

struct Exif {
  int orientation = 1;  // 1 .. 8 as in the standard; 1: as stored
  std::optional<ExifPosition> position;
  std::optional<double> direction_deg;  // where the camera looked, clockwise from north
  bool direction_is_magnetic = false;
};

// Of the bytes of a JPEG file or its beginning. What is absent, malformed or implausible is left
// out; bytes that are no JPEG have nothing.
Exif ParseExif(std::span<const std::uint8_t> jpeg);

// An error only if the file cannot be read.
Result<Exif> ReadExif(const std::string& path);

}  // namespace lodemark
