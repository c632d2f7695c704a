// Poses as the C interface states them.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/base/units.h"
#include "core/capi/eyes.h"
#include "core/session/accuracy.h"

namespace lodemark {
namespace {

static_assert(LODEMARK_POSE_GOOD == static_cast<int>(PoseVerdict::kPose));
static_assert(LODEMARK_POSE_WEAK == static_cast<int>(PoseVerdict::kWeak));
static_assert(LODEMARK_POSE_AMBIGUOUS == static_cast<int>(PoseVerdict::kAmbiguous));
static_assert(LODEMARK_POSE_TOO_FEW == static_cast<int>(PoseVerdict::kTooFew));
static_assert(LODEMARK_POSE_DEGENERATE == static_cast<int>(PoseVerdict::kDegenerate));
static_assert(LODEMARK_POSE_NOT_HERE == static_cast<int>(PoseVerdict::kNotHere));

void WriteQuaternion(const Eigen::Quaterniond& rotation, double (&out)[4]) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  out[0] = sign * rotation.w();
  out[1] = sign * rotation.x();
  out[2] = sign * rotation.y();
  out[3] = sign * rotation.z();
}

// Heading, pitch and roll of a camera; with the axis straight up or down the heading is the one
// that it had before it was tilted and the roll is zero.
void WriteAngles(const Eigen::Matrix3d& camera_from_enu, lodemark_pose* to) {
  const Eigen::Vector3d axis = camera_from_enu.row(2);
  const Eigen::Vector3d right = camera_from_enu.row(0);
  const double level = std::hypot(axis.x(), axis.y());
  to->pitch_deg = std::atan2(axis.z(), level) * kDegreesPerRadian;
  double heading_rad = std::atan2(axis.x(), axis.y());
  if (level < 1e-9) {
    heading_rad = std::atan2(-right.y(), right.x());
  } else {
    const Eigen::Vector3d level_right(axis.y() / level, -axis.x() / level, 0.0);
    const Eigen::Vector3d upward = level_right.cross(axis);
    to->roll_deg = std::atan2(-right.dot(upward), right.dot(level_right)) * kDegreesPerRadian;
  }
  to->heading_deg = heading_rad * kDegreesPerRadian;
  if (to->heading_deg < 0.0) to->heading_deg += 360.0;
}

struct LocalPose {
  Eigen::Vector3d centre_in_ecef;
  Eigen::Matrix3d local_from_frame;
  Eigen::Quaterniond camera_from_local;
};

LocalPose AtItsPlace(const Rigid3& camera_from_enu, const EnuFrame& frame) {
  LocalPose pose;
  pose.centre_in_ecef = frame.ToEcef(camera_from_enu.Inverse().translation());
  pose.local_from_frame = FrameFromLocal(frame, pose.centre_in_ecef).transpose();
  pose.camera_from_local = Eigen::Quaterniond(camera_from_enu.rotation().toRotationMatrix() *
                                              pose.local_from_frame.transpose());
  return pose;
}

}  // namespace

lodemark_pose ToC(const ResectedCamera& from, const EnuFrame& frame) {
  if (!from.lens) return ToC(from.pose, LensParameters{}, frame);
  lodemark_pose to = ToC(from.pose, from.lens->parameters(), frame);
  to.focal_sigma_px = from.focal_sigma_px;
  return to;
}

lodemark_pose ToC(const ResectedPose& from, const LensParameters& lens, const EnuFrame& frame) {
  lodemark_pose to = {};
  to.verdict = static_cast<std::int32_t>(from.verdict);
  to.inliers = from.inliers;
  to.samples = from.samples;
  to.log10_chance = from.log10_chance;
  const bool ambiguous = from.verdict == PoseVerdict::kAmbiguous && from.alternative.has_value();
  if (!HasPose(from.verdict) && !ambiguous) return to;

  to.focal_px = lens.fx_px;
  const LocalPose pose = AtItsPlace(from.camera_from_enu, frame);
  std::memcpy(to.ecef_m, pose.centre_in_ecef.data(), sizeof to.ecef_m);
  const Geodetic place = GeodeticFromEcef(pose.centre_in_ecef);
  to.latitude_deg = place.latitude_rad * kDegreesPerRadian;
  to.longitude_deg = place.longitude_rad * kDegreesPerRadian;
  to.height_m = place.height_m;
  WriteQuaternion(pose.camera_from_local, to.camera_from_enu);
  WriteAngles(pose.camera_from_local.toRotationMatrix(), &to);

  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = pose.local_from_frame;
  turn.bottomRightCorner<3, 3>() = pose.local_from_frame * kDegreesPerRadian;
  const Eigen::Matrix<double, 6, 6> covariance = turn * from.covariance * turn.transpose();
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(to.covariance) = covariance;
  to.accuracy_m = RadiusOfProbability(covariance.topLeftCorner<2, 2>(), 0.68);
  to.vertical_accuracy_m = kHalfWidth68 * std::sqrt(covariance(2, 2));
  to.noise_px = from.noise_px;
  if (ambiguous) {
    const LocalPose other = AtItsPlace(*from.alternative, frame);
    std::memcpy(to.alternative_ecef_m, other.centre_in_ecef.data(), sizeof to.alternative_ecef_m);
    WriteQuaternion(other.camera_from_local, to.alternative_camera_from_enu);
  }
  return to;
}

std::vector<lodemark_sight_residual> SightResiduals(const ResectedPose& pose,
                                                    const VisualRanges& ranges) {
  std::vector<lodemark_sight_residual> residuals(pose.is_inlier.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    residuals[i] = {};
    residuals[i].used = pose.is_inlier[i] != 0 ? 1 : 0;
    // Not a number where the landmark would not appear in the photograph.
    if (i >= pose.residuals_px.size() || !pose.residuals_px[i].allFinite()) continue;
    residuals[i].residual_px[0] = pose.residuals_px[i].x();
    residuals[i].residual_px[1] = pose.residuals_px[i].y();
  }
  for (const VisualRange& range : ranges.ranges) {
    residuals[range.sight].range_m = range.range_m;
    residuals[range.sight].range_sigma_m = range.sigma_m;
  }
  return residuals;
}

bool HasPose(PoseVerdict verdict) {
  return verdict == PoseVerdict::kPose || verdict == PoseVerdict::kWeak;
}

}  // namespace lodemark
