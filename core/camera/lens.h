// How a lens maps directions to pixels, and back.
//
// Camera axes: x to the right, y down, z forward along the optical axis. Pixel (0, 0) is the centre
// of the upper left pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/result.h"
#include "core/camera/lens_distortion.h"

namespace lodemark {

enum class LensModel : std::uint8_t {
  kPinhole,  // no coefficients
  kBrown,    // k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y, OpenCV's order and equations
  kFisheye,  // Kannala-Brandt: k1 k2 k3 k4 of theta (1 + k1 theta^2 + ...)
  kThinPrismFisheye,  // k1 k2 p1 p2 k3 k4 sx1 sy1 on the equidistant image, COLMAP's order
};

inline constexpr int kMostLensCoefficients = 14;
inline constexpr int kMostIntrinsics = 4 + kMostLensCoefficients;

// How many coefficients the model reads; the others are 0.
int CoefficientCount(LensModel model);

// "pinhole", "brown", "fisheye", "thin prism fisheye".
std::string_view NameOf(LensModel model);

// The numbers of a lens, for an image of the given size.
struct LensParameters {
  LensModel model = LensModel::kPinhole;
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, kMostLensCoefficients> coefficients = {};
};

// Derivatives of a projected pixel.
struct ProjectionJacobian {
  Eigen::Matrix<double, 2, 3> by_point;                     // pixels per metre, camera axes
  Eigen::Matrix<double, 2, kMostIntrinsics> by_intrinsics;  // fx fy cx cy, then the coefficients
};

// A lens that was checked, with what inverting it needs worked out once: how far from the axis the
// model stays one-to-one, and a table of start values. A kilobyte, copyable, immutable.
//
// Guarantee: within the field limit no two directions share a pixel, whatever the coefficients (the
// proof is beside OneToOneRadius), and neither Project nor Unproject answers beyond it. The limit
// is a cone: exactly the fold for radial models, and the cone inside the fold where decentring or
// prism terms make that uneven.
class Lens {
 public:
  // Error if a number is not finite, a focal length not positive, the size not in 1 .. 65535, the
  // principal point further than ten image sizes away, a coefficient that the model lacks is set,
  // the sensor's tilt reaches 80 degrees, or the lens would be one-to-one nowhere.
  static Result<Lens> Create(const LensParameters& parameters);

  const LensParameters& parameters() const { return parameters_; }

  // The pixel where a point in camera axes appears, inside the image or out of it. Nothing for the
  // camera's own centre and beyond what the model images one-to-one (behind the camera of a pinhole
  // or Brown lens; past the fold of the polynomial, where a second direction has the same pixel).
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& point_in_camera) const;

  // The same, with derivatives.
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& point_in_camera,
                                         ProjectionJacobian* jacobian) const;

  // The unit direction a pixel looks to, by Newton steps until Project gives the pixel back within
  // 1e-9 px (or 1e-13 of its distance from the principal point, if that is more: it is 10,000 px
  // out). Nothing where no direction within the one-to-one part has this pixel.
  std::optional<Eigen::Vector3d> Unproject(const Eigen::Vector2d& pixel) const;

  // Unproject of many pixels: valid[i] is 1 where bearings[i] was found, else 0 (and the bearing is
  // zero). The spans have one length. Gives the number found.
  std::size_t Unproject(std::span<const Eigen::Vector2d> pixels,
                        std::span<Eigen::Vector3d> bearings, std::span<std::uint8_t> valid) const;

  // Largest angle from the optical axis that the model images one-to-one along every azimuth, in
  // radians; pi where there is no limit. A tilted sensor may have its horizon inside.
  double field_limit_rad() const { return field_limit_rad_; }

 private:
  Lens() = default;

  LensParameters parameters_;
  LensDistortion distortion_;
  double field_limit_rad_ = 0.0;
};

}  // namespace lodemark
