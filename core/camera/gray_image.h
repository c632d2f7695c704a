// A grey photograph somebody else owns.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lodemark {

// Row y begins at pixels + y * stride_bytes; one byte a pixel. Pixel (0, 0) is the centre of the
// upper left pixel, x to the right, y down.
struct GrayImage {
  const std::uint8_t* pixels = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;  // at least width_px
};

}  // namespace lodemark
