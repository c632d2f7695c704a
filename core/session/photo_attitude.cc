#include "core/session/photo_attitude.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/geo/rotation.h"

namespace lodemark {
namespace {

// A filter's attitude errs more than it says where its sensors do, and a camera sits in its phone
// as well as that was measured.
constexpr double kWidening = 1.5;
constexpr double kMountTilt_rad = 2.0 * kRadiansPerDegree;
constexpr double kMountHeading_rad = 3.0 * kRadiansPerDegree;

// Heading worse known, or of an axis steeper than this, says nothing worth a mistake.
constexpr double kWorstHeading_rad = 20.0 * kRadiansPerDegree;
constexpr double kSteepest_rad = 60.0 * kRadiansPerDegree;

// A phone that speeds up or turns with a car feels up at most so far from where it is.
constexpr double kFeltElsewhere_rad = 25.0 * kRadiansPerDegree;

// Beyond so many sigmas a pose contradicts.
constexpr double kGate = 4.0;

struct AxisHeading {
  double heading_rad = 0.0;
  // By small turns about east, north, up.
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
};

std::optional<AxisHeading> HeadingOf(const Eigen::Matrix3d& camera_from_enu) {
  const Eigen::Vector3d axis = camera_from_enu.row(2);
  const double level = axis.head<2>().squaredNorm();
  if (!(level > std::pow(std::cos(kSteepest_rad), 2))) return std::nullopt;
  return AxisHeading{std::atan2(axis.x(), axis.y()),
                     {axis.x() * axis.z() / level, axis.y() * axis.z() / level, -1.0}};
}

}  // namespace

void HoldByAttitude(const DeviceAttitude& attitude, const std::optional<GravityPrior>& felt,
                    CameraFrame* frame) {
  if (!frame->camera_from_device || !attitude.covariance_enu_rad2.allFinite()) return;
  const Eigen::Matrix3d camera_from_enu =
      (*frame->camera_from_device * attitude.device_from_enu).normalized().toRotationMatrix();
  if (felt && felt->up_in_camera.dot(camera_from_enu.col(2)) < std::cos(kFeltElsewhere_rad)) {
    return;
  }
  if (!frame->gravity) {
    const double tilt_rad = std::sqrt(attitude.covariance_enu_rad2.topLeftCorner<2, 2>().trace());
    frame->gravity = GravityPrior{camera_from_enu.col(2).normalized(),
                                  std::hypot(kWidening * tilt_rad, kMountTilt_rad)};
  }
  if (frame->heading_rad) return;
  const std::optional<AxisHeading> heading = HeadingOf(camera_from_enu);
  if (!heading) return;
  const double variance_rad2 = heading->slope.dot(attitude.covariance_enu_rad2 * heading->slope);
  const double sigma_rad =
      std::hypot(kWidening * std::sqrt(std::max(0.0, variance_rad2)), kMountHeading_rad);
  if (!(sigma_rad < kWorstHeading_rad)) return;
  frame->heading_rad = heading->heading_rad;
  frame->heading_sigma_rad = sigma_rad;
}

void DropContradictedHeading(const ResectedPose& pose, AttitudePriors* attitude) {
  if (pose.verdict != PoseVerdict::kPose || !attitude->heading) return;
  const Eigen::Matrix3d camera_from_enu = pose.camera_from_enu.rotation().toRotationMatrix();
  const Eigen::Matrix3d covariance_rad2 = pose.covariance.bottomRightCorner<3, 3>();
  const std::optional<AxisHeading> seen = HeadingOf(camera_from_enu);
  if (!seen) return;
  const double apart_rad =
      std::remainder(attitude->heading->heading_rad - seen->heading_rad, 2.0 * kPi);
  const double sigma_rad =
      std::hypot(attitude->heading->sigma_rad,
                 std::sqrt(std::max(0.0, seen->slope.dot(covariance_rad2 * seen->slope))));
  if (std::abs(apart_rad) > kGate * sigma_rad) attitude->heading.reset();
}

}  // namespace lodemark
