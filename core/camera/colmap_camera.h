// COLMAP's camera models as lenses, and back (COLMAP, sensor/models.h).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/camera/lens.h"

namespace lodemark {

// COLMAP's image axes have the centre of the upper left pixel at (0.5, 0.5).
inline constexpr double kColmapPixelShift_px = 0.5;

struct ColmapLens {
  std::string model;               // "PINHOLE", "OPENCV" ...
  std::vector<double> parameters;  // as many as the model has, in COLMAP's order and image axes
};

// SIMPLE_PINHOLE PINHOLE SIMPLE_RADIAL RADIAL OPENCV OPENCV_FISHEYE FULL_OPENCV
// SIMPLE_RADIAL_FISHEYE RADIAL_FISHEYE THIN_PRISM_FISHEYE. Other models are an error, and so are
// numbers that make no Lens.
Result<LensParameters> LensFromColmap(std::string_view model, std::uint64_t width_px,
                                      std::uint64_t height_px, std::span<const double> parameters);

// The smallest model that says the same. Error for a tilted sensor and Brown's prism terms, which
// COLMAP does not know.
Result<ColmapLens> ColmapFromLens(const LensParameters& lens);

}  // namespace lodemark
