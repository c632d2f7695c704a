// How LensDistortion is undone.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/camera/distortion_equations.h"
#include "core/camera/lens_distortion.h"

namespace lodemark {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Rounding of the forward equations, relative to the image radius: where Newton's steps stop, and
// what is still taken where they end because they gain nothing.
constexpr double kStopRounding = 2.0 * kEpsilon;
constexpr double kAcceptRounding = 64.0 * kEpsilon;

// From the table of start values one step leaves 1e-12 or so.
constexpr int kQuickSteps = 2;
constexpr int kMostSteps = 40;
constexpr int kMostHalvings = 12;
constexpr int kMostBisections = 200;

}  // namespace

// The table reaches a little beyond the image, or to the fold.
void LensDistortion::FillStartNodes(double field_radius) {
  const double image_end =
      std::min(1.1 * field_radius, RadialAt(one_to_one_radius_) * (1.0 - 1e-9));
  if (!(image_end > 0.0)) return;
  start_per_u_ = kStartIntervals / (image_end * image_end);
  start_width_ = 1.0 / start_per_u_;
  for (int i = 0; i <= kStartIntervals; ++i) {
    const double share = static_cast<double>(i) / kStartIntervals;
    const double ideal_radius = BisectRadial(std::sqrt(share) * image_end);
    const double u = ideal_radius * ideal_radius;
    const RadialFactor radial = RadialFactorAt<true>(terms_, u);
    const double q = radial.value;
    start_[static_cast<std::size_t>(i)] = {
        1.0 / q, -radial.slope / (q * q * q * (q + 2.0 * u * radial.slope))};
  }
}

// Hermite's cubic between the nodes.
double LensDistortion::StartScale(double image_u) const {
  const double position = image_u * start_per_u_;
  const double inside = position < kStartIntervals ? position : kStartIntervals;
  const int index = std::min(static_cast<int>(inside), kStartIntervals - 1);
  const double t = inside - index;
  const StartNode& a = start_[static_cast<std::size_t>(index)];
  const StartNode& b = start_[static_cast<std::size_t>(index) + 1];
  const double rise = b.scale - a.scale;
  const double bend_a = a.slope * start_width_ - rise;
  const double bend_b = b.slope * start_width_ - rise;
  return a.scale + t * (rise + (1.0 - t) * (bend_a * (1.0 - t) - bend_b * t));
}

// The image radius grows with the ideal one all over the one-to-one disk, so Newton's steps kept
// between bounds find it.
double LensDistortion::BisectRadial(double image_radius) const {
  double low = 0.0;
  double high = one_to_one_radius_;
  double radius = std::min(image_radius, 0.5 * high);
  for (int i = 0; i < kMostBisections; ++i) {
    const RadialFactor radial = RadialFactorAt<true>(terms_, radius * radius);
    const double excess = radius * radial.value - image_radius;
    (excess > 0.0 ? high : low) = radius;
    const double newton = radius - excess / (radial.value + 2.0 * radius * radius * radial.slope);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (next == radius || std::abs(excess) <= 0.5 * kStopRounding * image_radius) break;
    radius = next;
  }
  return radius;
}

// The scale s with s N(s^2 u) / D(s^2 u) = 1, u = |image|^2: then ideal = s image.
template <bool kIsRational, std::size_t kCount>
void LensDistortion::QuickRadial(const double* x, const double* y, double* scale,
                                 double* miss2) const {
  double image_u[kCount];
  for (std::size_t i = 0; i < kCount; ++i) {
    image_u[i] = x[i] * x[i] + y[i] * y[i];
    scale[i] = StartScale(image_u[i]);
  }
  for (int step = 0; step < kQuickSteps; ++step) {
    for (std::size_t i = 0; i < kCount; ++i) {
      const double u = scale[i] * scale[i] * image_u[i];
      const RadialFactor radial = RadialFactorAt<kIsRational>(terms_, u);
      scale[i] -= (scale[i] * radial.value - 1.0) / (radial.value + 2.0 * u * radial.slope);
    }
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const double u = scale[i] * scale[i] * image_u[i];
    const double miss = scale[i] * RadialFactorAt<kIsRational>(terms_, u).value - 1.0;
    miss2[i] = miss * miss * image_u[i];
  }
}

// Starts where the other terms, taken at the radial start, leave the radial one to be undone.
template <bool kIsRational, std::size_t kCount>
void LensDistortion::QuickFlat(const double* x, const double* y, double* ideal_x, double* ideal_y,
                               double* miss2) const {
  for (std::size_t i = 0; i < kCount; ++i) {
    const double scale = StartScale(x[i] * x[i] + y[i] * y[i]);
    const Displacement displacement = DisplacementAt(terms_, scale * x[i], scale * y[i]);
    const double radial_x = x[i] - displacement.x;
    const double radial_y = y[i] - displacement.y;
    const double radial_scale = StartScale(radial_x * radial_x + radial_y * radial_y);
    ideal_x[i] = radial_scale * radial_x;
    ideal_y[i] = radial_scale * radial_y;
  }
  for (int step = 0; step < kQuickSteps; ++step) {
    for (std::size_t i = 0; i < kCount; ++i) {
      const FlatPoint flat = FlatPointAt<kIsRational>(terms_, ideal_x[i], ideal_y[i]);
      const double miss_x = x[i] - flat.x;
      const double miss_y = y[i] - flat.y;
      const double inverse = 1.0 / (flat.xx * flat.yy - flat.xy * flat.yx);
      ideal_x[i] += (flat.yy * miss_x - flat.xy * miss_y) * inverse;
      ideal_y[i] += (flat.xx * miss_y - flat.yx * miss_x) * inverse;
    }
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const FlatPoint flat = FlatPointAt<kIsRational>(terms_, ideal_x[i], ideal_y[i]);
    const double miss_x = x[i] - flat.x;
    const double miss_y = y[i] - flat.y;
    miss2[i] = miss_x * miss_x + miss_y * miss_y;
  }
}

// Steps without looking back, which end inside the disk and on the image point nearly always; the
// equations decide whether they did, and are one-to-one there.
template <std::size_t kCount>
void LensDistortion::Quick(const double* x, const double* y, double* ideal_x, double* ideal_y,
                           bool* found) const {
  double miss2[kCount];
  if (is_radial_) {
    double scale[kCount];
    if (is_rational_) {
      QuickRadial<true, kCount>(x, y, scale, miss2);
    } else {
      QuickRadial<false, kCount>(x, y, scale, miss2);
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      ideal_x[i] = scale[i] * x[i];
      ideal_y[i] = scale[i] * y[i];
    }
  } else if (is_rational_) {
    QuickFlat<true, kCount>(x, y, ideal_x, ideal_y, miss2);
  } else {
    QuickFlat<false, kCount>(x, y, ideal_x, ideal_y, miss2);
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const double image_u = x[i] * x[i] + y[i] * y[i];
    const double stop2 =
        std::max(0.25 * tolerance_ * tolerance_, 4.0 * kStopRounding * kStopRounding * image_u);
    found[i] = (miss2[i] <= stop2) & (ideal_x[i] * ideal_x[i] + ideal_y[i] * ideal_y[i] <= most_u_);
  }
}

// Newton's steps from scale * goal, kept in the disk and halved where they gain nothing. The
// derivative's symmetric part is positive definite in the disk, so its determinant is positive.
std::optional<Eigen::Vector2d> LensDistortion::NewtonFrom(double scale, double goal_x,
                                                          double goal_y) const {
  const double goal = std::sqrt(goal_x * goal_x + goal_y * goal_y);
  const double stop = std::max(0.5 * tolerance_, kStopRounding * goal);
  const double accept = std::max(tolerance_, kAcceptRounding * goal);
  const Eigen::Vector2d target(goal_x, goal_y);
  Eigen::Vector2d ideal = scale * target;
  FlatPoint flat = FlatPointAt<true>(terms_, ideal.x(), ideal.y());
  Eigen::Vector2d miss = target - Eigen::Vector2d(flat.x, flat.y);
  for (int i = 0; i < kMostSteps && miss.norm() > stop; ++i) {
    Eigen::Vector2d step(flat.yy * miss.x() - flat.xy * miss.y(),
                         flat.xx * miss.y() - flat.yx * miss.x());
    step /= flat.xx * flat.yy - flat.xy * flat.yx;
    bool gained = false;
    for (int half = 0; half < kMostHalvings && !gained; ++half) {
      Eigen::Vector2d next = ideal + step;
      const double radius = next.norm();
      if (radius > one_to_one_radius_) next *= one_to_one_radius_ / radius;
      const FlatPoint next_flat = FlatPointAt<true>(terms_, next.x(), next.y());
      const Eigen::Vector2d next_miss = target - Eigen::Vector2d(next_flat.x, next_flat.y);
      gained = next_miss.squaredNorm() < miss.squaredNorm();
      if (gained) {
        ideal = next;
        flat = next_flat;
        miss = next_miss;
      }
      step *= 0.5;
    }
    if (!gained) break;
  }
  if (!(miss.norm() <= accept)) return std::nullopt;
  return ideal;
}

std::optional<Eigen::Vector2d> LensDistortion::InvertSlowly(double x, double y) const {
  const double image_radius = std::sqrt(x * x + y * y);
  if (!(image_radius <= outermost_image_radius_)) return std::nullopt;
  const double scale = image_radius > 0.0 ? BisectRadial(image_radius) / image_radius : 1.0;
  if (!is_radial_) {
    const std::optional<Eigen::Vector2d> ideal = NewtonFrom(scale, x, y);
    return ideal ? ideal : NewtonFrom(0.0, x, y);
  }
  const double miss = std::abs(RadialAt(scale * image_radius) - image_radius);
  if (!(miss <= std::max(tolerance_, kAcceptRounding * image_radius))) return std::nullopt;
  return Eigen::Vector2d(scale * x, scale * y);
}

std::optional<Eigen::Vector2d> LensDistortion::InvertFlat(double x, double y) const {
  double ideal_x = 0.0;
  double ideal_y = 0.0;
  bool found = false;
  Quick<1>(&x, &y, &ideal_x, &ideal_y, &found);
  if (found) return Eigen::Vector2d(ideal_x, ideal_y);
  return InvertSlowly(x, y);
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
  if (is_tilted_) return InvertTilted(image);
  if (!is_identity_) return InvertFlat(image.x(), image.y());
  if (!(image.squaredNorm() <= most_u_)) return std::nullopt;
  return image;
}

std::array<bool, LensDistortion::kLanes> LensDistortion::Invert(const Images& images,
                                                                Images* ideals) const {
  std::array<bool, kLanes> found = {};
  if (!is_tilted_ && !is_identity_) {
    double x[kLanes];
    double y[kLanes];
    double ideal_x[kLanes];
    double ideal_y[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) {
      x[i] = images[i].x();
      y[i] = images[i].y();
    }
    Quick<kLanes>(x, y, ideal_x, ideal_y, found.data());
    for (std::size_t i = 0; i < kLanes; ++i) (*ideals)[i] = {ideal_x[i], ideal_y[i]};
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    if (found[i]) continue;
    const std::optional<Eigen::Vector2d> ideal =
        is_tilted_ || is_identity_ ? Invert(images[i]) : InvertSlowly(images[i].x(), images[i].y());
    found[i] = ideal.has_value();
    if (ideal) (*ideals)[i] = *ideal;
  }
  return found;
}

}  // namespace lodemark
