// Four points and an unknown focal length: the 3 x 4 camera matrices that meet all eight pixel
// coordinates form a space of four dimensions (Larsson, Kukelova, Zheng: Making Minimal Solvers for
// Absolute Pose Estimation Compact and Robust, ICCV 2017). Three of the four conditions that make a
// matrix diag(f, f, 1) [R t] are quadrics in the space, whose eight intersections follow from one
// polynomial (Kukelova, Heller, Fitzgibbon: Efficient Intersection of Three Quadrics and
// Applications in Computer Vision, CVPR 2016). Gauss-Newton's steps on the pixels then use all
// eight equations for the seven unknowns.

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/adjustment/polynomial.h"
#include "core/resection/minimal_solvers.h"

namespace lodemark {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Distance from a line, relative to the extent, that leaves a focal length; relative pivot under
// which the eight equations are fewer.
constexpr double kLeastExtent = 1e-9;
constexpr double kLeastPivot = 1e-9;
constexpr double kLeastDetermined = 1e-8;

// What a pose may leave in the pixels, relative to their spread: far more than any noise.
constexpr double kMostResidual = 0.1;
constexpr int kMostSteps = 12;

// How p1 . p3 and p2 . p3, zero both, are mixed into one equation: any angle not on an axis.
constexpr double kMixFirst = 0.8;
constexpr double kMixSecond = 0.6;

using Vector12d = Eigen::Matrix<double, 12, 1>;
using CameraSpace = Eigen::Matrix<double, 12, 4>;
using Linear = Polynomial<1>;
using Quadratic = Polynomial<2>;

// Coefficients of x^2 y^2 z^2 xy xz yz x y z 1.
using Quadric = Eigen::Matrix<double, 1, 10>;

// The inner product of rows i and j of the camera matrix, as a quadric in the space.
Quadric RowProduct(const CameraSpace& space, int i, int j) {
  const Eigen::Matrix4d product =
      space.middleRows<4>(4 * i).topRows<3>().transpose() * space.middleRows<4>(4 * j).topRows<3>();
  Quadric quadric;
  quadric << product(0, 0), product(1, 1), product(2, 2), product(0, 1) + product(1, 0),
      product(0, 2) + product(2, 0), product(1, 2) + product(2, 1), product(0, 3) + product(3, 0),
      product(1, 3) + product(3, 1), product(2, 3) + product(3, 2), product(3, 3);
  return quadric;
}

struct Intersections {
  std::array<Eigen::Vector3d, 8> places;
  int count = 0;
};

Intersections Intersect(const Eigen::Matrix<double, 3, 10>& quadrics) {
  Intersections found;
  Eigen::Matrix3d squares;
  squares << quadrics.col(1), quadrics.col(2), quadrics.col(5);
  const Eigen::ColPivHouseholderQR<Eigen::Matrix3d> factors(squares);
  if (factors.rank() < 3) return found;
  const Eigen::Matrix<double, 3, 10> reduced = -factors.solve(quadrics);

  // y^2, z^2 and y z as a y + b z + c with polynomials in x.
  std::array<Linear, 3> a;
  std::array<Linear, 3> b;
  std::array<Quadratic, 3> c;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    a[i] = {{reduced(row, 7), reduced(row, 3)}};
    b[i] = {{reduced(row, 8), reduced(row, 4)}};
    c[i] = {{reduced(row, 9), reduced(row, 6), reduced(row, 0)}};
  }

  // y (y z) = z (y^2), z (y z) = y (z^2) and (y z)^2 = y^2 z^2, each linear in y and z after the
  // same substitution: p y + q z + r = 0.
  const Quadratic p0 = b[2] * a[2] - b[0] * a[1] + c[2];
  const Quadratic q0 = a[2] * b[0] + (b[2] - a[0]) * b[2] - b[0] * b[1] - c[0];
  const Polynomial<3> r0 = a[2] * c[0] + (b[2] - a[0]) * c[2] - b[0] * c[1];
  const Quadratic p1 = (a[2] - b[1]) * a[2] + b[2] * a[1] - a[1] * a[0] - c[1];
  const Quadratic q1 = a[2] * b[2] - a[1] * b[0] + c[2];
  const Polynomial<3> r1 = (a[2] - b[1]) * c[2] + b[2] * c[1] - a[1] * c[0];
  const Quadratic by_yy = a[2] * a[2] - a[0] * a[1];
  const Quadratic by_zz = b[2] * b[2] - b[0] * b[1];
  const Quadratic by_yz = a[2] * b[2] + a[2] * b[2] - a[0] * b[1] - b[0] * a[1];
  const Polynomial<3> p2 = by_yy * a[0] + by_zz * a[1] + by_yz * a[2] + a[2] * c[2] + a[2] * c[2] -
                           a[0] * c[1] - c[0] * a[1];
  const Polynomial<3> q2 = by_yy * b[0] + by_zz * b[1] + by_yz * b[2] + b[2] * c[2] + b[2] * c[2] -
                           b[0] * c[1] - c[0] * b[1];
  const Polynomial<4> r2 = by_yy * c[0] + by_zz * c[1] + by_yz * c[2] + c[2] * c[2] - c[0] * c[1];

  const Polynomial<8> determinant =
      (p0 * q1 - p1 * q0) * r2 + (p1 * q2 - p2 * q1) * r0 + (p2 * q0 - p0 * q2) * r1;
  std::array<double, 8> roots;
  const int count = FindRealRoots(determinant, roots);
  for (int i = 0; i < count; ++i) {
    const double x = roots[static_cast<std::size_t>(i)];
    const auto at = [x](const auto& polynomial) {
      double value = 0.0;
      for (std::size_t k = polynomial.coefficients.size(); k-- > 0;) {
        value = value * x + polynomial.coefficients[k];
      }
      return value;
    };
    const Eigen::Vector3d rows[3] = {
        {at(p0), at(q0), at(r0)}, {at(p1), at(q1), at(r1)}, {at(p2), at(q2), at(r2)}};
    Eigen::Vector3d null = Eigen::Vector3d::Zero();
    for (const auto& [first, second] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
      const Eigen::Vector3d cross = rows[first].normalized().cross(rows[second].normalized());
      if (cross.squaredNorm() > null.squaredNorm()) null = cross;
    }
    const Eigen::Vector3d place(x, null.x() / null.z(), null.y() / null.z());
    if (!place.allFinite()) continue;
    found.places[static_cast<std::size_t>(found.count++)] = place;
  }
  return found;
}

// Pixels and points brought to the size of one.
struct Normalised {
  std::array<Eigen::Vector2d, 4> pixels;
  std::array<Eigen::Vector3d, 4> points;
};

// The nearest camera to a 3 x 4 matrix, and whether it has all points before it.
bool ReadCamera(const Vector12d& matrix, const Normalised& scene, FocalPose* pose) {
  Eigen::Vector3d first = matrix.segment<3>(0);
  Eigen::Vector3d second = matrix.segment<3>(4);
  Eigen::Vector3d third = matrix.segment<3>(8);
  Eigen::Vector3d translation(matrix(3), matrix(7), matrix(11));
  double sign = 0.0;
  for (const Eigen::Vector3d& point : scene.points) {
    sign += third.dot(point) + translation.z() > 0.0 ? 1.0 : -1.0;
  }
  const double scale = (sign < 0.0 ? -1.0 : 1.0) / third.norm();
  const double focal = 0.5 * (first.norm() + second.norm()) / third.norm();
  Eigen::Matrix3d rotation;
  rotation.row(2) = scale * third;
  rotation.row(0) = scale / focal * first;
  rotation.row(1) = scale / focal * second;
  if (!(rotation.determinant() > 0.1) || !std::isfinite(focal)) return false;
  const Eigen::Quaterniond quaternion = Eigen::Quaterniond(rotation).normalized();
  translation =
      scale * Eigen::Vector3d(translation.x() / focal, translation.y() / focal, translation.z());
  pose->camera_from_world = {quaternion, translation};
  pose->focal_px = focal;
  return translation.allFinite() && quaternion.coeffs().allFinite();
}

// Gauss-Newton on the pixels. False where it does not settle, a point comes to lie behind the
// camera, too much is left, or the pixels do not hold the focal length.
bool Polish(const Normalised& scene, FocalPose* pose) {
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Matrix<double, 8, 7> design;
    Eigen::Matrix<double, 8, 1> residuals;
    const Eigen::Matrix3d rotation = pose->camera_from_world.rotation().toRotationMatrix();
    for (int i = 0; i < 4; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const Eigen::Vector3d turned = rotation * scene.points[index];
      const Eigen::Vector3d point = turned + pose->camera_from_world.translation();
      if (!(point.z() > 0.0)) return false;
      const Eigen::Vector2d ratio = point.head<2>() / point.z();
      const Eigen::Vector2d pixel = pose->focal_px * ratio;
      Eigen::Matrix<double, 2, 3> by_point;
      by_point << 1.0, 0.0, -ratio.x(), 0.0, 1.0, -ratio.y();
      by_point *= pose->focal_px / point.z();
      design.block<2, 1>(2 * i, 0) = by_point * Eigen::Vector3d(0.0, -turned.z(), turned.y());
      design.block<2, 1>(2 * i, 1) = by_point * Eigen::Vector3d(turned.z(), 0.0, -turned.x());
      design.block<2, 1>(2 * i, 2) = by_point * Eigen::Vector3d(-turned.y(), turned.x(), 0.0);
      // Steps of the translation and of the focal length relative to their sizes.
      design.block<2, 3>(2 * i, 3) = by_point * pose->camera_from_world.translation().norm();
      design.block<2, 1>(2 * i, 6) = pixel;
      residuals.segment<2>(2 * i) = scene.pixels[index] - pixel;
    }
    const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 8, 7>> factors(design);
    const Eigen::Matrix<double, 7, 1> change = factors.solve(residuals);
    if (!change.allFinite() || change.norm() > 1.0) return false;
    const double turn = change.head<3>().norm();
    const Eigen::Quaterniond turning =
        turn > 0.0
            ? Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d(change.head<3>() / turn)))
            : Eigen::Quaterniond::Identity();
    const Eigen::Vector3d translation = pose->camera_from_world.translation();
    pose->camera_from_world = {turning * pose->camera_from_world.rotation(),
                               translation + translation.norm() * change.segment<3>(3)};
    pose->focal_px *= std::exp(change(6));
    if (change.norm() > 1e-9) continue;
    return residuals.norm() < kMostResidual &&
           std::abs(factors.matrixQR()(6, 6)) >
               kLeastDetermined * std::abs(factors.matrixQR()(0, 0));
  }
  return false;
}

bool IsAmong(const FocalPoseSet& set, const FocalPose& pose) {
  return std::any_of(set.poses.begin(), set.poses.begin() + set.count, [&](const FocalPose& other) {
    return std::abs(other.focal_px / pose.focal_px - 1.0) < 1e-6 &&
           other.camera_from_world.rotation().angularDistance(pose.camera_from_world.rotation()) <
               1e-6;
  });
}

}  // namespace

FocalPoseSet PoseAndFocalFromFourPoints(const std::array<Eigen::Vector2d, 4>& centred_pixels,
                                        const std::array<Eigen::Vector3d, 4>& points_in_world) {
  FocalPoseSet set;
  Normalised scene;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points_in_world) mean += 0.25 * (point - points_in_world[0]);
  double squared_extent = 0.0;
  double squared_spread_px = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    scene.points[i] = points_in_world[i] - points_in_world[0] - mean;
    squared_extent += 0.25 * scene.points[i].squaredNorm();
    squared_spread_px += 0.25 * centred_pixels[i].squaredNorm();
  }
  const double extent = std::sqrt(squared_extent);
  const double spread_px = std::sqrt(squared_spread_px);
  if (!std::isfinite(extent) || !std::isfinite(spread_px) || !(spread_px > 0.0) ||
      !(extent > 16.0 * kEpsilon * points_in_world[0].lpNorm<1>())) {
    return set;
  }
  for (Eigen::Vector3d& point : scene.points) point /= extent;
  double widest = 0.0;
  for (std::size_t i = 1; i < 4; ++i) {
    for (std::size_t j = 1; j < i; ++j) {
      widest = std::max(
          widest,
          (scene.points[i] - scene.points[0]).cross(scene.points[j] - scene.points[0]).norm());
    }
  }
  if (!(widest > kLeastExtent)) return set;

  Eigen::Matrix<double, 12, 8> equations = Eigen::Matrix<double, 12, 8>::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    scene.pixels[i] = centred_pixels[i] / spread_px;
    const Eigen::Vector4d point = scene.points[i].homogeneous();
    const auto column = static_cast<Eigen::Index>(2 * i);
    equations.col(column) << point, Eigen::Vector4d::Zero(), -scene.pixels[i].x() * point;
    equations.col(column + 1) << Eigen::Vector4d::Zero(), point, -scene.pixels[i].y() * point;
  }
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 12, 8>> factors(equations);
  if (!(std::abs(factors.matrixQR()(7, 7)) > kLeastPivot * std::abs(factors.matrixQR()(0, 0)))) {
    return set;
  }
  const Eigen::Matrix<double, 12, 12> orthogonal = factors.householderQ();

  // Mirrored across no special direction, so that no coordinate of the space is one. Where an
  // intersection is all but at infinity for one mirror, it is not for the next.
  for (const Eigen::Vector4d& mirror :
       {Eigen::Vector4d(0.82, -0.37, 0.61, 0.29), Eigen::Vector4d(-0.31, 0.78, 0.45, 0.66),
        Eigen::Vector4d(0.53, 0.24, -0.71, 0.87)}) {
    const CameraSpace space =
        orthogonal.rightCols<4>() *
        (Eigen::Matrix4d::Identity() - 2.0 / mirror.squaredNorm() * mirror * mirror.transpose());
    Eigen::Matrix<double, 3, 10> quadrics;
    quadrics.row(0) = RowProduct(space, 0, 1);
    quadrics.row(1) = RowProduct(space, 0, 0) - RowProduct(space, 1, 1);
    quadrics.row(2) = kMixFirst * RowProduct(space, 0, 2) + kMixSecond * RowProduct(space, 1, 2);

    const Intersections intersections = Intersect(quadrics);
    for (int i = 0; i < intersections.count; ++i) {
      const Vector12d matrix =
          space * intersections.places[static_cast<std::size_t>(i)].homogeneous();
      FocalPose pose;
      if (!ReadCamera(matrix, scene, &pose) || !Polish(scene, &pose) || IsAmong(set, pose)) {
        continue;
      }
      set.poses[static_cast<std::size_t>(set.count++)] = pose;
    }
    if (set.count > 0) break;
  }

  for (int i = 0; i < set.count; ++i) {
    FocalPose& pose = set.poses[static_cast<std::size_t>(i)];
    const Eigen::Quaterniond rotation = pose.camera_from_world.rotation();
    const Eigen::Vector3d translation = extent * pose.camera_from_world.translation() -
                                        rotation * mean - rotation * points_in_world[0];
    pose.camera_from_world = {rotation, translation};
    pose.focal_px *= spread_px;
  }
  return set;
}

}  // namespace lodemark
