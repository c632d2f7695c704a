// Camera poses from as few landmarks as determine them.
//
// Bearings are unit vectors in camera axes, points metres in any frame called world. Solvers give
// every real solution with all points in front along their bearings, none for degenerate input
// (collinear points, coincident bearings), and never a value that is not finite.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/geo/rigid3.h"

namespace lodemark {

// At most Capacity poses, without the heap.
template <int Capacity>
struct PoseSet {
  std::array<Rigid3, Capacity> camera_from_world;
  int count = 0;

  const Rigid3* begin() const { return camera_from_world.data(); }
  const Rigid3* end() const { return camera_from_world.data() + count; }
};

// Three points: up to four poses.
PoseSet<4> PoseFromThreePoints(const std::array<Eigen::Vector3d, 3>& bearings,
                               const std::array<Eigen::Vector3d, 3>& points_in_world);

// Two points and the vertical: up to two poses. up_in_camera and up_in_world are unit vectors.
PoseSet<2> PoseFromTwoPointsAndGravity(const std::array<Eigen::Vector3d, 2>& bearings,
                                       const std::array<Eigen::Vector3d, 2>& points_in_world,
                                       const Eigen::Vector3d& up_in_camera,
                                       const Eigen::Vector3d& up_in_world);

// Four or more points of one plane: the two poses that a homography leaves, the better first. Not
// refined: with noise they are a start. Uses the heap.
PoseSet<2> PoseFromPlane(const Eigen::Matrix3Xd& bearings, const Eigen::Matrix3Xd& points_in_world);

// Four points, of one plane or not, pinhole pixels relative to the principal point, and one unknown
// focal length. Eight equations for seven unknowns: the poses are least-squares ones, those that
// leave more than a tenth of the pixels' spread are dropped. None where pixels do not hold the
// focal length, as of a plane seen straight on.
struct FocalPose {
  Rigid3 camera_from_world;
  double focal_px = 0.0;
};
struct FocalPoseSet {
  std::array<FocalPose, 10> poses;
  int count = 0;
};
FocalPoseSet PoseAndFocalFromFourPoints(const std::array<Eigen::Vector2d, 4>& centred_pixels,
                                        const std::array<Eigen::Vector3d, 4>& points_in_world);

}  // namespace lodemark
