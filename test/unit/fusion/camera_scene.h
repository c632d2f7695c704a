// Landmarks seen from the place of a RangeScene, for the tests of fusion.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "core/fusion/bearing_group.h"
#include "test/unit/fusion/range_scene.h"

namespace lodemark {

// Held level, the optical axis to the north unless turned. Measured without error until asked.
class CameraScene {
 public:
  explicit CameraScene(const RangeScene* place, double heading_deg = 0.0) : place_(place) {
    const Geodetic here = GeodeticFromEcef(place->truth_in_ecef);
    const double heading_rad = heading_deg * kRadiansPerDegree;
    // Rows: right, down, forward in east, north, up.
    Eigen::Matrix3d camera_from_enu;
    camera_from_enu << std::cos(heading_rad), -std::sin(heading_rad), 0.0, 0.0, 0.0, -1.0,
        std::sin(heading_rad), std::cos(heading_rad), 0.0;
    camera_from_ecef = Eigen::Quaterniond(camera_from_enu * EnuFromEcefRotation(here));
  }

  // sigma_rad: of the bearing; noise: of it, in sigmas, right and down.
  void AddLandmark(const Eigen::Vector3d& point_in_enu, double sigma_rad = 1e-3,
                   const Eigen::Vector2d& noise = Eigen::Vector2d::Zero()) {
    BearingObservation bearing;
    bearing.point_in_ecef = place_->Beside(point_in_enu);
    const Eigen::Vector3d true_direction =
        (camera_from_ecef * (bearing.point_in_ecef - place_->truth_in_ecef)).normalized();
    const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(true_direction).normalized();
    const Eigen::Vector3d down = true_direction.cross(right);
    bearing.direction_in_camera =
        (true_direction + sigma_rad * (noise.x() * right + noise.y() * down)).normalized();
    const Eigen::Vector3d x =
        Eigen::Vector3d::UnitY().cross(bearing.direction_in_camera).normalized();
    bearing.whitener.row(0) = x / sigma_rad;
    bearing.whitener.row(1) = bearing.direction_in_camera.cross(x) / sigma_rad;
    bearings.push_back(bearing);
  }

  // A wall 60 m to the north and one beside it, with so many landmarks.
  void AddWalls(int count, Random* random, double sigma_rad = 1e-3) {
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3d point(random->Uniform(-35.0, 35.0), 60.0, random->Uniform(-1.0, 18.0));
      if (i % 3 == 0) point = {-30.0, random->Uniform(45.0, 90.0), random->Uniform(-1.0, 18.0)};
      AddLandmark(point, sigma_rad, {random->Gaussian(), random->Gaussian()});
    }
  }

  Eigen::Quaterniond camera_from_ecef;
  std::vector<BearingObservation> bearings;

 private:
  const RangeScene* place_;
};

}  // namespace lodemark
