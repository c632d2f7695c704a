#include "core/camera/colmap_camera.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodemark {
namespace {

// Focal lengths come first (one for both axes, or two), then cx cy, then coefficients in our order.
struct KnownModel {
  std::string_view name;
  LensModel model;
  int focal_lengths;
  int coefficients;
};
constexpr std::array<KnownModel, 10> kKnownModels = {{
    {"SIMPLE_PINHOLE", LensModel::kPinhole, 1, 0},
    {"PINHOLE", LensModel::kPinhole, 2, 0},
    {"SIMPLE_RADIAL", LensModel::kBrown, 1, 1},
    {"RADIAL", LensModel::kBrown, 1, 2},
    {"OPENCV", LensModel::kBrown, 2, 4},
    {"FULL_OPENCV", LensModel::kBrown, 2, 8},
    {"SIMPLE_RADIAL_FISHEYE", LensModel::kFisheye, 1, 1},
    {"RADIAL_FISHEYE", LensModel::kFisheye, 1, 2},
    {"OPENCV_FISHEYE", LensModel::kFisheye, 2, 4},
    {"THIN_PRISM_FISHEYE", LensModel::kThinPrismFisheye, 2, 8},
}};

constexpr std::size_t kLongestName = 64;
constexpr std::uint64_t kMostSize_px = 65535;

}  // namespace

Result<LensParameters> LensFromColmap(std::string_view model, std::uint64_t width_px,
                                      std::uint64_t height_px, std::span<const double> parameters) {
  const std::string name(model.substr(0, kLongestName));
  const auto* const known = std::find_if(kKnownModels.begin(), kKnownModels.end(),
                                         [&](const KnownModel& k) { return k.name == model; });
  if (known == kKnownModels.end()) {
    return Error{ErrorCode::kUnsupported,
                 "camera model " + name +
                     " has no lens here; estimate the camera as OPENCV or OPENCV_FISHEYE instead"};
  }
  const auto focal_lengths = static_cast<std::size_t>(known->focal_lengths);
  const std::size_t first = focal_lengths + 2;
  const std::size_t count = first + static_cast<std::size_t>(known->coefficients);
  if (parameters.size() != count) {
    return Error{ErrorCode::kBadData, "camera model " + name + " has " + std::to_string(count) +
                                          " parameters, not " + std::to_string(parameters.size())};
  }
  if (width_px > kMostSize_px || height_px > kMostSize_px) {
    return Error{ErrorCode::kBadData, "camera image is larger than 65535 pixels"};
  }
  LensParameters lens;
  lens.model = known->model;
  lens.width_px = static_cast<int>(width_px);
  lens.height_px = static_cast<int>(height_px);
  lens.fx_px = parameters[0];
  lens.fy_px = parameters[focal_lengths - 1];
  lens.cx_px = parameters[focal_lengths] - kColmapPixelShift_px;
  lens.cy_px = parameters[focal_lengths + 1] - kColmapPixelShift_px;
  for (std::size_t i = first; i < count; ++i) lens.coefficients[i - first] = parameters[i];
  const Result<Lens> checked = Lens::Create(lens);
  if (!checked.ok()) {
    return Error{ErrorCode::kBadData, "camera model " + name + ": " + checked.error().message};
  }
  return lens;
}

Result<ColmapLens> ColmapFromLens(const LensParameters& lens) {
  const Result<Lens> checked = Lens::Create(lens);
  if (!checked.ok()) return checked.error();
  std::size_t used = kMostLensCoefficients;
  while (used > 0 && lens.coefficients[used - 1] == 0.0) --used;
  for (const KnownModel& known : kKnownModels) {
    // Those with one focal length are for reading only.
    if (known.model != lens.model || known.focal_lengths != 2) continue;
    const auto count = static_cast<std::size_t>(known.coefficients);
    if (used > count) continue;
    ColmapLens colmap;
    colmap.model = known.name;
    colmap.parameters = {lens.fx_px, lens.fy_px, lens.cx_px + kColmapPixelShift_px,
                         lens.cy_px + kColmapPixelShift_px};
    colmap.parameters.insert(colmap.parameters.end(), lens.coefficients.begin(),
                             lens.coefficients.begin() + static_cast<std::ptrdiff_t>(count));
    return colmap;
  }
  return Error{ErrorCode::kUnsupported,
               "COLMAP has no model with the prism and tilt terms of this lens"};
}

}  // namespace lodemark
