// Any bytes as a JPEG file: what is read from its EXIF is something a camera could have noted.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tools/mapping/exif.h"

namespace {

void Require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const lodemark::Exif exif = lodemark::ParseExif({data, size});
  Require(exif.orientation >= 1 && exif.orientation <= 8);
  if (exif.direction_deg) Require(*exif.direction_deg >= 0.0 && *exif.direction_deg <= 360.0);
  if (!exif.position) return 0;
  Require(std::abs(exif.position->latitude_deg) <= 90.0);
  Require(std::abs(exif.position->longitude_deg) <= 180.0);
  if (exif.position->altitude_m) Require(std::abs(*exif.position->altitude_m) <= 20'000.0);
  if (exif.position->horizontal_error_m) Require(*exif.position->horizontal_error_m > 0.0);
  return 0;
}
