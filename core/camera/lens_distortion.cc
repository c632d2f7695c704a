#include "core/camera/lens_distortion.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/camera/sensor_tilt.h"

namespace lodemark {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Rounding of the forward equations, relative to the image radius: where Newton's steps stop, and
// what is still taken where they end because they gain nothing.
constexpr double kStopRounding = 2.0 * kEpsilon;
constexpr double kAcceptRounding = 64.0 * kEpsilon;

constexpr int kMostRadialSteps = 8;  // before bisection takes over
constexpr int kMostBisections = 200;
constexpr int kMostSteps = 40;
constexpr int kMostHalvings = 12;

}  // namespace

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
    : terms_(terms), tolerance_(tolerance) {
  const bool flat_tilt = terms.tau_x_rad == 0.0 && terms.tau_y_rad == 0.0;
  tilted_ = !flat_tilt;
  if (tilted_) {
    tilted_from_flat_ = SensorTilt(terms.tau_x_rad, terms.tau_y_rad).tilted_from_flat;
    flat_from_tilted_ = tilted_from_flat_.inverse();
    // What is left before the tilt may grow by it.
    tilted_tolerance_ = tolerance;
    tolerance_ = 0.01 * tolerance;
  }
  rational_ = terms.denominator != DistortionTerms().denominator;
  radial_only_ =
      terms.decentring.isZero(0.0) && terms.prism_r2.isZero(0.0) && terms.prism_r4.isZero(0.0);
  identity_ = radial_only_ && !rational_ && terms.numerator == DistortionTerms().numerator;
  one_to_one_radius_ = OneToOneRadius(terms, ideal_image);

  const double r = one_to_one_radius_;
  outermost_image_radius_ = r * RadialAt(r * r).factor +
                            r * r * (3.0 * terms.decentring.norm() + terms.prism_r2.norm()) +
                            r * r * r * r * terms.prism_r4.norm();

  // The start values reach a little beyond the image, or to the fold.
  const double image_end = std::min(1.1 * field_radius, r * RadialAt(r * r).factor * (1.0 - 1e-9));
  start_per_u_ = image_end > 0.0 ? kStartIntervals / (image_end * image_end) : 0.0;
  for (int i = 0; i <= kStartIntervals; ++i) {
    const double image_radius = std::sqrt(static_cast<double>(i) / kStartIntervals) * image_end;
    const double ideal_radius = BisectRadial(image_radius, 0.0, one_to_one_radius_);
    const double u = ideal_radius * ideal_radius;
    const Radial radial = RadialAt(u);
    const double q = radial.factor;
    start_[static_cast<std::size_t>(i)] = {
        1.0 / q, -radial.slope / (q * q * q * (q + 2.0 * u * radial.slope))};
  }
}

LensDistortion::Radial LensDistortion::RadialAt(double u) const {
  const auto& n = terms_.numerator;
  const double numerator = 1.0 + u * (n[1] + u * (n[2] + u * (n[3] + u * n[4])));
  const double numerator_slope = n[1] + u * (2.0 * n[2] + u * (3.0 * n[3] + u * 4.0 * n[4]));
  if (!rational_) return {numerator, numerator_slope};
  const auto& d = terms_.denominator;
  const double inverse = 1.0 / (1.0 + u * (d[1] + u * (d[2] + u * d[3])));
  const double denominator_slope = d[1] + u * (2.0 * d[2] + u * 3.0 * d[3]);
  const double factor = numerator * inverse;
  return {factor, (numerator_slope - factor * denominator_slope) * inverse};
}

LensDistortion::Flat LensDistortion::FlatAt(double x, double y) const {
  const double u = x * x + y * y;
  const Radial radial = RadialAt(u);
  const double twice_slope = 2.0 * radial.slope;
  Flat flat = {x * radial.factor,   y * radial.factor,   radial.factor + twice_slope * x * x,
               twice_slope * x * y, twice_slope * x * y, radial.factor + twice_slope * y * y};
  if (radial_only_) return flat;
  const double qx = terms_.decentring.y();
  const double qy = terms_.decentring.x();
  const double along = 2.0 * (qx * x + qy * y);
  const double prism_x = terms_.prism_r2.x() + u * terms_.prism_r4.x();
  const double prism_y = terms_.prism_r2.y() + u * terms_.prism_r4.y();
  const double slope_x = 2.0 * (qx + prism_x + u * terms_.prism_r4.x());
  const double slope_y = 2.0 * (qy + prism_y + u * terms_.prism_r4.y());
  flat.x += x * along + u * (qx + prism_x);
  flat.y += y * along + u * (qy + prism_y);
  flat.xx += along + x * (2.0 * qx + slope_x);
  flat.xy += 2.0 * x * qy + y * slope_x;
  flat.yx += 2.0 * y * qx + x * slope_y;
  flat.yy += along + y * (2.0 * qy + slope_y);
  return flat;
}

std::optional<Eigen::Vector2d> LensDistortion::Apply(const Eigen::Vector2d& ideal) const {
  const double u = ideal.squaredNorm();
  if (!(u <= one_to_one_radius_ * one_to_one_radius_ * (1.0 + 1e-12))) return std::nullopt;
  Eigen::Vector2d flat;
  if (radial_only_) {
    flat = ideal * RadialAt(u).factor;
  } else {
    const Flat all = FlatAt(ideal.x(), ideal.y());
    flat = {all.x, all.y};
  }
  if (!tilted_) return flat;
  const Eigen::Vector3d tilted = tilted_from_flat_ * flat.homogeneous();
  if (!(tilted.z() > 0.0)) return std::nullopt;
  return tilted.hnormalized();
}

std::optional<Eigen::Vector2d> LensDistortion::Apply(const Eigen::Vector2d& ideal,
                                                     DistortionJacobian* jacobian) const {
  const std::optional<Eigen::Vector2d> image = Apply(ideal);
  if (!image) return std::nullopt;
  const Flat flat = FlatAt(ideal.x(), ideal.y());
  jacobian->by_ideal << flat.xx, flat.xy, flat.yx, flat.yy;
  FillTermDerivatives(ideal.x(), ideal.y(), jacobian);

  // The tilt, and its own derivatives; these are not zero on a flat sensor.
  const SensorTilt tilt(terms_.tau_x_rad, terms_.tau_y_rad);
  const Eigen::Vector3d before(flat.x, flat.y, 1.0);
  const double depth = tilt.tilted_from_flat.row(2).dot(before);
  const auto image_by = [&](const Eigen::Vector3d& change) -> Eigen::Vector2d {
    return (change.head<2>() - *image * change.z()) / depth;
  };
  if (tilted_) {
    Eigen::Matrix2d image_by_flat;
    image_by_flat.col(0) = image_by(tilt.tilted_from_flat.col(0));
    image_by_flat.col(1) = image_by(tilt.tilted_from_flat.col(1));
    jacobian->by_ideal = (image_by_flat * jacobian->by_ideal).eval();
    jacobian->by_terms = (image_by_flat * jacobian->by_terms).eval();
  }
  jacobian->by_terms.col(static_cast<int>(DistortionTerm::kTauX)) =
      image_by(tilt.by_tau_x * before);
  jacobian->by_terms.col(static_cast<int>(DistortionTerm::kTauY)) =
      image_by(tilt.by_tau_y * before);
  return image;
}

void LensDistortion::FillTermDerivatives(double x, double y, DistortionJacobian* jacobian) const {
  const double u = x * x + y * y;
  const Eigen::Vector2d ideal(x, y);
  const auto& d = terms_.denominator;
  const double inverse = 1.0 / (1.0 + u * (d[1] + u * (d[2] + u * d[3])));
  const double factor = RadialAt(u).factor;
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

double LensDistortion::StartScale(double image_u) const {
  const double position = image_u * start_per_u_;
  if (!(position < kStartIntervals)) return start_[kStartIntervals].scale;
  const int index = static_cast<int>(position);
  const double t = position - index;
  const StartNode& a = start_[static_cast<std::size_t>(index)];
  const StartNode& b = start_[static_cast<std::size_t>(index) + 1];
  // Hermite's cubic.
  const double width = 1.0 / start_per_u_;
  const double rise = b.scale - a.scale;
  const double bend_a = a.slope * width - rise;
  const double bend_b = b.slope * width - rise;
  return a.scale + t * (rise + (1.0 - t) * (bend_a * (1.0 - t) - bend_b * t));
}

// The image radius grows with the ideal one all over the one-to-one disk.
double LensDistortion::BisectRadial(double image_radius, double low, double high) const {
  double radius = std::min(image_radius, 0.5 * (low + high));
  for (int i = 0; i < kMostBisections; ++i) {
    const Radial radial = RadialAt(radius * radius);
    const double excess = radius * radial.factor - image_radius;
    (excess > 0.0 ? high : low) = radius;
    const double newton = radius - excess / (radial.factor + 2.0 * radius * radius * radial.slope);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (next == radius || std::abs(excess) <= 0.5 * kStopRounding * image_radius) break;
    radius = next;
  }
  return radius;
}

// The scale s with s N(s^2 u) / D(s^2 u) = 1: ideal = s * image.
double LensDistortion::UndoRadial(double image_u) const {
  double scale = StartScale(image_u);
  for (int i = 0; i < kMostRadialSteps; ++i) {
    const double u = scale * scale * image_u;
    const Radial radial = RadialAt(u);
    const double excess = scale * radial.factor - 1.0;
    if (std::abs(excess) <= kStopRounding &&
        u <= one_to_one_radius_ * one_to_one_radius_ * (1.0 + 1e-9)) {
      return scale;
    }
    scale -= excess / (radial.factor + 2.0 * u * radial.slope);
  }
  const double image_radius = std::sqrt(image_u);
  return image_radius > 0.0 ? BisectRadial(image_radius, 0.0, one_to_one_radius_) / image_radius
                            : 1.0;
}

std::optional<Eigen::Vector2d> LensDistortion::InvertRadial(double x, double y) const {
  const double image_u = x * x + y * y;
  const double outermost = outermost_image_radius_ * (1.0 + 1e-12);
  if (!(image_u <= outermost * outermost)) return std::nullopt;
  const double scale = UndoRadial(image_u);
  const double u = scale * scale * image_u;
  const double miss = std::abs(scale * RadialAt(u).factor - 1.0);
  const double radius = std::sqrt(image_u);
  if (!(miss * radius <= std::max(tolerance_, kAcceptRounding * radius))) return std::nullopt;
  return Eigen::Vector2d(scale * x, scale * y);
}

// Newton's steps, kept in the disk and halved where they gain nothing. The derivative's symmetric
// part is positive definite in the disk, so its determinant is positive.
std::optional<Eigen::Vector2d> LensDistortion::NewtonFrom(double x, double y, double goal_x,
                                                          double goal_y) const {
  const double most_u = one_to_one_radius_ * one_to_one_radius_;
  const double goal = std::sqrt(goal_x * goal_x + goal_y * goal_y);
  const double stop = std::max(0.5 * tolerance_, kStopRounding * goal);
  const double accept = std::max(tolerance_, kAcceptRounding * goal);
  Flat flat = FlatAt(x, y);
  double miss_x = goal_x - flat.x;
  double miss_y = goal_y - flat.y;
  double miss = miss_x * miss_x + miss_y * miss_y;
  for (int i = 0; i < kMostSteps && miss > stop * stop; ++i) {
    const double inverse = 1.0 / (flat.xx * flat.yy - flat.xy * flat.yx);
    double step_x = (flat.yy * miss_x - flat.xy * miss_y) * inverse;
    double step_y = (flat.xx * miss_y - flat.yx * miss_x) * inverse;
    bool gained = false;
    for (int half = 0; half < kMostHalvings && !gained; ++half) {
      double next_x = x + step_x;
      double next_y = y + step_y;
      const double u = next_x * next_x + next_y * next_y;
      if (u > most_u) {
        const double shrink = std::sqrt(most_u / u);
        next_x *= shrink;
        next_y *= shrink;
      }
      const Flat next = FlatAt(next_x, next_y);
      const double next_miss_x = goal_x - next.x;
      const double next_miss_y = goal_y - next.y;
      const double next_miss = next_miss_x * next_miss_x + next_miss_y * next_miss_y;
      gained = next_miss < miss;
      if (gained) {
        x = next_x;
        y = next_y;
        flat = next;
        miss_x = next_miss_x;
        miss_y = next_miss_y;
        miss = next_miss;
      }
      step_x *= 0.5;
      step_y *= 0.5;
    }
    if (!gained) break;
  }
  if (!(miss <= accept * accept)) return std::nullopt;
  return Eigen::Vector2d(x, y);
}

std::optional<Eigen::Vector2d> LensDistortion::InvertFlat(double x, double y) const {
  const double image_u = x * x + y * y;
  const double outermost = outermost_image_radius_ * (1.0 + 1e-12);
  if (!(image_u <= outermost * outermost)) return std::nullopt;
  double scale = StartScale(image_u);
  const double most_u = one_to_one_radius_ * one_to_one_radius_;
  if (scale * scale * image_u > most_u) scale = std::sqrt(most_u / image_u);
  std::optional<Eigen::Vector2d> ideal = NewtonFrom(scale * x, scale * y, x, y);
  if (!ideal) {
    // Far outside the image the table is no help; undo the radial part there properly.
    const double image_radius = std::sqrt(image_u);
    scale = BisectRadial(image_radius, 0.0, one_to_one_radius_) / image_radius;
    ideal = NewtonFrom(scale * x, scale * y, x, y);
  }
  return ideal ? ideal : NewtonFrom(0.0, 0.0, x, y);
}

std::optional<Eigen::Vector2d> LensDistortion::InvertTilted(const Eigen::Vector2d& image) const {
  const Eigen::Vector3d flat = flat_from_tilted_ * image.homogeneous();
  if (!(flat.z() > 0.0)) return std::nullopt;
  const std::optional<Eigen::Vector2d> ideal = InvertFlat(flat.x() / flat.z(), flat.y() / flat.z());
  if (!ideal) return std::nullopt;
  // Towards the horizon of a tilted sensor the homography multiplies what Newton's steps left.
  const std::optional<Eigen::Vector2d> again = Apply(*ideal);
  const double accept = std::max(tilted_tolerance_, kAcceptRounding * image.norm());
  if (!again || !((*again - image).norm() <= accept)) return std::nullopt;
  return ideal;
}

std::optional<Eigen::Vector2d> LensDistortion::Invert(const Eigen::Vector2d& image) const {
  if (tilted_) return InvertTilted(image);
  if (identity_) {
    if (!(image.squaredNorm() <= one_to_one_radius_ * one_to_one_radius_)) return std::nullopt;
    return image;
  }
  return radial_only_ ? InvertRadial(image.x(), image.y()) : InvertFlat(image.x(), image.y());
}

}  // namespace lodemark
