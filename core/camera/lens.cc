#include "core/camera/lens.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/units.h"
#include "core/camera/ideal_image.h"

namespace lodemark {
namespace {

using Term = DistortionTerm;

constexpr int kMostSize_px = 65535;
constexpr double kMostImageSizesToPrincipalPoint = 10.0;
constexpr double kMostTilt_rad = 80.0 * kRadiansPerDegree;
constexpr double kLeastField_rad = 1e-6;
constexpr double kTolerance_px = 5e-10;  // half of what Unproject promises

// Which term of the distortion each coefficient of a model is.
constexpr std::array kBrownTerms = {Term::kNumerator1,   Term::kNumerator2,   Term::kDecentring1,
                                    Term::kDecentring2,  Term::kNumerator3,   Term::kDenominator1,
                                    Term::kDenominator2, Term::kDenominator3, Term::kPrism1,
                                    Term::kPrism2,       Term::kPrism3,       Term::kPrism4,
                                    Term::kTauX,         Term::kTauY};
constexpr std::array kFisheyeTerms = {Term::kNumerator1, Term::kNumerator2, Term::kNumerator3,
                                      Term::kNumerator4};
constexpr std::array kThinPrismTerms = {Term::kNumerator1,  Term::kNumerator2, Term::kDecentring1,
                                        Term::kDecentring2, Term::kNumerator3, Term::kNumerator4,
                                        Term::kPrism1,      Term::kPrism3};

std::span<const Term> TermsOf(LensModel model) {
  switch (model) {
    case LensModel::kPinhole:
      break;
    case LensModel::kBrown:
      return kBrownTerms;
    case LensModel::kFisheye:
      return kFisheyeTerms;
    case LensModel::kThinPrismFisheye:
      return kThinPrismTerms;
  }
  return {};
}

IdealImage IdealImageOf(LensModel model) {
  return model == LensModel::kFisheye || model == LensModel::kThinPrismFisheye
             ? IdealImage::kEquidistant
             : IdealImage::kPlane;
}

Error Invalid(const std::string& what) { return {ErrorCode::kInvalidArgument, "lens: " + what}; }

Status Check(const LensParameters& p) {
  if (p.model > LensModel::kThinPrismFisheye) return Invalid("its model is unknown");
  if (p.width_px < 1 || p.width_px > kMostSize_px || p.height_px < 1 ||
      p.height_px > kMostSize_px) {
    return Invalid("its image is " + std::to_string(p.width_px) + " by " +
                   std::to_string(p.height_px) + " pixels; 1 to 65535 are served");
  }
  // A focal length of 1e-6 to 1e9 pixels keeps every product below in range.
  const auto plausible = [](double f_px) { return f_px >= 1e-6 && f_px <= 1e9; };
  if (!plausible(p.fx_px) || !plausible(p.fy_px)) {
    return Invalid("its focal lengths are not within 1e-6 to 1e9 pixels");
  }
  const double reach_px = kMostImageSizesToPrincipalPoint * std::max(p.width_px, p.height_px);
  if (!(std::abs(p.cx_px) <= reach_px && std::abs(p.cy_px) <= reach_px)) {
    return Invalid("its principal point lies more than ten image sizes away");
  }
  const int count = CoefficientCount(p.model);
  for (int i = 0; i < kMostLensCoefficients; ++i) {
    const double value = p.coefficients[static_cast<std::size_t>(i)];
    if (!std::isfinite(value)) {
      return Invalid("its coefficient " + std::to_string(i + 1) + " is not finite");
    }
    if (i >= count && value != 0.0) {
      return Invalid("its coefficient " + std::to_string(i + 1) + " is set, but a " +
                     std::string(NameOf(p.model)) + " lens has " + std::to_string(count));
    }
  }
  return {};
}

// A pixel in focal lengths from the principal point.
Eigen::Vector2d ImageOf(const LensParameters& p, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - p.cx_px) / p.fx_px, (pixel.y() - p.cy_px) / p.fy_px};
}

// Distance of the furthest image corner from the principal point, in focal lengths.
double FieldRadius(const LensParameters& p) {
  const double x = std::max(std::abs(p.cx_px), std::abs(p.width_px - 1 - p.cx_px)) / p.fx_px;
  const double y = std::max(std::abs(p.cy_px), std::abs(p.height_px - 1 - p.cy_px)) / p.fy_px;
  return std::max(std::sqrt(x * x + y * y), 1e-6);
}

}  // namespace

int CoefficientCount(LensModel model) { return static_cast<int>(TermsOf(model).size()); }

std::string_view NameOf(LensModel model) {
  switch (model) {
    case LensModel::kPinhole:
      return "pinhole";
    case LensModel::kBrown:
      return "brown";
    case LensModel::kFisheye:
      return "fisheye";
    case LensModel::kThinPrismFisheye:
      return "thin prism fisheye";
  }
  return "unknown";
}

Result<Lens> Lens::Create(const LensParameters& parameters) {
  if (Status status = Check(parameters); !status.ok()) return status.error();
  DistortionTerms terms;
  const std::span<const Term> used = TermsOf(parameters.model);
  for (std::size_t i = 0; i < used.size(); ++i) {
    *ValueOf(used[i], &terms) = parameters.coefficients[i];
  }
  if (!(std::abs(terms.tau_x_rad) < kMostTilt_rad && std::abs(terms.tau_y_rad) < kMostTilt_rad)) {
    return Invalid("its sensor is tilted by 80 degrees or more");
  }

  const IdealImage ideal_image = IdealImageOf(parameters.model);
  Lens lens;
  lens.parameters_ = parameters;
  lens.distortion_ = LensDistortion(terms, ideal_image, FieldRadius(parameters),
                                    kTolerance_px / std::max(parameters.fx_px, parameters.fy_px));
  const double radius = lens.distortion_.one_to_one_radius();
  if (radius >= OutermostRadius(ideal_image)) {
    lens.field_limit_rad_ = ideal_image == IdealImage::kPlane ? 0.5 * kPi : kPi;
  } else {
    lens.field_limit_rad_ = ideal_image == IdealImage::kPlane ? std::atan(radius) : radius;
  }
  if (!(lens.field_limit_rad_ > kLeastField_rad)) {
    return Invalid("its coefficients are so large that no part of the image is one-to-one");
  }
  return lens;
}

std::optional<Eigen::Vector2d> Lens::Project(const Eigen::Vector3d& point_in_camera) const {
  const auto ideal = ToIdeal(IdealImageOf(parameters_.model), point_in_camera);
  if (!ideal) return std::nullopt;
  const auto image = distortion_.Apply(*ideal);
  if (!image) return std::nullopt;
  return Eigen::Vector2d(parameters_.fx_px * image->x() + parameters_.cx_px,
                         parameters_.fy_px * image->y() + parameters_.cy_px);
}

std::optional<Eigen::Vector2d> Lens::Project(const Eigen::Vector3d& point_in_camera,
                                             ProjectionJacobian* jacobian) const {
  const IdealImage ideal_image = IdealImageOf(parameters_.model);
  const auto ideal = ToIdeal(ideal_image, point_in_camera);
  if (!ideal) return std::nullopt;
  DistortionJacobian distortion;
  const auto image = distortion_.Apply(*ideal, &distortion);
  if (!image) return std::nullopt;

  const Eigen::Vector2d focal_px(parameters_.fx_px, parameters_.fy_px);
  jacobian->by_point = focal_px.asDiagonal() *
                       (distortion.by_ideal * IdealByPoint(ideal_image, point_in_camera, *ideal));
  auto& by = jacobian->by_intrinsics;
  by.setZero();
  by(0, 0) = image->x();
  by(1, 1) = image->y();
  by(0, 2) = 1.0;
  by(1, 3) = 1.0;
  int column = 4;
  for (const Term term : TermsOf(parameters_.model)) {
    by.col(column++) = focal_px.cwiseProduct(distortion.by_terms.col(static_cast<int>(term)));
  }
  return Eigen::Vector2d(parameters_.fx_px * image->x() + parameters_.cx_px,
                         parameters_.fy_px * image->y() + parameters_.cy_px);
}

std::optional<Eigen::Vector3d> Lens::Unproject(const Eigen::Vector2d& pixel) const {
  const auto ideal = distortion_.Invert(ImageOf(parameters_, pixel));
  if (!ideal) return std::nullopt;
  return FromIdeal(IdealImageOf(parameters_.model), *ideal);
}

std::size_t Lens::Unproject(std::span<const Eigen::Vector2d> pixels,
                            std::span<Eigen::Vector3d> bearings,
                            std::span<std::uint8_t> valid) const {
  constexpr std::size_t kLanes = LensDistortion::kLanes;
  const IdealImage ideal_image = IdealImageOf(parameters_.model);
  std::size_t count = 0;
  for (std::size_t first = 0; first < pixels.size(); first += kLanes) {
    const std::size_t lanes = std::min(kLanes, pixels.size() - first);
    LensDistortion::Images images;
    LensDistortion::Images ideals;
    for (std::size_t i = 0; i < kLanes; ++i) {
      // The last block is filled up with its first pixel.
      images[i] = ImageOf(parameters_, pixels[first + (i < lanes ? i : 0)]);
    }
    const std::array<bool, kLanes> found = distortion_.Invert(images, &ideals);
    for (std::size_t i = 0; i < lanes; ++i) {
      valid[first + i] = found[i] ? 1 : 0;
      bearings[first + i] =
          found[i] ? FromIdeal(ideal_image, ideals[i]) : Eigen::Vector3d(0.0, 0.0, 0.0);
      count += valid[first + i];
    }
  }
  return count;
}

}  // namespace lodemark
