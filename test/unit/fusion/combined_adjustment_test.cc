#include "core/fusion/combined_adjustment.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/fusion/bearing_group.h"
#include "test/unit/fusion/camera_scene.h"

namespace lodemark {
namespace {

struct Combined {
  PointStatus status = PointStatus::kTooFew;
  CombinedEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  BearingGroup group;
};

Combined Combine(const RangeScene& scene, const CameraScene& camera,
                 const Eigen::Vector3d& start_in_enu = {0.5, -0.4, 0.3},
                 const AttitudePriors& priors = {}) {
  Combined combined;
  combined.group.Set(camera.bearings, priors, camera.camera_from_ecef, {});
  CombinedAdjustment adjustment;
  combined.status =
      adjustment.Solve(scene.ranges, scene.Beside(start_in_enu), ClockBiases(), CombinedOptions(),
                       &combined.group, &combined.estimate, &combined.verdicts);
  return combined;
}

Eigen::Vector3d ErrorOf(const RangeScene& scene, const Combined& combined) {
  return scene.ErrorInEnu(combined.estimate.point.position_in_ecef);
}

double TraceOf(const Combined& combined) {
  return combined.estimate.point.covariance_enu_m2.trace();
}

constexpr RangeErrorModel kNoise = {3.0, 0.0, 20.0};

TEST(CombinedAdjustment, AnyNumberOfSatellitesFromNone) {
  for (int satellites = 0; satellites <= 8; ++satellites) {
    RangeScene scene;
    scene.AddSky(satellites, 0, kClock_m, kNoise);
    CameraScene camera(&scene);
    Random random(4);
    camera.AddWalls(6, &random, 1e-6);
    const Combined combined = Combine(scene, camera, {3.0, -4.0, 2.0});
    ASSERT_EQ(combined.status, PointStatus::kGood) << satellites;
    EXPECT_EQ(combined.estimate.witness, WitnessVerdict::kUsed);
    EXPECT_LT(ErrorOf(scene, combined).norm(), 1e-2) << satellites;
    if (satellites > 1) {
      EXPECT_NEAR(combined.estimate.point.clock_m, kClock_m, 0.1);
    }
  }
}

TEST(CombinedAdjustment, AnyNumberOfLandmarksFromNone) {
  for (int landmarks = 0; landmarks <= 6; ++landmarks) {
    RangeScene scene;
    scene.AddSky(8, 0, kClock_m, kNoise);
    CameraScene camera(&scene);
    Random random(4);
    camera.AddWalls(landmarks, &random);
    const Combined combined = Combine(scene, camera);
    ASSERT_EQ(combined.status, PointStatus::kGood) << landmarks;
    const Eigen::Vector3d error = ErrorOf(scene, combined);
    const Eigen::Matrix3d information = combined.estimate.point.covariance_enu_m2.inverse();
    EXPECT_LT(error.dot(information * error), 16.0) << landmarks;
    EXPECT_EQ(combined.estimate.witness,
              landmarks == 0 ? WitnessVerdict::kNothing : WitnessVerdict::kUsed);
  }
}

TEST(CombinedAdjustment, NeitherAloneWouldDo) {
  RangeScene scene;
  scene.AddSatellite(20.0, 40.0, 0, kClock_m, kNoise);
  scene.AddSatellite(140.0, 55.0, 0, kClock_m, kNoise);
  scene.AddSatellite(260.0, 35.0, 0, kClock_m, kNoise);
  CameraScene camera(&scene);
  camera.AddLandmark({-20.0, 60.0, 3.0});
  camera.AddLandmark({15.0, 55.0, 12.0});
  Combined combined = Combine(scene, camera, {8.0, -5.0, 3.0});
  ASSERT_EQ(combined.status, PointStatus::kGood);
  EXPECT_FALSE(combined.estimate.has_satellites_alone);
  // Four measurements less the attitude leave one line; three satellites less the clock two.
  EXPECT_EQ(combined.group.At(scene.truth_in_ecef).Rank(50.0), 1);
  EXPECT_LT(ErrorOf(scene, combined).norm(), 1e-2);
}

// Xu et al., section 5.3: a single satellite only finds its own clock.
TEST(CombinedAdjustment, OneSatelliteAddsNothingAndTwoAddALine) {
  std::vector<double> traces;
  std::vector<Eigen::Matrix3d> informations;
  for (int satellites = 0; satellites <= 2; ++satellites) {
    RangeScene scene;
    scene.AddSky(satellites, 0, kClock_m, kNoise);
    CameraScene camera(&scene);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(-20.0, 60.0, 3.0), Eigen::Vector3d(15.0, 60.0, 12.0),
          Eigen::Vector3d(3.0, 45.0, 0.5), Eigen::Vector3d(-8.0, 80.0, 20.0)}) {
      camera.AddLandmark(point, 0.02);
    }
    const Combined combined = Combine(scene, camera);
    ASSERT_EQ(combined.status, PointStatus::kGood);
    traces.push_back(TraceOf(combined));
    informations.push_back(combined.estimate.point.information_pm2);
    if (satellites == 1) {
      EXPECT_FALSE(combined.verdicts[0].observable);
    }
  }
  EXPECT_NEAR(traces[1], traces[0], 1e-6 * traces[0]);
  EXPECT_LT(traces[2], traces[0]);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> added(informations[2] - informations[0]);
  EXPECT_GT(added.eigenvalues()[2], 1e-3);
  EXPECT_NEAR(added.eigenvalues()[0], 0.0, 0.05 * added.eigenvalues()[2]);
  EXPECT_NEAR(added.eigenvalues()[1], 0.0, 0.05 * added.eigenvalues()[2]);
}

TEST(CombinedAdjustment, OneBearingWithGravityAndHeadingHelpsSatellites) {
  RangeScene scene;
  scene.AddSky(5, 0, kClock_m, kNoise);
  CameraScene camera(&scene);
  const double without_m2 = TraceOf(Combine(scene, camera));
  camera.AddLandmark({5.0, 30.0, 10.0});
  AttitudePriors priors;
  priors.gravity = AttitudePriors::Gravity{{0.0, -1.0, 0.0}, 0.01};
  priors.heading = AttitudePriors::Heading{0.0, 0.1};
  const Combined with = Combine(scene, camera, {2.0, -2.0, 1.0}, priors);
  EXPECT_EQ(with.estimate.witness, WitnessVerdict::kUsed);
  EXPECT_LT(TraceOf(with), 0.6 * without_m2);
  EXPECT_LT(ErrorOf(scene, with).norm(), 1e-2);
}

// Errors in the units of their covariance, over draws with few satellites and few landmarks.
TEST(CombinedAdjustment, CovarianceHoldsWhatItSays) {
  for (const int satellites : {0, 2, 3, 8}) {
    constexpr int kDraws = 400;
    Random random(static_cast<std::uint64_t>(21 + satellites));
    double sum = 0.0;
    int within = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      RangeScene scene;
      scene.AddSky(satellites, 0, kClock_m, kNoise);
      for (RangeObservation& range : scene.ranges) {
        range.range_m += random.Gaussian(0.0, range.error.sigma_m);
      }
      CameraScene camera(&scene);
      camera.AddWalls(9, &random, 0.01);
      const Combined combined = Combine(scene, camera, Eigen::Vector3d::Zero());
      ASSERT_EQ(combined.status, PointStatus::kGood);
      const Eigen::Vector3d error = ErrorOf(scene, combined);
      const Eigen::Matrix3d covariance = combined.estimate.point.covariance_enu_m2;
      const double square = error.dot(covariance.inverse() * error);
      sum += square;
      within += square < 3.506 ? 1 : 0;  // holds 68 %
    }
    // The mean of chi-square with three degrees of freedom over 400 draws: sigma 0.122.
    EXPECT_NEAR(sum / kDraws, 3.0, 0.45) << satellites;
    EXPECT_NEAR(static_cast<double>(within) / kDraws, 0.68, 0.07) << satellites;
  }
}

TEST(CombinedAdjustment, FindsTheMistakenLandmarkAndTheReflectedSatellite) {
  Random random(31);
  int landmark_found = 0;
  int satellite_found = 0;
  constexpr int kDraws = 60;
  for (int draw = 0; draw < kDraws; ++draw) {
    RangeScene scene;
    scene.AddSky(7);
    for (RangeObservation& range : scene.ranges) range.range_m += random.Gaussian(0.0, 3.0);
    scene.ranges[4].range_m += 60.0;
    CameraScene camera(&scene);
    camera.AddWalls(10, &random);
    std::swap(camera.bearings[1].point_in_ecef, camera.bearings[6].point_in_ecef);
    const Combined combined = Combine(scene, camera);
    ASSERT_EQ(combined.status, PointStatus::kGood);
    EXPECT_LT(ErrorOf(scene, combined).norm(), 2.0);
    landmark_found += combined.group.WeightOf(1) < 0.1 && combined.group.WeightOf(6) < 0.1;
    satellite_found += combined.verdicts[4].weight < 0.1;
    const double horizontal_m = ErrorOf(scene, combined).head<2>().norm();
    EXPECT_LT(horizontal_m, combined.estimate.point.protection_level_m);
  }
  // Two landmarks that happen to lie close together may be taken for each other without harm.
  EXPECT_GE(landmark_found, kDraws - 2);
  EXPECT_EQ(satellite_found, kDraws);
}

// A photograph of another place, which agrees with itself.
TEST(CombinedAdjustment, AWrongPlaceDoesNoHarm) {
  for (const double away_m : {60.0, 300.0, 5000.0}) {
    RangeScene scene;
    scene.AddSky(8, 0, kClock_m, kNoise);
    Random random(17);
    for (RangeObservation& range : scene.ranges) range.range_m += random.Gaussian(0.0, 3.0);
    CameraScene camera(&scene);
    camera.AddWalls(12, &random);
    for (BearingObservation& bearing : camera.bearings) {
      bearing.point_in_ecef += scene.Beside({away_m, 0.0, 0.0}) - scene.truth_in_ecef;
    }
    const Combined combined = Combine(scene, camera, {away_m, 0.0, 0.0});
    ASSERT_EQ(combined.status, PointStatus::kGood);
    EXPECT_EQ(combined.estimate.witness, WitnessVerdict::kContradicted) << away_m;
    EXPECT_EQ(combined.estimate.point.position_in_ecef,
              combined.estimate.satellites_alone.position_in_ecef);
    EXPECT_LT(ErrorOf(scene, combined).norm(), 10.0);
  }
}

// Bearings that fit no place at all are of no use, and must not spoil what satellites say.
TEST(CombinedAdjustment, NonsenseDoesNoHarm) {
  Random random(19);
  for (int draw = 0; draw < 30; ++draw) {
    RangeScene scene;
    scene.AddSky(8, 0, kClock_m, kNoise);
    for (RangeObservation& range : scene.ranges) range.range_m += random.Gaussian(0.0, 3.0);
    CameraScene camera(&scene);
    camera.AddWalls(10, &random);
    for (BearingObservation& bearing : camera.bearings) {
      bearing.point_in_ecef = scene.Beside(
          {random.Uniform(-40.0, 40.0), random.Uniform(40.0, 90.0), random.Uniform(0.0, 20.0)});
    }
    const Combined combined = Combine(scene, camera);
    ASSERT_EQ(combined.status, PointStatus::kGood);
    const double alone_m =
        scene.ErrorInEnu(combined.estimate.satellites_alone.position_in_ecef).norm();
    EXPECT_LT(ErrorOf(scene, combined).norm(), alone_m + 5.0) << draw;
  }
}

TEST(CombinedAdjustment, SaysWhatIsNotObservable) {
  RangeScene scene;
  scene.AddSky(2, 0, kClock_m, kNoise);
  CameraScene camera(&scene);
  camera.AddLandmark({5.0, 60.0, 10.0});
  const Combined combined = Combine(scene, camera);
  EXPECT_NE(combined.status, PointStatus::kGood);
  RangeScene nothing;
  CameraScene dark(&nothing);
  EXPECT_EQ(Combine(nothing, dark).status, PointStatus::kTooFew);
}

}  // namespace
}  // namespace lodemark
