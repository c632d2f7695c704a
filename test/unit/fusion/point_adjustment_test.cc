#include "core/fusion/point_adjustment.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/fusion/coarse_position.h"
#include "test/unit/fusion/adjusted.h"

namespace lodemark {
namespace {

constexpr double kMillimetre_m = 1e-3;

// Where reflections are likely, the likeliest clock lies a little below the ranges even if they
// have no error at all.
constexpr RangeErrorModel kNoise = {3.0, 0.0, 20.0};

// A fixed pattern of noise, so that the laws are tried away from perfection.
void AddNoise(RangeScene* scene, double share, std::uint64_t seed = 3) {
  Random random(seed);
  for (RangeObservation& range : scene->ranges) {
    range.range_m += random.Gaussian(0.0, share * range.error.sigma_m);
  }
}

// Least squares with every range counting in full.
Eigen::Vector3d PlainLeastSquares(const RangeScene& scene) {
  Eigen::Vector4d state;
  state << scene.truth_in_ecef, kClock_m;
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const RangeObservation& range : scene.ranges) {
      const Eigen::Vector3d line = state.head<3>() - range.point_in_ecef;
      Eigen::Vector4d slope;
      slope << line.normalized(), 1.0;
      normal += slope * slope.transpose();
      right += slope * (range.range_m - line.norm() - state[3]);
    }
    state += normal.ldlt().solve(right);
  }
  return state.head<3>();
}

TEST(PointAdjustment, FindsTheTruthFromAHundredKilometresAway) {
  RangeScene scene;
  scene.AddSky(9, 0, kClock_m, kNoise);
  for (const Eigen::Vector3d& offset :
       {Eigen::Vector3d(1e5, 0.0, 0.0), Eigen::Vector3d(-6e4, 8e4, 0.0),
        Eigen::Vector3d(0.0, 0.0, -1e5)}) {
    const Adjusted adjusted = Adjust(scene, scene.Beside(offset));
    ASSERT_EQ(adjusted.status, PointStatus::kGood);
    EXPECT_LT(DistanceFromTruth(scene, adjusted), kMillimetre_m);
    EXPECT_NEAR(adjusted.estimate.clock_m, kClock_m, kMillimetre_m);
    EXPECT_EQ(adjusted.estimate.used, 9);
    EXPECT_EQ(adjusted.estimate.redundancy, 5);
  }
}

TEST(PointAdjustment, FindsTheTruthFromTheCoarsePositionAnywhere) {
  for (const double latitude_deg : {-90.0, -45.0, 0.0, 67.0, 90.0}) {
    for (const double longitude_deg : {-180.0, -70.0, 20.0, 150.0}) {
      RangeScene scene({latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, 50.0});
      scene.AddSky(8);
      const auto coarse = CoarsePosition(scene.ranges);
      ASSERT_TRUE(coarse.has_value());
      const Adjusted adjusted = Adjust(scene, *coarse);
      ASSERT_EQ(adjusted.status, PointStatus::kGood);
      EXPECT_LT(DistanceFromTruth(scene, adjusted), kMillimetre_m)
          << latitude_deg << " " << longitude_deg;
    }
  }
}

TEST(PointAdjustment, DoesNotDependOnTheStart) {
  RangeScene scene;
  scene.AddSky(11);
  AddNoise(&scene, 1.0);
  scene.ranges[3].range_m += 45.0;
  const Adjusted near = Adjust(scene, scene.truth_in_ecef);
  const Adjusted far = Adjust(scene, scene.Beside({5e4, 3e4, -1e4}));
  EXPECT_LT((near.estimate.position_in_ecef - far.estimate.position_in_ecef).norm(), 0.01);
}

// As ranges differ between processors, whose sines put a satellite some nanometres elsewhere.
TEST(PointAdjustment, MovesByNanometresWhereRangesDo) {
  PointOptions options;
  options.posterior_mean = false;
  Random random(7);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RangeScene scene;
    scene.AddSky(11);
    scene.AddSky(9, 3, kClock_m + 55.0);
    AddNoise(&scene, 1.0, seed);
    scene.ranges[3].range_m += 45.0;
    const Adjusted before = Adjust(scene, ClockBiases(), options);
    for (RangeObservation& range : scene.ranges) range.range_m += random.Uniform(-1e-8, 1e-8);
    const Adjusted after = Adjust(scene, ClockBiases(), options);
    EXPECT_LT((before.estimate.position_in_ecef - after.estimate.position_in_ecef).norm(), 1e-7)
        << seed;
  }
}

TEST(PointAdjustment, DoesNotDependOnTheOrder) {
  RangeScene scene;
  scene.AddSky(7);
  scene.AddSky(4, 3, kClock_m + 55.0);
  AddNoise(&scene, 1.0);
  scene.ranges[3].range_m += 45.0;
  const Adjusted before = Adjust(scene);
  RangeScene reversed = scene;
  std::reverse(reversed.ranges.begin(), reversed.ranges.end());
  const Adjusted after = Adjust(reversed);
  EXPECT_LT((before.estimate.position_in_ecef - after.estimate.position_in_ecef).norm(),
            kMillimetre_m);
  for (std::size_t i = 0; i < scene.ranges.size(); ++i) {
    const std::size_t j = scene.ranges.size() - 1 - i;
    EXPECT_NEAR(before.verdicts[i].weight, after.verdicts[j].weight, 1e-3);
  }
}

TEST(PointAdjustment, AConstantInAllRangesIsTheClock) {
  RangeScene scene;
  scene.AddSky(8);
  AddNoise(&scene, 0.7);
  const Adjusted before = Adjust(scene);
  for (RangeObservation& range : scene.ranges) range.range_m += 2.5e5;
  const Adjusted after = Adjust(scene);
  EXPECT_LT((before.estimate.position_in_ecef - after.estimate.position_in_ecef).norm(),
            kMillimetre_m);
  EXPECT_NEAR(after.estimate.clock_m - before.estimate.clock_m, 2.5e5, kMillimetre_m);
}

TEST(PointAdjustment, MovesWithTheWorld) {
  RangeScene scene;
  scene.AddSky(8);
  AddNoise(&scene, 0.7);
  const Adjusted before = Adjust(scene);
  // Turned around the axis of the earth: the ellipsoid stays, everything else turns.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  RangeScene turned = scene;
  for (RangeObservation& range : turned.ranges) range.point_in_ecef = turn * range.point_in_ecef;
  const Adjusted after = Adjust(turned, turn * scene.Beside({700.0, -600.0, 400.0}));
  EXPECT_LT((turn * before.estimate.position_in_ecef - after.estimate.position_in_ecef).norm(),
            kMillimetre_m);
  EXPECT_LT((before.estimate.covariance_enu_m2 - after.estimate.covariance_enu_m2).norm(), 1e-3);
}

TEST(PointAdjustment, ALongerLandmarkRangePushesAway) {
  RangeScene scene;
  for (int i = 0; i < 5; ++i) scene.AddLandmark(72.0 * i, 60.0, i % 2 == 0 ? 35.0 : -10.0, 0.5);
  const Adjusted before = Adjust(scene, scene.Beside({5.0, 5.0, 5.0}));
  ASSERT_EQ(before.status, PointStatus::kGood);
  EXPECT_LT(DistanceFromTruth(scene, before), kMillimetre_m);
  scene.ranges[0].range_m += 0.3;  // the landmark in the north
  const Adjusted after = Adjust(scene, scene.Beside({5.0, 5.0, 5.0}));
  const Eigen::Vector3d moved = scene.ErrorInEnu(after.estimate.position_in_ecef);
  EXPECT_LT(moved.y(), -0.02);
  EXPECT_GT(moved.y(), -0.3);
}

TEST(PointAdjustment, MixesSatellitesAndLandmarks) {
  RangeScene scene;
  scene.AddSky(5);
  scene.AddLandmark(30.0, 80.0, 10.0);
  scene.AddLandmark(160.0, 40.0, -5.0);
  const Adjusted adjusted = Adjust(scene);
  ASSERT_EQ(adjusted.status, PointStatus::kGood);
  EXPECT_LT(DistanceFromTruth(scene, adjusted), kMillimetre_m);
  EXPECT_EQ(adjusted.estimate.redundancy, 3);
  // The landmarks, ten times better, decide where they can.
  RangeScene satellites;
  satellites.AddSky(5);
  EXPECT_LT(adjusted.estimate.covariance_enu_m2.trace(),
            0.5 * Adjust(satellites).estimate.covariance_enu_m2.trace());
}

TEST(PointAdjustment, TwoSatellitesAndTwoLandmarksSuffice) {
  RangeScene scene;
  scene.AddSatellite(10.0, 60.0, 0, kClock_m, kNoise);
  scene.AddSatellite(200.0, 25.0, 0, kClock_m, kNoise);
  scene.AddLandmark(90.0, 70.0, 20.0);
  scene.AddLandmark(0.0, 50.0, -10.0);
  const Adjusted adjusted = Adjust(scene, scene.Beside({10.0, -10.0, 5.0}));
  ASSERT_EQ(adjusted.status, PointStatus::kGood);
  EXPECT_EQ(adjusted.estimate.redundancy, 0);
  EXPECT_LT(DistanceFromTruth(scene, adjusted), kMillimetre_m);
}

TEST(PointAdjustment, EstimatesABiasNobodyKnew) {
  RangeScene scene;
  scene.AddSky(6, 0, kClock_m, kNoise);
  scene.AddSky(4, 2, kClock_m - 2358.0, kNoise);
  const Adjusted adjusted = Adjust(scene);
  ASSERT_EQ(adjusted.status, PointStatus::kGood);
  EXPECT_LT(DistanceFromTruth(scene, adjusted), kMillimetre_m);
  EXPECT_EQ(adjusted.estimate.redundancy, 5);
  EXPECT_EQ(adjusted.estimate.groups_seen, 0b101u);
  EXPECT_NEAR(adjusted.estimate.biases[2].mean_m, -2358.0, kMillimetre_m);
  EXPECT_LT(adjusted.estimate.biases[2].sigma_m, 10.0);
  EXPECT_NEAR(adjusted.estimate.clock_m, kClock_m, kMillimetre_m);
}

TEST(PointAdjustment, UsesALoneRangeWhoseBiasWasLearned) {
  RangeScene scene;
  scene.AddSky(5);
  scene.AddSatellite(250.0, 33.0, 2, kClock_m - 2358.0);
  ClockBiases biases;
  biases.Set(2, {-2358.0, 0.5});
  const Adjusted with = Adjust(scene, biases);
  ASSERT_EQ(with.status, PointStatus::kGood);
  EXPECT_LT(DistanceFromTruth(scene, with), 10.0 * kMillimetre_m);
  EXPECT_EQ(with.estimate.redundancy, 2);
  EXPECT_TRUE(with.verdicts[5].observable);
  const Adjusted without = Adjust(scene);
  EXPECT_EQ(without.estimate.redundancy, 1);
  EXPECT_LT(with.estimate.covariance_enu_m2.trace(),
            0.95 * without.estimate.covariance_enu_m2.trace());
}

TEST(PointAdjustment, FlagsTheLoneRangeOfAnUnknownClock) {
  for (const int lone : {0, 2}) {
    const int many = 2 - lone;
    RangeScene scene;
    scene.AddSky(6, many);
    scene.AddSatellite(250.0, 33.0, lone, kClock_m - 2358.0);
    const Adjusted adjusted = Adjust(scene);
    ASSERT_EQ(adjusted.status, PointStatus::kGood);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(adjusted.verdicts[i].observable);
    EXPECT_FALSE(adjusted.verdicts[6].observable) << "group " << lone;
  }
}

// Not even where the posterior is sampled with its clock held.
TEST(PointAdjustment, ALoneRangeOfAnUnknownClockTellsNothing) {
  RangeScene scene;
  scene.AddSky(8, 0, kClock_m, {3.0, 0.3, 30.0});
  AddNoise(&scene, 1.0);
  scene.ranges[2].range_m += 12.0;
  const Adjusted without = Adjust(scene);
  for (int group = 1; group < 6; ++group) {
    scene.AddSatellite(60.0 * group, 25.0, group, kClock_m - 2358.0);
  }
  const Adjusted with = Adjust(scene);
  ASSERT_EQ(with.status, PointStatus::kGood);
  EXPECT_LT((with.estimate.position_in_ecef - without.estimate.position_in_ecef).norm(), 1.0);
  EXPECT_GT(with.estimate.covariance_enu_m2.trace(),
            0.8 * without.estimate.covariance_enu_m2.trace());
  EXPECT_LT(with.estimate.covariance_enu_m2.trace(),
            1.05 * without.estimate.covariance_enu_m2.trace());
}

TEST(PointAdjustment, FourSatellitesOfTwoSystemsNeedTheBias) {
  RangeScene scene;
  scene.AddSatellite(20.0, 70.0);
  scene.AddSatellite(110.0, 25.0);
  scene.AddSatellite(230.0, 30.0, 1, kClock_m + 77.0);
  scene.AddSatellite(320.0, 20.0, 1, kClock_m + 77.0);
  EXPECT_EQ(Adjust(scene).status, PointStatus::kTooFew);
  ClockBiases biases;
  biases.Set(1, {77.0, 1.0});
  const Adjusted adjusted = Adjust(scene, biases);
  ASSERT_EQ(adjusted.status, PointStatus::kGood);
  EXPECT_EQ(adjusted.estimate.redundancy, 0);
  EXPECT_LT(DistanceFromTruth(scene, adjusted), 10.0 * kMillimetre_m);
}

TEST(PointAdjustment, TooFewIsTooFew) {
  RangeScene scene;
  EXPECT_EQ(Adjust(scene).status, PointStatus::kTooFew);
  scene.AddSky(3);
  EXPECT_EQ(Adjust(scene).status, PointStatus::kTooFew);
  PointOptions options;
  options.height = HeightPrior{180.0, 5.0};
  EXPECT_EQ(Adjust(scene, ClockBiases(), options).status, PointStatus::kGood);
}

TEST(PointAdjustment, HoldsTheHeightItIsTold) {
  RangeScene scene;
  scene.AddSky(7);
  AddNoise(&scene, 1.0);
  PointOptions options;
  options.height = HeightPrior{180.0, 0.05};
  const Adjusted adjusted = Adjust(scene, ClockBiases(), options);
  ASSERT_EQ(adjusted.status, PointStatus::kGood);
  EXPECT_NEAR(scene.ErrorInEnu(adjusted.estimate.position_in_ecef).z(), 0.0, 0.2);
  EXPECT_LT(std::sqrt(adjusted.estimate.covariance_enu_m2(2, 2)), 0.2);
  EXPECT_EQ(adjusted.estimate.redundancy, 4);
}

TEST(PointAdjustment, ReflectionsMoveItLittle) {
  RangeScene scene;
  scene.AddSky(10);
  AddNoise(&scene, 0.5);
  const double clean_m = DistanceFromTruth(scene, Adjust(scene));
  for (const std::size_t late : {2u, 5u, 7u}) scene.ranges[late].range_m += 60.0;
  const Adjusted adjusted = Adjust(scene);
  ASSERT_EQ(adjusted.status, PointStatus::kGood);
  EXPECT_LT(DistanceFromTruth(scene, adjusted), clean_m + 6.0);
  EXPECT_GT((PlainLeastSquares(scene) - scene.truth_in_ecef).norm(), 40.0);
  for (const std::size_t late : {2u, 5u, 7u}) {
    EXPECT_FALSE(adjusted.verdicts[late].used);
    EXPECT_GT(adjusted.verdicts[late].late_share, 0.9);
    EXPECT_NEAR(adjusted.verdicts[late].residual_m, 60.0, 15.0);
  }
}

TEST(PointAdjustment, GrossErrorsDoNotMoveIt) {
  RangeScene scene;
  scene.AddSky(15);
  for (std::size_t i = 0; i < 5; ++i) scene.ranges[3 * i].range_m += i % 2 == 0 ? 5e5 : -5e5;
  const Adjusted adjusted = Adjust(scene);
  ASSERT_EQ(adjusted.status, PointStatus::kGood);
  EXPECT_LT(DistanceFromTruth(scene, adjusted), 0.3);
  EXPECT_EQ(adjusted.estimate.used, 10);
}

// However much it pulls, and wherever it stands in the sky.
TEST(PointAdjustment, OneGrossErrorNeverMovesIt) {
  Random random(290);
  int moved = 0;
  for (int trial = 0; trial < 500; ++trial) {
    RangeScene scene;
    for (int i = 0; i < 12; ++i) {
      scene.AddSatellite(30.0 * i + random.Uniform(-15.0, 15.0),
                         i % 3 == 0 ? random.Uniform(40.0, 90.0) : random.Uniform(10.0, 60.0));
    }
    AddNoise(&scene, 1.0, 1000 + static_cast<std::uint64_t>(trial));
    const double size_m = std::exp(random.Uniform(std::log(50.0), std::log(1e6)));
    scene.ranges[random.Index(12)].range_m += trial % 2 == 0 ? size_m : -size_m;
    const Adjusted adjusted = Adjust(scene);
    const double sigma_m = std::sqrt(adjusted.estimate.covariance_enu_m2.trace());
    if (adjusted.status != PointStatus::kGood ||
        DistanceFromTruth(scene, adjusted) > 10.0 + 4.0 * sigma_m) {
      ++moved;
    }
  }
  EXPECT_EQ(moved, 0);
}

TEST(PointAdjustment, SaysWhereAllRangesAreNonsense) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    RangeScene scene;
    scene.AddSky(10);
    for (RangeObservation& range : scene.ranges) range.range_m += random.Uniform(-1e6, 1e6);
    const Adjusted adjusted = Adjust(scene);
    EXPECT_TRUE(adjusted.status == PointStatus::kInconsistent ||
                adjusted.status == PointStatus::kNotConverged)
        << trial << " " << adjusted.estimate.used;
  }
}

TEST(PointAdjustment, SaysWhereTheGeometryFixesNothing) {
  RangeScene scene;
  for (int i = 0; i < 8; ++i) scene.AddSatellite(120.0, 40.0);
  const Adjusted adjusted = Adjust(scene);
  if (adjusted.status == PointStatus::kGood) {
    EXPECT_GT(adjusted.estimate.covariance_enu_m2.trace(), 1e8);
  }
}

TEST(PointAdjustment, AGoodAnswerIsFinite) {
  Random random(17);
  int good = 0;
  for (int trial = 0; trial < 100; ++trial) {
    RangeScene scene;
    const int count = 4 + static_cast<int>(random.Index(9));
    for (int i = 0; i < count; ++i) {
      const int group = static_cast<int>(random.Index(3));
      scene.AddSatellite(random.Uniform(0.0, 360.0), random.Uniform(5.0, 90.0), group,
                         kClock_m + 100.0 * group,
                         {std::exp(random.Uniform(-2.0, 6.0)), random.Uniform(0.0, 0.9),
                          random.Uniform(8.0, 60.0)});
      scene.ranges.back().range_m += random.Gaussian(0.0, 20.0);
    }
    const Adjusted adjusted = Adjust(scene);
    if (adjusted.status != PointStatus::kGood) continue;
    ++good;
    const PointEstimate& estimate = adjusted.estimate;
    EXPECT_TRUE(estimate.position_in_ecef.allFinite());
    EXPECT_TRUE(estimate.covariance_enu_m2.allFinite());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(estimate.covariance_enu_m2)
                  .eigenvalues()
                  .minCoeff(),
              0.0);
    for (const double value :
         {estimate.clock_m, estimate.clock_variance_m2, estimate.hdop, estimate.vdop, estimate.pdop,
          estimate.tdop, estimate.protection_level_m, estimate.vertical_protection_level_m}) {
      EXPECT_TRUE(std::isfinite(value));
    }
  }
  EXPECT_GT(good, 40);
}

TEST(PointAdjustment, RemembersNothingOfTheEpochBefore) {
  RangeScene first;
  first.AddSky(12);
  AddNoise(&first, 1.0);
  first.ranges[2].range_m += 33.0;
  RangeScene second;
  second.AddSky(6, 0, kClock_m, {2.0, 0.3, 40.0});
  AddNoise(&second, 1.0, 9);
  second.ranges[1].range_m += 50.0;
  PointAdjustment adjustment;
  PointEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  const Eigen::Vector3d start = first.Beside({100.0, 0.0, 0.0});
  adjustment.Solve(first.ranges, start, ClockBiases(), PointOptions(), &estimate, &verdicts);
  adjustment.Solve(second.ranges, start, ClockBiases(), PointOptions(), &estimate, &verdicts);
  const Adjusted fresh = Adjust(second, start);
  EXPECT_EQ(estimate.position_in_ecef, fresh.estimate.position_in_ecef);
  EXPECT_EQ(estimate.covariance_enu_m2, fresh.estimate.covariance_enu_m2);
  EXPECT_EQ(verdicts.size(), second.ranges.size());
}

TEST(PointAdjustment, DrawsAsManySamplesAsAskedNow) {
  RangeScene scene;
  scene.AddSky(8, 0, kClock_m, {3.0, 0.4, 30.0});
  AddNoise(&scene, 1.0);
  scene.ranges[1].range_m += 20.0;
  PointOptions few;
  few.posterior_samples = 64;
  PointAdjustment adjustment;
  PointEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  const Eigen::Vector3d start = scene.Beside({100.0, 0.0, 0.0});
  adjustment.Solve(scene.ranges, start, ClockBiases(), few, &estimate, &verdicts);
  adjustment.Solve(scene.ranges, start, ClockBiases(), PointOptions(), &estimate, &verdicts);
  EXPECT_EQ(estimate.position_in_ecef, Adjust(scene, start).estimate.position_in_ecef);
}

}  // namespace
}  // namespace lodemark
