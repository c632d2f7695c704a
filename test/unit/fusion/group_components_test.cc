#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/fusion/bearing_group.h"
#include "core/fusion/combined_adjustment.h"
#include "test/unit/fusion/camera_scene.h"
#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

// What is measured errs by so many times the sigmas that are stated.
struct Truth {
  double satellites = 1.0;
  double landmarks = 1.0;
  int ranges = 20;
  int bearings = 20;
};

struct Scales {
  CombinedEstimate estimate;
  Eigen::Vector3d error_enu_m = Eigen::Vector3d::Zero();
};

Scales Estimate(const Truth& truth, bool components, std::uint64_t seed) {
  Random random(seed);
  RangeScene scene;
  scene.AddSky(truth.ranges, 0, kClock_m, {3.0, 0.0, 30.0});
  for (RangeObservation& range : scene.ranges) {
    range.range_m += random.Gaussian(0.0, truth.satellites * 3.0);
  }
  CameraScene camera(&scene);
  for (int i = 0; i < truth.bearings; ++i) {
    const Eigen::Vector3d point(random.Uniform(-35.0, 35.0), random.Uniform(40.0, 70.0),
                                random.Uniform(-1.0, 18.0));
    camera.AddLandmark(point, 1e-2,
                       truth.landmarks * Eigen::Vector2d(random.Gaussian(), random.Gaussian()));
  }
  BearingGroup bearings;
  bearings.Set(camera.bearings, {}, camera.camera_from_ecef, {});
  CombinedOptions options;
  options.estimate_variance_components = components;
  options.point.posterior_mean = false;
  Scales scales;
  std::vector<ObservationVerdict> verdicts;
  CombinedAdjustment adjustment;
  EXPECT_EQ(adjustment.Solve(scene.ranges, scene.Beside({3.0, -4.0, 1.0}), ClockBiases(), options,
                             &bearings, &scales.estimate, &verdicts),
            PointStatus::kGood);
  scales.error_enu_m = scene.ErrorInEnu(scales.estimate.point.position_in_ecef);
  return scales;
}

struct Mean {
  double satellite_square = 0.0;  // of the factors
  double landmark_square = 0.0;
  double nees = 0.0;  // over 3
};

Mean Average(const Truth& truth, bool components) {
  constexpr int kDraws = 100;
  Mean mean;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const Scales scales = Estimate(truth, components, seed);
    const CombinedEstimate& estimate = scales.estimate;
    mean.satellite_square += std::pow(estimate.satellite_scale.sigma_factor, 2) / kDraws;
    mean.landmark_square += std::pow(estimate.landmark_scale.sigma_factor, 2) / kDraws;
    mean.nees +=
        scales.error_enu_m.dot(estimate.point.information_pm2 * scales.error_enu_m) / 3.0 / kDraws;
  }
  return mean;
}

TEST(GroupComponents, AreThoseThatTheErrorsWereDrawnWith) {
  for (const auto& [satellites, landmarks] :
       {std::pair(1.0, 1.0), std::pair(0.5, 1.0), std::pair(1.5, 0.4), std::pair(0.6, 1.6)}) {
    const Mean mean = Average({satellites, landmarks}, true);
    // Of 100 draws with 16 and 34 redundant residuals the mean is 3.5 % and 2.4 % off, 1 sigma.
    EXPECT_NEAR(mean.satellite_square / (satellites * satellites), 1.0, 0.12) << satellites;
    EXPECT_NEAR(mean.landmark_square / (landmarks * landmarks), 1.0, 0.1) << landmarks;
  }
}

TEST(GroupComponents, MakeTheStatedCovarianceHold) {
  const Truth truth = {0.5, 0.5};
  EXPECT_NEAR(Average(truth, false).nees, 0.25, 0.06);
  EXPECT_NEAR(Average(truth, true).nees, 1.0, 0.25);
}

TEST(GroupComponents, AreNotEstimatedUnlessAskedFor) {
  const CombinedEstimate estimate = Estimate({2.0, 2.0}, false, 1).estimate;
  EXPECT_FALSE(estimate.satellite_scale.estimated);
  EXPECT_FALSE(estimate.landmark_scale.estimated);
  EXPECT_EQ(estimate.satellite_scale.sigma_factor, 1.0);
}

TEST(GroupComponents, StayAsStatedWhereLittleIsRedundant) {
  for (const int ranges : {2, 5, 14}) {
    const CombinedEstimate estimate = Estimate({0.1, 0.5, ranges, 20}, true, 3).estimate;
    EXPECT_EQ(estimate.satellite_scale.estimated, ranges == 14) << ranges;
    if (ranges < 14) {
      EXPECT_EQ(estimate.satellite_scale.sigma_factor, 1.0);
    }
    EXPECT_LT(estimate.satellite_scale.redundancy, ranges);
    EXPECT_TRUE(estimate.landmark_scale.estimated);
  }
  const CombinedEstimate few = Estimate({0.5, 0.1, 20, 5}, true, 3).estimate;
  EXPECT_TRUE(few.satellite_scale.estimated);
  EXPECT_FALSE(few.landmark_scale.estimated);
  EXPECT_EQ(few.landmark_scale.sigma_factor, 1.0);
}

}  // namespace
}  // namespace lodemark
