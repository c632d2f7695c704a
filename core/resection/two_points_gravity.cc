// Two points and the vertical, in closed form.
//
// With w = d_0 chord and e = d_1 - d_0, the edge between the points in camera axes is
// w (b_1 - b_0) / chord + e b_1. Its height is known, a line in (w, e), and so is its length, an
// ellipse; the heading follows from its horizontal part. Written so, nothing cancels where the two
// points are close together and far away.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/resection/minimal_solvers.h"

namespace lodemark {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

constexpr double kLeastChord = 1e-13;
// The edge's horizontal part, relative to its length, that leaves a heading.
constexpr double kLeastHorizontal = 1e-10;
// Sine of the bearings' elevation under which both lie in the horizon, where heights say nothing.
constexpr double kLeastElevation = 1e-12;
constexpr double kRoundingOfDiscriminant = 1e-14;

// Columns along the horizontal part of the edge, to its left, and up.
Eigen::Matrix3d HeadingFrame(const Eigen::Vector3d& horizontal, const Eigen::Vector3d& up) {
  Eigen::Matrix3d frame;
  frame.col(0) = horizontal / horizontal.norm();
  frame.col(1) = up.cross(frame.col(0));
  frame.col(2) = up;
  return frame;
}

}  // namespace

PoseSet<2> PoseFromTwoPointsAndGravity(const std::array<Eigen::Vector3d, 2>& bearings,
                                       const std::array<Eigen::Vector3d, 2>& points_in_world,
                                       const Eigen::Vector3d& up_in_camera,
                                       const Eigen::Vector3d& up_in_world) {
  PoseSet<2> poses;
  const Eigen::Vector3d edge_in_world = points_in_world[1] - points_in_world[0];
  const double length_squared = edge_in_world.squaredNorm();
  const double height = edge_in_world.dot(up_in_world);
  const Eigen::Vector3d horizontal_in_world = edge_in_world - height * up_in_world;
  const double shortest = kLeastHorizontal * std::sqrt(length_squared) +
                          8.0 * kEpsilon * points_in_world[0].lpNorm<1>();
  if (!(horizontal_in_world.squaredNorm() > shortest * shortest)) return poses;

  const Eigen::Vector3d b1_minus_b0 = bearings[1] - bearings[0];
  const double chord = b1_minus_b0.norm();
  if (!(chord > kLeastChord)) return poses;
  const Eigen::Vector3d across = b1_minus_b0 / chord;

  // w a + e b = height, and w^2 + chord w e + e^2 = length^2.
  const double a = across.dot(up_in_camera);
  const double b = bearings[1].dot(up_in_camera);
  const double normal_squared = a * a + b * b;
  if (!(normal_squared > kLeastElevation * kLeastElevation)) return poses;
  const double nearest_w = height * a / normal_squared;
  const double nearest_e = height * b / normal_squared;
  const double normal = std::sqrt(normal_squared);
  const double along_w = -b / normal;
  const double along_e = a / normal;
  const double quadratic = 1.0 + chord * along_w * along_e;
  const double half_linear = 0.5 * chord * (nearest_w * along_e + nearest_e * along_w);
  const double constant = nearest_w * nearest_w + nearest_e * nearest_e +
                          chord * nearest_w * nearest_e - length_squared;
  const double discriminant = half_linear * half_linear - quadratic * constant;
  if (!(quadratic > kEpsilon && discriminant > -kRoundingOfDiscriminant * length_squared)) {
    return poses;
  }
  const double root = std::sqrt(std::max(discriminant, 0.0));
  const double sum = half_linear > 0.0 ? half_linear + root : half_linear - root;
  const double places[2] = {-sum / quadratic, sum != 0.0 ? -constant / sum : 0.0};
  const int count = discriminant > 0.0 ? 2 : 1;

  const Eigen::Matrix3d world_frame = HeadingFrame(horizontal_in_world, up_in_world);
  for (int i = 0; i < count; ++i) {
    const double w = nearest_w + places[i] * along_w;
    const double e = nearest_e + places[i] * along_e;
    const double distance_0 = w / chord;
    if (!(distance_0 > 0.0 && distance_0 + e > 0.0)) continue;
    const Eigen::Vector3d edge = w * across + e * bearings[1];
    const Eigen::Vector3d horizontal = edge - edge.dot(up_in_camera) * up_in_camera;
    const Eigen::Matrix3d rotation =
        HeadingFrame(horizontal, up_in_camera) * world_frame.transpose();
    const Eigen::Quaterniond quaternion = Eigen::Quaterniond(rotation).normalized();
    const Eigen::Vector3d translation = distance_0 * bearings[0] - quaternion * points_in_world[0];
    if (!std::isfinite(quaternion.w() + translation.sum())) continue;
    poses.camera_from_world[static_cast<std::size_t>(poses.count)] = {quaternion, translation};
    ++poses.count;
  }
  return poses;
}

}  // namespace lodemark
