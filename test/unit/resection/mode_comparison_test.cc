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
      {{925.863, 500.115}, {20.815, 72.997, -1.366}},
      {{469.215, 344.188}, {-13.583, 79.289, 10.981}},
      {{435.559, 327.338}, {-15.071, 74.189, 11.402}},
      {{267.517, 545.929}, {-28.881, 78.681, -5.441}},
      {{779.857, 241.208}, {10.042, 70.172, 16.822}},
      {{239.963, 235.589}, {-29.990, 74.546, 18.296}},
      {{402.497, 458.764}, {-16.777, 70.595, 1.509}},
      {{286.532, 461.738}, {-26.477, 75.314, 1.302}},
      {{263.695, 570.502}, {-29.916, 79.616, -7.277}},
      {{160.645, 472.672}, {-36.117, 74.648, 0.705}},
      {{265.554, 487.405}, {-29.415, 79.172, -0.830}},
      {{359.824, 239.981}, {-20.828, 74.016, 17.763}},
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
  priors.gravity = GravityPrior{{-0.012595, -0.999881, -0.008888}, 0.01};
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
