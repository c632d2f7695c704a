#include "core/fusion/bearing_group.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "test/unit/fusion/camera_scene.h"

namespace lodemark {
namespace {

// Where the statement puts the camera, in the scene's east, north, up.
Eigen::Vector3d PlaceSaid(const RangeScene& scene, const PositionStatement& statement) {
  Eigen::Vector3d offset_m;
  Eigen::Matrix3d covariance_m2;
  statement.Moments(1e3, &offset_m, &covariance_m2);
  return scene.ErrorInEnu(statement.around_in_ecef) + offset_m;
}

// Relinearised until it stays.
PositionStatement Settled(const RangeScene& scene, const Eigen::Vector3d& start_in_enu,
                          BearingGroup* group) {
  Eigen::Vector3d place = start_in_enu;
  PositionStatement statement;
  for (int i = 0; i < 12; ++i) {
    statement = group->At(scene.Beside(place));
    place = PlaceSaid(scene, statement);
  }
  return statement;
}

TEST(BearingGroup, FindsTheCameraFromTwelveMetresAndTwentyDegreesAway) {
  const RangeScene scene;
  for (const double heading_deg : {0.0, 10.0, -15.0}) {
    CameraScene camera(&scene, heading_deg);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(-20.0, 60.0, 3.0), Eigen::Vector3d(15.0, 60.0, 12.0),
          Eigen::Vector3d(3.0, 45.0, 0.5), Eigen::Vector3d(-8.0, 80.0, 20.0)}) {
      camera.AddLandmark(point);
    }
    BearingGroup group;
    const Eigen::Quaterniond start(
        Eigen::AngleAxisd(0.35, Eigen::Vector3d(0.2, 1.0, 0.1).normalized()));
    group.Set(camera.bearings, {}, start * camera.camera_from_ecef, {});
    const PositionStatement statement = Settled(scene, {8.0, -7.0, 5.0}, &group);
    EXPECT_EQ(statement.Rank(1e3), 3);
    EXPECT_LT(PlaceSaid(scene, statement).norm(), 1e-5) << heading_deg;
    EXPECT_LT(group.camera_from_ecef().angularDistance(camera.camera_from_ecef), 1e-7);
  }
}

// The statement is the second-order model of the cost that is least over the attitude.
TEST(BearingGroup, PullIsTheSlopeOfTheLeastCost) {
  const RangeScene scene;
  CameraScene camera(&scene);
  Random random(5);
  camera.AddWalls(9, &random);
  const auto cost_at = [&](const Eigen::Vector3d& place) {
    BearingGroup group;
    BearingOptions options;
    options.wrong_probability = 1e-12;
    group.Set(camera.bearings, {}, camera.camera_from_ecef, options);
    group.At(scene.Beside(place));
    double cost = 0.0;
    for (const BearingVerdict& verdict : group.verdicts()) {
      cost += 0.5 * verdict.residual.squaredNorm();
    }
    return cost;
  };
  BearingGroup group;
  BearingOptions options;
  options.wrong_probability = 1e-12;
  group.Set(camera.bearings, {}, camera.camera_from_ecef, options);
  const Eigen::Vector3d place(0.02, -0.03, 0.01);
  const PositionStatement statement = group.At(scene.Beside(place));
  constexpr double kStep_m = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(axis);
    const double slope = (cost_at(place + step) - cost_at(place - step)) / (2.0 * kStep_m);
    EXPECT_NEAR(slope, -statement.pull_pm[axis], 1e-3 * statement.pull_pm.norm()) << axis;
  }
}

TEST(BearingGroup, StatedCovarianceIsTheScatter) {
  const RangeScene scene;
  constexpr int kDraws = 400;
  Random random(11);
  double sum = 0.0;
  double attitude_sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    CameraScene camera(&scene);
    camera.AddWalls(12, &random);
    BearingGroup group;
    group.Set(camera.bearings, {}, camera.camera_from_ecef, {});
    const PositionStatement statement = Settled(scene, Eigen::Vector3d::Zero(), &group);
    const Eigen::Vector3d error = PlaceSaid(scene, statement);
    sum += error.dot(statement.information_pm2 * error);
    const Eigen::Quaterniond turned =
        group.camera_from_ecef() * camera.camera_from_ecef.conjugate();
    const Eigen::Vector3d turn_in_camera = 2.0 * turned.vec() * (turned.w() < 0.0 ? -1.0 : 1.0);
    const Eigen::Matrix3d camera_from_enu =
        camera.camera_from_ecef.toRotationMatrix() *
        EnuFromEcefRotation(GeodeticFromEcef(scene.truth_in_ecef)).transpose();
    const Eigen::Vector3d turn = camera_from_enu.transpose() * turn_in_camera;
    const Eigen::Matrix3d covariance =
        group.AttitudeCovariance(statement.information_pm2.inverse());
    attitude_sum += turn.dot(covariance.inverse() * turn);
  }
  // Three degrees of freedom each: the mean of 400 lies within 0.5 of 3 but for one in 10^4.
  EXPECT_NEAR(sum / kDraws, 3.0, 0.5);
  EXPECT_NEAR(attitude_sum / kDraws, 3.0, 0.5);
}

TEST(BearingGroup, ABearingOfAnotherPointWeighsNothing) {
  const RangeScene scene;
  CameraScene camera(&scene);
  Random random(7);
  camera.AddWalls(12, &random);
  std::swap(camera.bearings[2].point_in_ecef, camera.bearings[5].point_in_ecef);
  BearingGroup group;
  group.Set(camera.bearings, {}, camera.camera_from_ecef, {});
  const PositionStatement statement = Settled(scene, {1.0, 1.0, 0.0}, &group);
  EXPECT_LT(PlaceSaid(scene, statement).norm(), 0.6);
  for (std::size_t i = 0; i < camera.bearings.size(); ++i) {
    if (i == 2 || i == 5) {
      EXPECT_LT(group.WeightOf(i), 0.01) << i;
    } else {
      EXPECT_GT(group.WeightOf(i), 0.9) << i;
    }
  }
}

TEST(BearingGroup, OneBearingWithGravityAndHeadingGivesTwoLines) {
  const RangeScene scene;
  CameraScene camera(&scene);
  camera.AddLandmark({5.0, 60.0, 10.0});
  AttitudePriors priors;
  priors.gravity = AttitudePriors::Gravity{{0.0, -1.0, 0.0}, 0.01};
  priors.heading = AttitudePriors::Heading{0.0, 0.05};
  BearingGroup group;
  group.Set(camera.bearings, priors, camera.camera_from_ecef, {});
  const PositionStatement statement = group.At(scene.truth_in_ecef);
  EXPECT_EQ(statement.Rank(20.0), 2);
  Eigen::Vector3d offset_m;
  Eigen::Matrix3d covariance_m2;
  statement.Moments(20.0, &offset_m, &covariance_m2);
  EXPECT_LT(offset_m.norm(), 1e-6);
  // Across the line of sight the heading's 0.05 rad at 60 m, upwards gravity's 0.01 rad.
  EXPECT_NEAR(std::sqrt(1.0 / statement.information_pm2(0, 0)), 0.05 * 60.0, 0.15);
  EXPECT_NEAR(std::sqrt(1.0 / statement.information_pm2(2, 2)), 0.01 * 60.0, 0.06);
  // Without them, nothing.
  group.Set(camera.bearings, {}, camera.camera_from_ecef, {});
  EXPECT_EQ(group.At(scene.truth_in_ecef).Rank(20.0), 0);
}

TEST(BearingGroup, PriorsTurnTheCamera) {
  const RangeScene scene;
  CameraScene camera(&scene, 40.0);
  AttitudePriors priors;
  priors.gravity = AttitudePriors::Gravity{{0.0, -1.0, 0.0}, 0.01};
  priors.heading = AttitudePriors::Heading{40.0 * kRadiansPerDegree, 0.05};
  const CameraScene other(&scene, -20.0);
  const Eigen::Quaterniond tilted(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  BearingGroup group;
  group.Set({}, priors, tilted * other.camera_from_ecef, {});
  for (int i = 0; i < 5; ++i) group.At(scene.truth_in_ecef);
  // Half a turn of doubt about an attitude nobody knows pulls it by next to nothing.
  EXPECT_LT(group.camera_from_ecef().angularDistance(camera.camera_from_ecef), 1e-3);
}

TEST(BearingGroup, ALandmarkThatIsUncertainCountsForLess) {
  const RangeScene scene;
  CameraScene camera(&scene);
  Random random(3);
  camera.AddWalls(6, &random);
  BearingGroup sure;
  sure.Set(camera.bearings, {}, camera.camera_from_ecef, {});
  for (BearingObservation& bearing : camera.bearings) {
    bearing.point_covariance_enu_m2 = 0.25 * Eigen::Matrix3d::Identity();
  }
  BearingGroup unsure;
  unsure.Set(camera.bearings, {}, camera.camera_from_ecef, {});
  const double sure_m2 =
      Settled(scene, Eigen::Vector3d::Zero(), &sure).information_pm2.inverse().trace();
  const double unsure_m2 =
      Settled(scene, Eigen::Vector3d::Zero(), &unsure).information_pm2.inverse().trace();
  // Half a metre at 60 m and more is some eight sigmas of a bearing.
  EXPECT_GT(unsure_m2, 20.0 * sure_m2);
}

// A photograph taken a moment ago, or a map that is off as a whole: the bearings fit where the
// camera stood, whatever is believed of the point that is asked about.
TEST(BearingGroup, ACommonErrorLeavesTheBearingsInAgreement) {
  const RangeScene scene;
  CameraScene camera(&scene);
  Random random(9);
  camera.AddWalls(12, &random);
  BearingOptions options;
  options.common_covariance_enu_m2 = Eigen::Vector3d(1.0, 1.0, 0.25).asDiagonal();
  BearingGroup group;
  group.Set(camera.bearings, {}, camera.camera_from_ecef, options);
  const Eigen::Vector3d asked(1.5, -1.0, 0.4);
  const PositionStatement statement = group.At(scene.Beside(asked));
  EXPECT_TRUE(group.Agrees());
  for (std::size_t i = 0; i < group.parts(); ++i) EXPECT_GT(group.WeightOf(i), 0.9) << i;
  // It says the camera's place within the common error, and where that lies from the point.
  EXPECT_LT(PlaceSaid(scene, statement).norm(), 0.3);
  Eigen::Vector3d offset_m;
  Eigen::Matrix3d covariance_m2;
  statement.Moments(1e3, &offset_m, &covariance_m2);
  EXPECT_GT(covariance_m2(0, 0), 1.0);
  EXPECT_LT(covariance_m2(0, 0), 1.1);
  const Eigen::Vector3d shift =
      scene.ErrorInEnu(scene.truth_in_ecef + group.common_shift_in_ecef_m());
  EXPECT_LT((shift + asked).norm(), 0.3);
}

TEST(BearingGroup, WithoutAPartIsTheGroupWithoutIt) {
  const RangeScene scene;
  CameraScene camera(&scene);
  Random random(9);
  camera.AddWalls(8, &random);
  BearingGroup whole;
  whole.Set(camera.bearings, {}, camera.camera_from_ecef, {});
  Settled(scene, Eigen::Vector3d::Zero(), &whole);
  const PositionStatement without = whole.Without(3);
  std::vector<BearingObservation> fewer = camera.bearings;
  fewer.erase(fewer.begin() + 3);
  BearingGroup rest;
  rest.Set(fewer, {}, whole.camera_from_ecef(), {});
  const PositionStatement said = Settled(scene, Eigen::Vector3d::Zero(), &rest);
  EXPECT_LT((PlaceSaid(scene, without) - PlaceSaid(scene, said)).norm(),
            0.05 * PlaceSaid(scene, said).norm() + 1e-3);
  EXPECT_TRUE(without.information_pm2.isApprox(said.information_pm2, 0.05));
}

}  // namespace
}  // namespace lodemark
