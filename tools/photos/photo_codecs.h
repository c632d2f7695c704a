// What the library that decodes and encodes photographs offers to the program that loads it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lodemark {

// Functions that do not throw. On failure they give false and leave a reason.
struct PhotoCodecs {
  // Grey pixels, rows one after another, in the orientation they are stored in. Nothing larger than
  // largest_px pixels.
  bool (*decode_grey)(const std::uint8_t* bytes, std::size_t size, std::int64_t largest_px,
                      int* width_px, int* height_px, std::vector<std::uint8_t>* pixels,
                      std::string* reason);

  // Blue, green, red of each pixel, as the kind of file that ending (".png", ".jpg") names; of a
  // JPEG the quality is 1 .. 100.
  bool (*encode_colour)(const char* ending, const std::uint8_t* pixels, int width_px, int height_px,
                        int jpeg_quality, std::vector<std::uint8_t>* bytes, std::string* reason);
};

// Name of the function without arguments that gives a const PhotoCodecs*.
inline constexpr char kPhotoCodecsSymbol[] = "lodemark_photo_codecs";

}  // namespace lodemark
