// Steps on pixels and photographs of one lens.
#include "core/camera/lens.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/camera/image_undistortion.h"
#include "core/capi/check.h"
#include "core/capi/eyes.h"
#include "core/capi/guard.h"
#include "core/capi/structs.h"

// What a lodemark_undistortion points to.
struct lodemark_undistortion {
  lodemark::ImageUndistortion engine;
  lodemark::LensParameters source;
  lodemark::LensParameters target;
};

namespace lodemark {
namespace {

constexpr double kLargestPixel = 1e9;

// Points given as numbers_each doubles each; NULL is right for none.
lodemark_status CheckPoints(const double* points, const char* name, std::int32_t count,
                            std::int32_t numbers_each, double largest) {
  if (count < 0) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "count is negative");
  if (count > LODEMARK_LARGEST_POINT_COUNT) {
    return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "count is above LODEMARK_LARGEST_POINT_COUNT");
  }
  if (count > 0 && points == nullptr) {
    return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name}, "", "is NULL");
  }
  for (std::int32_t i = 0; i < count; ++i) {
    for (std::int32_t k = 0; k < numbers_each; ++k) {
      const double value = points[static_cast<std::ptrdiff_t>(i) * numbers_each + k];
      if (!(std::abs(value) <= largest)) {
        return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name, i}, "",
                      std::isfinite(value) ? "is out of range" : "is not finite");
      }
    }
  }
  return LODEMARK_OK;
}

lodemark_status CheckOutputs(const void* out, const char* name, const std::uint8_t* valid,
                             std::int32_t count) {
  if (count > 0 && out == nullptr) {
    return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name}, "", "is NULL");
  }
  if (count > 0 && valid == nullptr) {
    return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {"valid"}, "", "is NULL");
  }
  return LODEMARK_OK;
}

std::vector<Eigen::Vector2d> Pixels(const double* pixels_px, std::size_t count) {
  std::vector<Eigen::Vector2d> pixels(count);
  for (std::size_t i = 0; i < count; ++i) {
    pixels[i] = {pixels_px[2 * i], pixels_px[2 * i + 1]};
  }
  return pixels;
}

lodemark_status CheckImage(const void* pixels, std::int64_t stride_bytes, std::int32_t width_px,
                           const char* pixels_name, const char* stride_name) {
  if (pixels == nullptr) {
    return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {pixels_name}, "", "is NULL");
  }
  if (stride_bytes < width_px || stride_bytes > INT32_MAX) {
    return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {stride_name}, "",
                  "is less than the width of the image, or absurd");
  }
  return LODEMARK_OK;
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_lens_unproject(const lodemark_lens* lens, const double* pixels_px,
                                        int32_t count, double* directions, uint8_t* valid) {
  using namespace lodemark;
  return Guard([&] {
    std::optional<Lens> known;
    lodemark_status status = ReadLens(lens, "lens", &known);
    if (status == LODEMARK_OK)
      status = CheckPoints(pixels_px, "pixels_px", count, 2, kLargestPixel);
    if (status == LODEMARK_OK) status = CheckOutputs(directions, "directions", valid, count);
    if (status != LODEMARK_OK) return status;
    const auto size = static_cast<std::size_t>(count);
    std::vector<Eigen::Vector3d> bearings(size);
    known->Unproject(Pixels(pixels_px, size), bearings, {valid, size});
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        directions[3 * i + k] = bearings[i][static_cast<Eigen::Index>(k)];
      }
    }
    return LODEMARK_OK;
  });
}

lodemark_status lodemark_lens_project(const lodemark_lens* lens, const double* points,
                                      int32_t count, double* pixels_px, uint8_t* valid) {
  using namespace lodemark;
  return Guard([&] {
    std::optional<Lens> known;
    lodemark_status status = ReadLens(lens, "lens", &known);
    if (status == LODEMARK_OK) status = CheckPoints(points, "points", count, 3, kLargestLength_m);
    if (status == LODEMARK_OK) status = CheckOutputs(pixels_px, "pixels_px", valid, count);
    if (status != LODEMARK_OK) return status;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const std::optional<Eigen::Vector2d> pixel =
          known->Project({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
      valid[i] = pixel.has_value() ? 1 : 0;
      pixels_px[2 * i] = pixel ? pixel->x() : 0.0;
      pixels_px[2 * i + 1] = pixel ? pixel->y() : 0.0;
    }
    return LODEMARK_OK;
  });
}

lodemark_status lodemark_lens_undistort_points(const lodemark_lens* lens, const double* pixels_px,
                                               int32_t count, double* undistorted_px,
                                               uint8_t* valid) {
  using namespace lodemark;
  return Guard([&] {
    std::optional<Lens> known;
    lodemark_status status = ReadLens(lens, "lens", &known);
    if (status == LODEMARK_OK)
      status = CheckPoints(pixels_px, "pixels_px", count, 2, kLargestPixel);
    if (status == LODEMARK_OK)
      status = CheckOutputs(undistorted_px, "undistorted_px", valid, count);
    if (status != LODEMARK_OK) return status;
    const auto size = static_cast<std::size_t>(count);
    std::vector<Eigen::Vector3d> bearings(size);
    known->Unproject(Pixels(pixels_px, size), bearings, {valid, size});
    const LensParameters& numbers = known->parameters();
    for (std::size_t i = 0; i < size; ++i) {
      const Eigen::Vector3d& bearing = bearings[i];
      if (!(bearing.z() > 0.0)) valid[i] = 0;
      const bool found = valid[i] != 0;
      undistorted_px[2 * i] =
          found ? numbers.fx_px * bearing.x() / bearing.z() + numbers.cx_px : 0.0;
      undistorted_px[2 * i + 1] =
          found ? numbers.fy_px * bearing.y() / bearing.z() + numbers.cy_px : 0.0;
    }
    return LODEMARK_OK;
  });
}

lodemark_status lodemark_undistortion_open(const lodemark_lens* lens, const lodemark_lens* target,
                                           lodemark_lens* used_target,
                                           lodemark_undistortion** undistortion) {
  using namespace lodemark;
  return Guard([&] {
    if (undistortion == nullptr) {
      return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "undistortion is NULL");
    }
    *undistortion = nullptr;
    std::optional<Lens> source;
    std::optional<Lens> straight;
    lodemark_status status = ReadLens(lens, "lens", &source);
    if (status == LODEMARK_OK && target != nullptr) status = ReadLens(target, "target", &straight);
    if (status == LODEMARK_OK && used_target != nullptr) {
      status = CheckStruct<lodemark_lens>(used_target, {"used_target"});
    }
    if (status != LODEMARK_OK) return status;
    if (!straight) {
      Result<Lens> inscribed = ImageUndistortion::InscribedPinhole(*source);
      if (!inscribed) return Fail(inscribed.error());
      straight = *inscribed;
    }
    Result<ImageUndistortion> engine = ImageUndistortion::Create(*source, *straight);
    if (!engine) return Fail(engine.error());
    if (used_target != nullptr) WriteStruct(ToC(straight->parameters()), used_target);
    *undistortion =
        new lodemark_undistortion{std::move(*engine), source->parameters(), straight->parameters()};
    return LODEMARK_OK;
  });
}

void lodemark_undistortion_close(lodemark_undistortion* undistortion) { delete undistortion; }

lodemark_status lodemark_undistortion_apply(const lodemark_undistortion* undistortion,
                                            const uint8_t* pixels, int64_t stride_bytes,
                                            uint8_t* out, int64_t out_stride_bytes) {
  using namespace lodemark;
  return Guard([&] {
    if (undistortion == nullptr) {
      return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "undistortion is NULL");
    }
    const LensParameters& source = undistortion->source;
    const LensParameters& target = undistortion->target;
    lodemark_status status =
        CheckImage(pixels, stride_bytes, source.width_px, "pixels", "stride_bytes");
    if (status == LODEMARK_OK) {
      status = CheckImage(out, out_stride_bytes, target.width_px, "out", "out_stride_bytes");
    }
    if (status != LODEMARK_OK) return status;
    const GrayImage image = {pixels, source.width_px, source.height_px,
                             static_cast<std::ptrdiff_t>(stride_bytes)};
    const std::size_t out_bytes = static_cast<std::size_t>(out_stride_bytes) *
                                      static_cast<std::size_t>(target.height_px - 1) +
                                  static_cast<std::size_t>(target.width_px);
    return StatusOf(undistortion->engine.Apply(image, {out, out_bytes},
                                               static_cast<std::ptrdiff_t>(out_stride_bytes)));
  });
}
