#include "core/resection/mode_comparison.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "core/resection/resection.h"

namespace lodemark {
namespace {

// Twelve landmarks of a wall seen with an error of 2 px from its origin, looking north. Four of
// them agree within half a pixel with a camera 160 m away: they are no measure of the noise.
TEST(Compare, AFewThatAgreeCloselyDoNotOutdoManyThatAgree) {
  struct Seen {
    Eigen::Vector2d pixel;
    Eigen::Vector3d landmark_in_enu_m;
  };
  const Seen kSeen[] = {
      {{925.9, 500.1}, {20.8, 73.0, -1.4}},  {{469.2, 344.2}, {-13.6, 79.3, 11.0}},
      {{435.6, 327.3}, {-15.1, 74.2, 11.4}}, {{267.5, 545.9}, {-28.9, 78.7, -5.4}},
      {{779.9, 241.2}, {10.0, 70.2, 16.8}},  {{240.0, 235.6}, {-30.0, 74.5, 18.3}},
      {{402.5, 458.8}, {-16.8, 70.6, 1.5}},  {{286.5, 461.7}, {-26.5, 75.3, 1.3}},
      {{263.7, 570.5}, {-29.9, 79.6, -7.3}}, {{160.6, 472.7}, {-36.1, 74.6, 0.7}},
      {{265.6, 487.4}, {-29.4, 79.2, -0.8}}, {{359.8, 240.0}, {-20.8, 74.0, 17.8}},
  };
  std::vector<LandmarkSight> sights;
  for (const Seen& seen : kSeen) {
    LandmarkSight sight;
    sight.pixel = seen.pixel;
    sight.landmark_in_enu_m = seen.landmark_in_enu_m;
    sights.push_back(sight);
  }
  LensParameters parameters;
  parameters.width_px = 1280;
  parameters.height_px = 960;
  parameters.fx_px = parameters.fy_px = 1000.0;
  parameters.cx_px = 639.5;
  parameters.cy_px = 479.5;
  ResectionPriors priors;
  priors.gravity = GravityPrior{-Eigen::Vector3d::UnitY(), 0.01};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ResectionOptions options;
    options.seed = seed;
    const Result<ResectedPose> pose = Resect(sights, *Lens::Create(parameters), priors, options);
    ASSERT_TRUE(pose.ok());
    EXPECT_EQ(pose->verdict, PoseVerdict::kPose) << seed;
    EXPECT_EQ(pose->inliers, 12) << seed;
    EXPECT_LT(pose->centre_in_enu_m().norm(), 5.0) << seed;
  }
}

}  // namespace
}  // namespace lodemark
