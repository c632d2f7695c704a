// What a lens does to the ideal image: radial, decentring, thin-prism and tilt terms, and back.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "core/camera/sensor_tilt.h"

namespace lodemark {

// One family covers all our models. With r the distance from the axis in the ideal image x, u = r^2
// and q = (p2, p1):
//
//   flat = x N(u) / D(u) + 2 x (q.x) + q u + prism_r2 u + prism_r4 u^2
//
// and then, if the sensor is tilted, the homography of OpenCV's tau_x and tau_y.
struct DistortionTerms {
  std::array<double, 5> numerator = {1.0, 0.0, 0.0, 0.0, 0.0};  // of u^0, u^1, ...
  std::array<double, 4> denominator = {1.0, 0.0, 0.0, 0.0};
  Eigen::Vector2d decentring = Eigen::Vector2d::Zero();  // p1, p2
  Eigen::Vector2d prism_r2 = Eigen::Vector2d::Zero();    // s1, s3
  Eigen::Vector2d prism_r4 = Eigen::Vector2d::Zero();    // s2, s4
  double tau_x_rad = 0.0;
  double tau_y_rad = 0.0;
};

// The terms one by one, in the order of the columns of DistortionJacobian::by_terms.
enum class DistortionTerm : std::uint8_t {
  kNumerator1,
  kNumerator2,
  kNumerator3,
  kNumerator4,
  kDenominator1,
  kDenominator2,
  kDenominator3,
  kDecentring1,
  kDecentring2,
  kPrism1,
  kPrism2,
  kPrism3,
  kPrism4,
  kTauX,
  kTauY,
};
inline constexpr int kDistortionTermCount = 15;

// The value a term refers to.
double* ValueOf(DistortionTerm term, DistortionTerms* terms);

struct DistortionJacobian {
  Eigen::Matrix2d by_ideal;
  Eigen::Matrix<double, 2, kDistortionTermCount> by_terms;
};

// Whether the ideal image is the plane z = 1, whose radius is the tangent of the angle from the
// axis, or the equidistant one, whose radius is the angle.
enum class IdealImage : std::uint8_t { kPlane, kEquidistant };

// Radius of the ideal image beyond which nothing is imaged: the direction straight back, or far
// enough along the plane that no photograph goes there (0.6 urad from the right angle).
double OutermostRadius(IdealImage ideal_image);

// Radius of a disk in the ideal image on which the terms (without tilt) are proved one-to-one, up
// to OutermostRadius: up to the fold itself where only radial terms are set, but for a strip
// of a ten-thousandth.
double OneToOneRadius(const DistortionTerms& terms, IdealImage ideal_image);

// Distortion with its inverse. Coordinates are in focal lengths from the principal point.
class LensDistortion {
 public:
  LensDistortion() = default;

  // What image points within field_radius and accurate to tolerance (both in focal lengths) need.
  // The terms are finite and the sensor is tilted by less than a right angle.
  LensDistortion(const DistortionTerms& terms, IdealImage ideal_image, double field_radius,
                 double tolerance);

  // One-to-one within this distance from the axis in the ideal image; 0 where not even on it.
  double one_to_one_radius() const { return one_to_one_radius_; }

  // Nothing outside the one-to-one disk or behind a tilted sensor.
  std::optional<Eigen::Vector2d> Apply(const Eigen::Vector2d& ideal) const;
  std::optional<Eigen::Vector2d> Apply(const Eigen::Vector2d& ideal,
                                       DistortionJacobian* jacobian) const;

  // The point of the one-to-one disk that Apply takes to image. Nothing if there is none.
  std::optional<Eigen::Vector2d> Invert(const Eigen::Vector2d& image) const;

  // The same, bit for bit, of several points at once.
  static constexpr std::size_t kLanes = 8;
  using Images = std::array<Eigen::Vector2d, kLanes>;
  std::array<bool, kLanes> Invert(const Images& images, Images* ideals) const;

 private:
  // Start values for undoing the radial part: ideal = scale * image, as a function of |image|^2.
  struct StartNode {
    double scale;
    double slope;
  };
  static constexpr int kStartIntervals = 32;

  void FillStartNodes(double field_radius);
  double RadialAt(double radius) const;
  double StartScale(double image_u) const;
  double BisectRadial(double image_radius) const;
  template <bool kIsRational, std::size_t kCount>
  void QuickRadial(const double* x, const double* y, double* scale, double* miss2) const;
  template <bool kIsRational, std::size_t kCount>
  void QuickFlat(const double* x, const double* y, double* ideal_x, double* ideal_y,
                 double* miss2) const;
  template <std::size_t kCount>
  void Quick(const double* x, const double* y, double* ideal_x, double* ideal_y, bool* found) const;
  std::optional<Eigen::Vector2d> InvertFlat(double x, double y) const;
  std::optional<Eigen::Vector2d> InvertSlowly(double x, double y) const;
  std::optional<Eigen::Vector2d> InvertTilted(const Eigen::Vector2d& image) const;
  std::optional<Eigen::Vector2d> NewtonFrom(double scale, double goal_x, double goal_y) const;
  void FillTermDerivatives(const Eigen::Vector2d& ideal, DistortionJacobian* jacobian) const;

  DistortionTerms terms_;
  bool is_identity_ = true;
  bool is_radial_ = true;
  bool is_rational_ = false;
  bool is_tilted_ = false;
  double one_to_one_radius_ = 0.0;
  double most_u_ = 0.0;                  // its square, and rounding
  double outermost_image_radius_ = 0.0;  // nothing of the disk appears further out (before tilt)
  double tolerance_ = 0.0;               // before tilt
  double tilted_tolerance_ = 0.0;        // after it
  double start_per_u_ = 0.0;             // nodes per unit of |image|^2
  double start_width_ = 0.0;             // between nodes
  std::array<StartNode, kStartIntervals + 1> start_ = {};
  SensorTilt tilt_ = SensorTilt(0.0, 0.0);
  Eigen::Matrix3d flat_from_tilted_ = Eigen::Matrix3d::Identity();
};

}  // namespace lodemark
