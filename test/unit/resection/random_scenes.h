// Cameras and points for tests of the solvers, from a seed.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/random.h"
#include "core/geo/rigid3.h"

namespace lodemark {

inline Eigen::Vector3d RandomVector(Random& random) {
  const double x = random.Gaussian();
  const double y = random.Gaussian();
  return {x, y, random.Gaussian()};
}

inline Eigen::Quaterniond RandomRotation(Random& random) {
  const Eigen::Vector3d vector = RandomVector(random);
  return Eigen::Quaterniond(random.Gaussian(), vector.x(), vector.y(), vector.z()).normalized();
}

// 2 to 80 m in front of a camera that sees 90 degrees.
inline Eigen::Vector3d PointInFront(Random& random) {
  const double depth_m = std::exp(random.Uniform(std::log(2.0), std::log(80.0)));
  const double x = random.Uniform(-1.0, 1.0);
  return depth_m * Eigen::Vector3d(x, random.Uniform(-1.0, 1.0), 1.0);
}

// On any side of a camera that sees all round.
inline Eigen::Vector3d PointAround(Random& random) { return 10.0 * RandomVector(random); }

template <std::size_t Count>
struct Scene {
  Rigid3 camera_from_world;
  std::array<Eigen::Vector3d, Count> bearings;
  std::array<Eigen::Vector3d, Count> points_in_world;

  // Largest distance between a point where it is and where the pose puts it, in camera axes,
  // relative to the furthest point.
  double ErrorOf(const Rigid3& pose) const {
    double error_m = 0.0;
    double furthest_m = 0.0;
    for (const Eigen::Vector3d& point : points_in_world) {
      const Eigen::Vector3d truth = camera_from_world * point;
      error_m = std::max(error_m, (pose * point - truth).norm());
      furthest_m = std::max(furthest_m, truth.norm());
    }
    return error_m / furthest_m;
  }

  // Of the best pose; infinite if there is none.
  template <typename Poses>
  double BestErrorOf(const Poses& poses) const {
    double best = std::numeric_limits<double>::infinity();
    for (const Rigid3& pose : poses) best = std::min(best, ErrorOf(pose));
    return best;
  }

  // Largest angle between a bearing and where the pose puts its point.
  double BearingErrorOf(const Rigid3& pose) const {
    double error_rad = 0.0;
    for (std::size_t i = 0; i < Count; ++i) {
      error_rad =
          std::max(error_rad, ((pose * points_in_world[i]).normalized() - bearings[i]).norm());
    }
    return error_rad;
  }
};

// The points given in camera axes, seen without error from a camera in a random pose whose
// distance from the world's origin is some spread_m.
template <std::size_t Count>
Scene<Count> SceneOf(const std::array<Eigen::Vector3d, Count>& points_in_camera, double spread_m,
                     Random& random) {
  Scene<Count> scene;
  const Eigen::Quaterniond rotation = RandomRotation(random);
  const Eigen::Vector3d centre_in_world = spread_m * RandomVector(random);
  scene.camera_from_world = {rotation, -(rotation * centre_in_world)};
  for (std::size_t i = 0; i < Count; ++i) {
    scene.points_in_world[i] = rotation.conjugate() * points_in_camera[i] + centre_in_world;
    scene.bearings[i] = (rotation * (scene.points_in_world[i] - centre_in_world)).normalized();
  }
  return scene;
}

}  // namespace lodemark
