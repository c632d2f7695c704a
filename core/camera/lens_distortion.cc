#include "core/camera/lens_distortion.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/camera/distortion_equations.h"

namespace lodemark {

double* ValueOf(DistortionTerm term, DistortionTerms* terms) {
  switch (term) {
    case DistortionTerm::kNumerator1:
      return &terms->numerator[1];
    case DistortionTerm::kNumerator2:
      return &terms->numerator[2];
    case DistortionTerm::kNumerator3:
      return &terms->numerator[3];
    case DistortionTerm::kNumerator4:
      return &terms->numerator[4];
    case DistortionTerm::kDenominator1:
      return &terms->denominator[1];
    case DistortionTerm::kDenominator2:
      return &terms->denominator[2];
    case DistortionTerm::kDenominator3:
      return &terms->denominator[3];
    case DistortionTerm::kDecentring1:
      return &terms->decentring.x();
    case DistortionTerm::kDecentring2:
      return &terms->decentring.y();
    case DistortionTerm::kPrism1:
      return &terms->prism_r2.x();
    case DistortionTerm::kPrism2:
      return &terms->prism_r4.x();
    case DistortionTerm::kPrism3:
      return &terms->prism_r2.y();
    case DistortionTerm::kPrism4:
      return &terms->prism_r4.y();
    case DistortionTerm::kTauX:
      return &terms->tau_x_rad;
    case DistortionTerm::kTauY:
      break;
  }
  return &terms->tau_y_rad;
}

LensDistortion::LensDistortion(const DistortionTerms& terms, IdealImage ideal_image,
                               double field_radius, double tolerance)
    : terms_(terms), tolerance_(tolerance), tilted_tolerance_(tolerance) {
  const DistortionTerms none;
  is_tilted_ = terms.tau_x_rad != 0.0 || terms.tau_y_rad != 0.0;
  if (is_tilted_) {
    tilt_ = SensorTilt(terms.tau_x_rad, terms.tau_y_rad);
    flat_from_tilted_ = tilt_.tilted_from_flat.inverse();
    tolerance_ *= 0.01;  // what is left before the tilt may grow by it
  }
  is_rational_ = terms.denominator != none.denominator;
  is_radial_ =
      terms.decentring.isZero(0.0) && terms.prism_r2.isZero(0.0) && terms.prism_r4.isZero(0.0);
  is_identity_ = is_radial_ && !is_rational_ && terms.numerator == none.numerator;

  const double r = OneToOneRadius(terms, ideal_image);
  one_to_one_radius_ = r;
  most_u_ = r * r * (1.0 + 1e-12);
  outermost_image_radius_ =
      (1.0 + 1e-12) *
      (RadialAt(r) + r * r * (3.0 * terms.decentring.norm() + terms.prism_r2.norm()) +
       r * r * r * r * terms.prism_r4.norm());
  FillStartNodes(field_radius);
}

double LensDistortion::RadialAt(double radius) const {
  return radius * RadialFactorAt<true>(terms_, radius * radius).value;
}

std::optional<Eigen::Vector2d> LensDistortion::Apply(const Eigen::Vector2d& ideal) const {
  const double u = ideal.squaredNorm();
  if (!(u <= most_u_)) return std::nullopt;
  const double factor =
      is_rational_ ? RadialFactorAt<true>(terms_, u).value : RadialFactorAt<false>(terms_, u).value;
  Eigen::Vector2d flat = ideal * factor;
  if (!is_radial_) {
    const Displacement displacement = DisplacementAt(terms_, ideal.x(), ideal.y());
    flat += Eigen::Vector2d(displacement.x, displacement.y);
  }
  if (!is_tilted_) return flat;
  const Eigen::Vector3d tilted = tilt_.tilted_from_flat * flat.homogeneous();
  if (!(tilted.z() > 0.0)) return std::nullopt;
  return tilted.hnormalized();
}

std::optional<Eigen::Vector2d> LensDistortion::Apply(const Eigen::Vector2d& ideal,
                                                     DistortionJacobian* jacobian) const {
  const std::optional<Eigen::Vector2d> image = Apply(ideal);
  if (!image) return std::nullopt;
  const FlatPoint flat = FlatPointAt<true>(terms_, ideal.x(), ideal.y());
  jacobian->by_ideal << flat.xx, flat.xy, flat.yx, flat.yy;
  FillTermDerivatives(ideal, jacobian);

  // The tilt, and its own derivatives; these are not zero on a flat sensor.
  const Eigen::Vector3d before(flat.x, flat.y, 1.0);
  const double depth = tilt_.tilted_from_flat.row(2).dot(before);
  const auto image_by = [&](const Eigen::Vector3d& change) -> Eigen::Vector2d {
    return (change.head<2>() - *image * change.z()) / depth;
  };
  if (is_tilted_) {
    Eigen::Matrix2d image_by_flat;
    image_by_flat.col(0) = image_by(tilt_.tilted_from_flat.col(0));
    image_by_flat.col(1) = image_by(tilt_.tilted_from_flat.col(1));
    jacobian->by_ideal = (image_by_flat * jacobian->by_ideal).eval();
    jacobian->by_terms = (image_by_flat * jacobian->by_terms).eval();
  }
  jacobian->by_terms.col(static_cast<int>(DistortionTerm::kTauX)) =
      image_by(tilt_.by_tau_x * before);
  jacobian->by_terms.col(static_cast<int>(DistortionTerm::kTauY)) =
      image_by(tilt_.by_tau_y * before);
  return image;
}

void LensDistortion::FillTermDerivatives(const Eigen::Vector2d& ideal,
                                         DistortionJacobian* jacobian) const {
  const double x = ideal.x();
  const double y = ideal.y();
  const double u = x * x + y * y;
  const auto& d = terms_.denominator;
  const double inverse = 1.0 / (1.0 + u * (d[1] + u * (d[2] + u * d[3])));
  const double factor = RadialFactorAt<true>(terms_, u).value;
  auto& by = jacobian->by_terms;
  double power = u;
  for (int i = 0; i < 4; ++i) {
    by.col(static_cast<int>(DistortionTerm::kNumerator1) + i) = ideal * (power * inverse);
    if (i < 3) {
      by.col(static_cast<int>(DistortionTerm::kDenominator1) + i) =
          ideal * (-factor * power * inverse);
    }
    power *= u;
  }
  by.col(static_cast<int>(DistortionTerm::kDecentring1)) << 2.0 * x * y, u + 2.0 * y * y;
  by.col(static_cast<int>(DistortionTerm::kDecentring2)) << u + 2.0 * x * x, 2.0 * x * y;
  by.col(static_cast<int>(DistortionTerm::kPrism1)) << u, 0.0;
  by.col(static_cast<int>(DistortionTerm::kPrism2)) << u * u, 0.0;
  by.col(static_cast<int>(DistortionTerm::kPrism3)) << 0.0, u;
  by.col(static_cast<int>(DistortionTerm::kPrism4)) << 0.0, u * u;
  by.col(static_cast<int>(DistortionTerm::kTauX)).setZero();
  by.col(static_cast<int>(DistortionTerm::kTauY)).setZero();
}

}  // namespace lodemark
