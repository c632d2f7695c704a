// The equations of DistortionTerms, inline so that loops over many points contain them.
#pragma once

#include "core/camera/lens_distortion.h"

namespace lodemark {

// The radial factor N / D and its derivative by u.
struct RadialFactor {
  double value;
  double slope;
};

template <bool kIsRational>
inline RadialFactor RadialFactorAt(const DistortionTerms& terms, double u) {
  const auto& n = terms.numerator;
  const double numerator = 1.0 + u * (n[1] + u * (n[2] + u * (n[3] + u * n[4])));
  const double numerator_slope = n[1] + u * (2.0 * n[2] + u * (3.0 * n[3] + u * (4.0 * n[4])));
  if constexpr (!kIsRational) {
    return {numerator, numerator_slope};
  } else {
    const auto& d = terms.denominator;
    const double inverse = 1.0 / (1.0 + u * (d[1] + u * (d[2] + u * d[3])));
    const double denominator_slope = d[1] + u * (2.0 * d[2] + u * (3.0 * d[3]));
    const double value = numerator * inverse;
    return {value, (numerator_slope - value * denominator_slope) * inverse};
  }
}

// What decentring and prisms add.
struct Displacement {
  double x, y;
};

inline Displacement DisplacementAt(const DistortionTerms& terms, double x, double y) {
  const double u = x * x + y * y;
  const double qx = terms.decentring.y();
  const double qy = terms.decentring.x();
  const double along = 2.0 * (qx * x + qy * y);
  return {x * along + u * (qx + terms.prism_r2.x() + u * terms.prism_r4.x()),
          y * along + u * (qy + terms.prism_r2.y() + u * terms.prism_r4.y())};
}

// A point before tilt and its derivative by the ideal point.
struct FlatPoint {
  double x, y;
  double xx, xy, yx, yy;
};

template <bool kIsRational>
inline FlatPoint FlatPointAt(const DistortionTerms& terms, double x, double y) {
  const double u = x * x + y * y;
  const RadialFactor radial = RadialFactorAt<kIsRational>(terms, u);
  const Displacement displacement = DisplacementAt(terms, x, y);
  const double qx = terms.decentring.y();
  const double qy = terms.decentring.x();
  const double diagonal = radial.value + 2.0 * (qx * x + qy * y);
  const double slope_x =
      2.0 * (radial.slope * x + qx + terms.prism_r2.x() + 2.0 * u * terms.prism_r4.x());
  const double slope_y =
      2.0 * (radial.slope * y + qy + terms.prism_r2.y() + 2.0 * u * terms.prism_r4.y());
  return {x * radial.value + displacement.x,   y * radial.value + displacement.y,
          diagonal + x * (slope_x + 2.0 * qx), y * slope_x + 2.0 * x * qy,
          x * slope_y + 2.0 * y * qx,          diagonal + y * (slope_y + 2.0 * qy)};
}

}  // namespace lodemark
