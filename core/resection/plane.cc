// Points of one plane: the homography by direct linear transformation, and the two poses it leaves
// by its first-order behaviour at the points' mean (Collins, Bartoli: Infinitesimal Plane-Based
// Pose Estimation, IJCV 2014). Bearings stay unit vectors throughout, so a plane seen across more
// than a half circle of a wide lens is like any other.

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/resection/minimal_solvers.h"

namespace lodemark {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Relative singular values under which points are in one place or on one line, and under which
// more than one homography fits.
constexpr double kLeastExtent = 1e-9;
constexpr double kLeastHomographyGap = 1e-10;

using Matrix32d = Eigen::Matrix<double, 3, 2>;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

// Two unit vectors perpendicular to the bearing and to each other.
Matrix32d TangentsOf(const Eigen::Vector3d& bearing) {
  Matrix32d tangents;
  tangents.col(0) = bearing.unitOrthogonal();
  tangents.col(1) = bearing.cross(tangents.col(0));
  return tangents;
}

struct PlaneCoordinates {
  Eigen::Matrix3d world_from_plane;  // rotation; the third axis is the normal
  Eigen::Vector3d origin_in_world;   // the points' mean
  Eigen::Matrix3Xd points_in_plane;  // the third row holds the departures from the plane
  double scale = 1.0;                // times a coordinate makes it about one
};

std::optional<PlaneCoordinates> FitPlane(const Eigen::Matrix3Xd& points_in_world) {
  PlaneCoordinates plane;
  // First to one of the points, where subtraction is exact or nearly so, then to the mean.
  const Eigen::Vector3d anchor = points_in_world.col(0);
  Eigen::Matrix3Xd offsets = points_in_world.colwise() - anchor;
  const Eigen::Vector3d mean = offsets.rowwise().mean();
  offsets.colwise() -= mean;
  if (!offsets.allFinite() || !anchor.allFinite()) return std::nullopt;

  const Eigen::JacobiSVD<Eigen::Matrix3Xd> axes(offsets, Eigen::ComputeFullU);
  const Eigen::Vector3d extents = axes.singularValues();
  if (!(extents(1) > kLeastExtent * extents(0) + 16.0 * kEpsilon * anchor.lpNorm<1>())) {
    return std::nullopt;
  }
  plane.world_from_plane = axes.matrixU();
  if (plane.world_from_plane.determinant() < 0.0) plane.world_from_plane.col(2) *= -1.0;
  plane.origin_in_world = anchor + mean;
  plane.points_in_plane = plane.world_from_plane.transpose() * offsets;
  plane.scale = std::sqrt(static_cast<double>(offsets.cols())) / extents(0);
  return plane;
}

// Bearing of a point of the plane, up to a positive length: homography * (x, y, 1) with the plane's
// scaled coordinates.
std::optional<Eigen::Matrix3d> FitHomography(const Eigen::Matrix3Xd& bearings,
                                             const PlaneCoordinates& plane) {
  const Eigen::Index count = bearings.cols();

  // Bearings stretched across their mean direction until they spread as widely as along it: what
  // Hartley's normalisation is to pixels. Alike both ways across, so that errors stay round.
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> spread(bearings, Eigen::ComputeFullU);
  Eigen::Vector3d widths = spread.singularValues();
  if (!(widths(2) > kEpsilon * widths(0))) return std::nullopt;
  widths.tail<2>().setConstant(widths.tail<2>().norm() * std::numbers::sqrt2 / 2.0);
  const Eigen::Matrix3d stretch = widths.cwiseInverse().asDiagonal() * spread.matrixU().transpose();
  const Eigen::Matrix3d unstretch = spread.matrixU() * widths.asDiagonal();

  const Eigen::Index rows = std::max<Eigen::Index>(2 * count, 9);
  Eigen::Matrix<double, Eigen::Dynamic, 9> design =
      Eigen::Matrix<double, Eigen::Dynamic, 9>::Zero(rows, 9);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d stretched = (stretch * bearings.col(i)).normalized();
    const Matrix32d tangents = TangentsOf(stretched);
    const Eigen::Vector3d point(plane.scale * plane.points_in_plane(0, i),
                                plane.scale * plane.points_in_plane(1, i), 1.0);
    for (int k = 0; k < 3; ++k) {
      design.block<2, 3>(2 * i, 3 * k) = point(k) * tangents.transpose();
    }
  }
  const Eigen::HouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 9>> triangle(design);
  const Matrix9d upper = triangle.matrixQR().topRows<9>().triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Matrix9d> factors(upper, Eigen::ComputeFullV);
  const Vector9d values = factors.singularValues();
  if (!(values(7) > kLeastHomographyGap * values(0))) return std::nullopt;
  const Vector9d solution = factors.matrixV().col(8);
  Eigen::Matrix3d homography = unstretch * Eigen::Map<const Eigen::Matrix3d>(solution.data());

  double in_front = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d point(plane.scale * plane.points_in_plane(0, i),
                                plane.scale * plane.points_in_plane(1, i), 1.0);
    in_front += bearings.col(i).dot((homography * point).normalized());
  }
  if (in_front < 0.0) homography = -homography;
  return homography;
}

// The translation that brings the points closest to their bearings' lines.
std::optional<Eigen::Vector3d> FitTranslation(const Eigen::Matrix3Xd& bearings,
                                              const Eigen::Matrix3Xd& rotated) {
  const Eigen::Index count = bearings.cols();
  Eigen::Matrix<double, Eigen::Dynamic, 3> design(2 * count, 3);
  Eigen::VectorXd right(2 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Matrix32d tangents = TangentsOf(bearings.col(i));
    design.middleRows<2>(2 * i) = tangents.transpose();
    right.segment<2>(2 * i) = -tangents.transpose() * rotated.col(i);
  }
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 3>> factors(design);
  if (factors.rank() < 3) return std::nullopt;
  return factors.solve(right);
}

}  // namespace

PoseSet<2> PoseFromPlane(const Eigen::Matrix3Xd& bearings,
                         const Eigen::Matrix3Xd& points_in_world) {
  PoseSet<2> poses;
  if (bearings.cols() < 4 || bearings.cols() != points_in_world.cols()) return poses;
  if (!bearings.allFinite()) return poses;
  const std::optional<PlaneCoordinates> plane = FitPlane(points_in_world);
  if (!plane.has_value()) return poses;
  const std::optional<Eigen::Matrix3d> homography = FitHomography(bearings, *plane);
  if (!homography.has_value()) return poses;

  // With the camera turned to look at the mean, a small step in the plane moves the image by the
  // Jacobian, which is the rotation's upper left 2 x 2 over the distance.
  const Eigen::Vector3d mean_in_camera = homography->col(2);
  const double mean_size = mean_in_camera.norm();
  if (!(mean_size > 0.0)) return poses;
  Eigen::Matrix3d camera_from_view;
  camera_from_view.col(2) = mean_in_camera / mean_size;
  camera_from_view.leftCols<2>() = TangentsOf(camera_from_view.col(2));
  const Eigen::Matrix2d jacobian =
      camera_from_view.leftCols<2>().transpose() * homography->leftCols<2>() / mean_size;

  // The larger singular value is the one the tilt leaves alone, and makes 1.
  const Eigen::JacobiSVD<Eigen::Matrix2d> stretches(jacobian,
                                                    Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double inverse_distance = stretches.singularValues()(0);
  if (!(inverse_distance > 0.0)) return poses;
  const double cosine = stretches.singularValues()(1) / inverse_distance;
  const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));

  double errors[2] = {};
  for (const double sign : {1.0, -1.0}) {
    // In view axes, what the plane's axes along and across the tilt become.
    Eigen::Matrix3d view_from_tilt;
    view_from_tilt.col(0) << stretches.matrixU().col(0), 0.0;
    view_from_tilt.col(1) << cosine * stretches.matrixU().col(1), sign * sine;
    view_from_tilt.col(2) = view_from_tilt.col(0).cross(view_from_tilt.col(1));
    Eigen::Matrix3d plane_from_tilt = Eigen::Matrix3d::Zero();
    plane_from_tilt.topLeftCorner<2, 2>() = stretches.matrixV();
    plane_from_tilt(2, 2) = stretches.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
    const Eigen::Matrix3d camera_from_plane =
        camera_from_view * view_from_tilt * plane_from_tilt.transpose();

    const Eigen::Matrix3Xd rotated = camera_from_plane * plane->points_in_plane;
    const std::optional<Eigen::Vector3d> mean = FitTranslation(bearings, rotated);
    if (!mean.has_value()) continue;
    double error = 0.0;
    bool all_in_front = true;
    for (Eigen::Index i = 0; i < bearings.cols(); ++i) {
      const Eigen::Vector3d seen = (rotated.col(i) + *mean).normalized();
      error += (seen - bearings.col(i)).squaredNorm();
      all_in_front &= seen.dot(bearings.col(i)) > 0.0;
    }
    if (!all_in_front || !std::isfinite(error)) continue;
    const Eigen::Matrix3d rotation = camera_from_plane * plane->world_from_plane.transpose();
    const Eigen::Quaterniond quaternion = Eigen::Quaterniond(rotation).normalized();
    errors[poses.count] = error;
    poses.camera_from_world[static_cast<std::size_t>(poses.count)] = {
        quaternion, *mean - quaternion * plane->origin_in_world};
    ++poses.count;
  }
  if (poses.count == 2 && errors[1] < errors[0]) {
    std::swap(poses.camera_from_world[0], poses.camera_from_world[1]);
  }
  return poses;
}

}  // namespace lodemark
