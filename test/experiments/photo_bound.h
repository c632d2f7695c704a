// What one photograph can tell at best of its camera: Fisher information from the noise as drawn.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "core/camera/lens.h"
#include "core/resection/collinearity.h"
#include "core/resection/sights.h"

namespace lodemark {

// By east, north, up of the camera and turns about them: sights, each with its own sigma and its
// landmark's, and gravity.
Matrix6d PhotoInformation(const std::vector<LandmarkSight>& sights, const Lens& lens,
                          const Eigen::Quaterniond& camera_from_enu,
                          const Eigen::Vector3d& centre_in_enu_m, double gravity_sigma_rad);

// Least covariance of the centre; infinite on its diagonal where nothing fixes it.
Eigen::Matrix3d CentreBound(const Matrix6d& information);

// What all of it tells of the centre, the attitude unknown.
Eigen::Matrix3d CentreInformation(const Matrix6d& information);

// A camera that looks along a heading, then tilted up and rolled.
Eigen::Quaterniond LevelCamera(double heading_rad, double pitch_rad, double roll_rad);

}  // namespace lodemark
