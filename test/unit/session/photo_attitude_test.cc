#include "core/session/photo_attitude.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/base/units.h"
#include "core/geo/rotation.h"

namespace lodemark {
namespace {

CameraFrame Frame(double orientation_deg) {
  LensParameters parameters;
  parameters.width_px = 640;
  parameters.height_px = 480;
  parameters.fx_px = parameters.fy_px = 500.0;
  CameraFrame frame(std::move(Lens::Create(parameters)).value());
  // Of a back camera: SENSOR_ORIENTATION as Android states it.
  const double half_rad = 0.5 * orientation_deg * kRadiansPerDegree;
  frame.camera_from_device = Eigen::Quaterniond(0.0, std::cos(half_rad), -std::sin(half_rad), 0.0);
  return frame;
}

// Upright, in portrait, its back to the heading: x to the right of who looks that way, y up, z back
// to the eye.
DeviceAttitude Upright(double heading_rad, double sigma_rad) {
  Eigen::Matrix3d device_from_enu;
  device_from_enu.row(0) << std::cos(heading_rad), -std::sin(heading_rad), 0.0;
  device_from_enu.row(1) << 0.0, 0.0, 1.0;
  device_from_enu.row(2) << -std::sin(heading_rad), -std::cos(heading_rad), 0.0;
  DeviceAttitude attitude;
  attitude.device_from_enu = Eigen::Quaterniond(device_from_enu);
  attitude.covariance_enu_rad2 = sigma_rad * sigma_rad * Eigen::Matrix3d::Identity();
  return attitude;
}

DeviceAttitude Turned(const DeviceAttitude& attitude, const Eigen::Vector3d& turn_enu_rad) {
  DeviceAttitude turned = attitude;
  turned.device_from_enu = (Turn(turn_enu_rad) * attitude.device_from_enu.conjugate()).conjugate();
  return turned;
}

TEST(PhotoAttitude, TellsWhereABackCameraLooks) {
  for (const double orientation_deg : {0.0, 90.0, 270.0}) {
    for (const double heading_deg : {0.0, 75.0, -160.0}) {
      CameraFrame frame = Frame(orientation_deg);
      HoldByAttitude(Upright(heading_deg * kRadiansPerDegree, 0.01), std::nullopt, &frame);
      ASSERT_TRUE(frame.heading_rad && frame.gravity);
      EXPECT_NEAR(*frame.heading_rad, heading_deg * kRadiansPerDegree, 1e-9);
      // A picture of an upright phone shows up where its upper edge is.
      const Eigen::Vector3d up = *frame.camera_from_device * Eigen::Vector3d::UnitY();
      EXPECT_LT((frame.gravity->up_in_camera - up).norm(), 1e-9);
    }
  }
}

TEST(PhotoAttitude, IsLessSureThanTheFilter) {
  CameraFrame sure = Frame(90.0);
  HoldByAttitude(Upright(1.0, 1e-6), std::nullopt, &sure);
  EXPECT_NEAR(sure.heading_sigma_rad, 3.0 * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(sure.gravity->sigma_rad, 2.0 * kRadiansPerDegree, 1e-6);
  CameraFrame unsure = Frame(90.0);
  HoldByAttitude(Upright(1.0, 0.1), std::nullopt, &unsure);
  EXPECT_GT(unsure.heading_sigma_rad, 0.15);
  EXPECT_GT(unsure.gravity->sigma_rad, 0.15);
  CameraFrame unknown = Frame(90.0);
  HoldByAttitude(Upright(1.0, 0.3), std::nullopt, &unknown);
  EXPECT_FALSE(unknown.heading_rad.has_value());
}

// Tilted upwards, turns about all axes move the heading: against differences.
TEST(PhotoAttitude, SpreadsAsTheAttitudeDoes) {
  const DeviceAttitude tilted = Turned(Upright(0.7, 0.0), {0.5, -0.6, 0.1});
  CameraFrame frame = Frame(0.0);
  HoldByAttitude(tilted, std::nullopt, &frame);
  Eigen::Vector3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    CameraFrame moved = Frame(0.0);
    HoldByAttitude(Turned(tilted, 1e-6 * Eigen::Vector3d::Unit(axis)), std::nullopt, &moved);
    slope[axis] = (*moved.heading_rad - *frame.heading_rad) / 1e-6;
  }
  Eigen::Matrix3d root;
  root << 0.05, 0.01, 0.0, -0.02, 0.04, 0.01, 0.03, 0.0, 0.08;
  DeviceAttitude spread = tilted;
  spread.covariance_enu_rad2 = root * root.transpose();
  CameraFrame spread_frame = Frame(0.0);
  HoldByAttitude(spread, std::nullopt, &spread_frame);
  const double sigma_rad = (root.transpose() * slope).norm();
  EXPECT_NEAR(spread_frame.heading_sigma_rad, std::hypot(1.5 * sigma_rad, 3.0 * kRadiansPerDegree),
              1e-5);
}

TEST(PhotoAttitude, ChangesNothingThatIsKnownOtherwise) {
  CameraFrame frame = Frame(90.0);
  frame.heading_rad = 2.0;
  frame.heading_sigma_rad = 0.4;
  frame.gravity = GravityPrior{Eigen::Vector3d::UnitX(), 0.03};
  HoldByAttitude(Upright(1.0, 0.01), std::nullopt, &frame);
  EXPECT_EQ(*frame.heading_rad, 2.0);
  EXPECT_EQ(frame.heading_sigma_rad, 0.4);
  EXPECT_EQ(frame.gravity->up_in_camera, Eigen::Vector3d::UnitX());
  CameraFrame loose = Frame(90.0);
  loose.camera_from_device.reset();
  HoldByAttitude(Upright(1.0, 0.01), std::nullopt, &loose);
  EXPECT_FALSE(loose.gravity || loose.heading_rad);
  // The accelerometer felt up elsewhere.
  CameraFrame wrong = Frame(90.0);
  HoldByAttitude(Upright(1.0, 0.01), GravityPrior{Eigen::Vector3d::UnitZ(), 0.04}, &wrong);
  EXPECT_FALSE(wrong.gravity || wrong.heading_rad);
  // The phone lies flat, its camera looks down.
  CameraFrame down = Frame(90.0);
  HoldByAttitude(Turned(Upright(0.0, 0.01), {-0.5 * kPi, 0.0, 0.0}), std::nullopt, &down);
  EXPECT_TRUE(down.gravity.has_value());
  EXPECT_FALSE(down.heading_rad.has_value());
}

TEST(PhotoAttitude, LandmarksOutweighAHeadingThatTheyContradict) {
  // The camera looks north, level: x east, y down, z north.
  Eigen::Matrix3d rotation;
  rotation << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0;
  ResectedPose pose;
  pose.verdict = PoseVerdict::kPose;
  pose.camera_from_enu = Rigid3(Eigen::Quaterniond(rotation), Eigen::Vector3d::Zero());
  pose.covariance.diagonal().tail<3>().setConstant(0.01 * 0.01);
  for (const double sign : {-1.0, 1.0}) {
    AttitudePriors near;
    near.heading = AttitudePriors::Heading{sign * 0.18, 0.05};
    DropContradictedHeading(pose, &near);
    EXPECT_TRUE(near.heading.has_value());
    AttitudePriors far;
    far.heading = AttitudePriors::Heading{2.0 * kPi + sign * 0.25, 0.05};
    DropContradictedHeading(pose, &far);
    EXPECT_FALSE(far.heading.has_value());
  }
  pose.verdict = PoseVerdict::kNotHere;
  AttitudePriors unseen;
  unseen.heading = AttitudePriors::Heading{2.0, 0.05};
  DropContradictedHeading(pose, &unseen);
  EXPECT_TRUE(unseen.heading.has_value());
}

}  // namespace
}  // namespace lodemark
