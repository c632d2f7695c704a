// What options and priors do to an answer, and that each names the field it objects to.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/capi/photo_scene.h"

namespace lodemark::test {
namespace {

const Eigen::Vector3d kForward = Eigen::Vector3d::UnitZ();  // of a camera
constexpr double kPlace[3] = {48.2, 16.37, 180.0};

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof(T);
  return value;
}

// How many signals of one epoch in a session with these options have each verdict.
struct Fared {
  int used = 0;
  int low = 0;
  int weak = 0;
  lodemark_estimate estimate = Sized<lodemark_estimate>();
};

Fared Fare(const lodemark_session_options& options, double elevation_sigma_factor = 0.0) {
  Fared fared;
  lodemark_session_options stated = options;
  stated.ionosphere = LODEMARK_IONOSPHERE_NONE;
  stated.troposphere = LODEMARK_TROPOSPHERE_NONE;
  if (elevation_sigma_factor > 0.0) {
    stated.weight = LODEMARK_WEIGHT_ELEVATION;
    stated.elevation_a_m = stated.elevation_b_m = elevation_sigma_factor;
  }
  lodemark_session* session = nullptr;
  EXPECT_EQ(lodemark_session_open(&stated, &session), LODEMARK_OK) << lodemark_last_error();
  const std::string navigation = Constellation::NavigationFile();
  EXPECT_EQ(lodemark_session_push_navigation(session, nullptr, navigation.data(), navigation.size(),
                                             nullptr),
            LODEMARK_OK);
  StillPhone phone(kPlace, 100.0);
  phone.Measure(Constellation::kReference_gps_ns);
  EXPECT_EQ(lodemark_session_push_gnss(session, 0, &phone.clock, phone.measurements.data(),
                                       phone.count()),
            LODEMARK_OK);
  EXPECT_GE(lodemark_session_process(session), 0);
  EXPECT_GE(lodemark_session_estimate(session, &fared.estimate), 0);
  std::vector<lodemark_satellite> satellites(64);
  satellites[0].struct_size = sizeof(lodemark_satellite);
  std::int32_t count = 0;
  EXPECT_EQ(lodemark_session_satellites(session, satellites.data(), 64, &count), LODEMARK_OK);
  for (int i = 0; i < count; ++i) {
    const std::int32_t verdict = satellites[static_cast<std::size_t>(i)].verdict;
    fared.used += verdict == LODEMARK_VERDICT_USED ? 1 : 0;
    fared.low += verdict == LODEMARK_VERDICT_LOW_ELEVATION ? 1 : 0;
    fared.weak += verdict == LODEMARK_VERDICT_WEAK_SIGNAL ? 1 : 0;
  }
  lodemark_session_close(session);
  return fared;
}

TEST(SessionOptions, AMaskLeavesLowSatellitesOut) {
  auto options = Sized<lodemark_session_options>();
  EXPECT_EQ(Fare(options).low, 0);
  options.elevation_mask_deg = 35.0;
  const Fared masked = Fare(options);
  EXPECT_GT(masked.low, 0);
  EXPECT_GT(masked.used, 0);
  options.elevation_mask_deg = -90.0;
  EXPECT_EQ(Fare(options).low, 0);
}

TEST(SessionOptions, ALimitOfTheSignalLeavesWeakOnesOut) {
  auto options = Sized<lodemark_session_options>();
  EXPECT_EQ(Fare(options).weak, 0);
  options.smallest_cn0_dbhz = 59.0;  // more than any has
  EXPECT_GT(Fare(options).weak, 0);
}

TEST(SessionOptions, WhoWeighsByElevationSaysHowMuchRangesErr) {
  auto options = Sized<lodemark_session_options>();
  options.seed = 7;
  options.queue_capacity = 3;
  const Fared good = Fare(options, 1.0);
  const Fared bad = Fare(options, 10.0);
  ASSERT_NE(good.estimate.present & LODEMARK_ESTIMATE_HAS_POSITION, 0u);
  ASSERT_NE(bad.estimate.present & LODEMARK_ESTIMATE_HAS_POSITION, 0u);
  EXPECT_GT(bad.estimate.accuracy_m, 3.0 * good.estimate.accuracy_m);
}

class Steered : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    path_ = new std::string(::testing::TempDir() + "steering_test_" + std::to_string(getpid()) +
                            ".map");
    scene_ = new PhotoScene(*path_);
    ASSERT_EQ(scene_->problem, "");
  }
  static void TearDownTestSuite() {
    std::remove(path_->c_str());
    delete scene_;
    delete path_;
  }
  Steered() {
    EXPECT_EQ(lodemark_map_open(path_->c_str(), &map_), LODEMARK_OK);
    sights_.resize(LODEMARK_LARGEST_COUNT);
    sights_[0] = Sized<lodemark_sight>();
  }
  ~Steered() override { lodemark_map_close(map_); }

  lodemark_status Query() {
    return lodemark_map_query(map_, &scene_->lens, scene_->photo.data(), scene_->lens.width_px,
                              nullptr, &query_, sights_.data(), LODEMARK_LARGEST_COUNT, &count_);
  }
  lodemark_status Resect() {
    pose_ = Sized<lodemark_pose>();
    return lodemark_pose_resect(&scene_->lens, sights_.data(), count_, nullptr, &resect_, &pose_,
                                nullptr, nullptr);
  }

  static std::string* path_;
  static PhotoScene* scene_;
  lodemark_map* map_ = nullptr;
  std::vector<lodemark_sight> sights_;
  std::int32_t count_ = 0;
  lodemark_query_options query_ = Sized<lodemark_query_options>();
  lodemark_resect_options resect_ = Sized<lodemark_resect_options>();
  lodemark_pose pose_ = {};
};
std::string* Steered::path_ = nullptr;
PhotoScene* Steered::scene_ = nullptr;

TEST_F(Steered, AQueryFindsNoMoreThanItIsToldTo) {
  ASSERT_EQ(Query(), LODEMARK_OK) << lodemark_last_error();
  const std::int32_t all = count_;
  ASSERT_GT(all, 100);
  query_.most_features = 60;
  ASSERT_EQ(Query(), LODEMARK_OK);
  EXPECT_GT(count_, 0);
  EXPECT_LE(count_, 60);
  query_ = Sized<lodemark_query_options>();
  query_.longest_side_px = 160;  // a quarter: the smallest features are gone
  ASSERT_EQ(Query(), LODEMARK_OK);
  EXPECT_LT(count_, all);
  query_.longest_side_px = -1;  // never scaled: as it is
  query_.lists_to_visit = 1'000'000;
  ASSERT_EQ(Query(), LODEMARK_OK);
  EXPECT_EQ(count_, all);
  query_.largest_ratio = 1e-9;  // nothing is so much nearer, but what fits exactly
  ASSERT_EQ(Query(), LODEMARK_OK);
  EXPECT_LE(count_, all);
}

TEST_F(Steered, AQueryNamesTheOptionThatMakesNoSense) {
  query_.most_features = -1;
  EXPECT_EQ(Query(), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "query_options.most_features is out of range");
  query_ = Sized<lodemark_query_options>();
  query_.largest_ratio = 1.5;
  EXPECT_EQ(Query(), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "query_options.largest_ratio is out of range");
}

TEST_F(Steered, AnUncertainLensMakesAnUncertainPose) {
  ASSERT_EQ(Query(), LODEMARK_OK);
  ASSERT_EQ(Resect(), LODEMARK_OK);
  const double known_m = pose_.accuracy_m;
  resect_.present = LODEMARK_RESECT_HAS_INTRINSICS_COVARIANCE;
  resect_.intrinsics_covariance[0] = 100.0;  // 10 px of the focal length, of 520
  resect_.intrinsics_covariance[LODEMARK_LENS_INTRINSICS + 1] = 100.0;
  resect_.inlier_threshold_px = 4.0;
  resect_.most_samples = 500;
  resect_.seed = 3;
  ASSERT_EQ(Resect(), LODEMARK_OK) << lodemark_last_error();
  EXPECT_GT(pose_.accuracy_m, 3.0 * known_m);
  EXPECT_LE(pose_.samples, 500);
  resect_.intrinsics_covariance[0] = NAN;
  EXPECT_EQ(Resect(), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "options.intrinsics_covariance is not finite");
}

TEST_F(Steered, AHeadingOfThePhotographIsTaken) {
  lodemark_session* session = nullptr;
  ASSERT_EQ(lodemark_session_open(nullptr, &session), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_use_map(session, map_), LODEMARK_OK);
  auto frame = Sized<lodemark_frame>();
  frame.time_ns = Constellation::kReference_gps_ns;
  frame.present = LODEMARK_FRAME_HAS_HEADING | LODEMARK_FRAME_HAS_GRAVITY;
  frame.up_in_camera[1] = -9.81;
  frame.up_sigma_deg = 1.0;
  frame.heading_deg = 5.0;
  frame.heading_sigma_deg = 10.0;
  ASSERT_EQ(lodemark_session_push_image(session, &frame, &scene_->lens, scene_->photo.data(),
                                        scene_->lens.width_px),
            LODEMARK_OK)
      << lodemark_last_error();
  ASSERT_EQ(lodemark_session_process(session), LODEMARK_OK);
  auto estimate = Sized<lodemark_estimate>();
  ASSERT_EQ(lodemark_session_estimate(session, &estimate), LODEMARK_OK);
  EXPECT_LT(std::hypot(estimate.ecef_m[0] - scene_->camera_in_ecef_m[0],
                       estimate.ecef_m[1] - scene_->camera_in_ecef_m[1],
                       estimate.ecef_m[2] - scene_->camera_in_ecef_m[2]),
            0.05);
  lodemark_session_close(session);
}

// Two leanings of a small board look alike: both are given, and no position.
TEST_F(Steered, ASmallFlatTargetHasTwoAnswers) {
  Random random(1);
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1.0, 0.4, 0).normalized()));
  count_ = 30;
  for (int i = 0; i < count_; ++i) {
    const double x_m = random.Uniform(-0.4, 0.4);
    const double y_m = random.Uniform(-0.4, 0.4);
    const Eigen::Vector3d in_camera = lean * Eigen::Vector3d(x_m, y_m, 0.0) + 10.0 * kForward;
    const double enu_m[3] = {kCamera_enu_m[0] + in_camera.x(), kCamera_enu_m[1] + in_camera.z(),
                             kCamera_enu_m[2] - in_camera.y()};
    lodemark_sight& sight = sights_[static_cast<std::size_t>(i)];
    sight = Sized<lodemark_sight>();
    lodemark_ecef_from_enu(kOrigin_geodetic, enu_m, sight.landmark_in_ecef_m);
    const lodemark_lens& lens = scene_->lens;
    sight.pixel_px[0] = lens.cx_px + lens.fx_px * in_camera.x() / in_camera.z();
    sight.pixel_px[1] = lens.cy_px + lens.fy_px * in_camera.y() / in_camera.z();
    sight.pixel_px[0] += random.Gaussian();
    sight.pixel_px[1] += random.Gaussian();
  }
  ASSERT_EQ(Resect(), LODEMARK_NO_POSITION) << lodemark_last_error();
  ASSERT_EQ(pose_.verdict, LODEMARK_POSE_AMBIGUOUS);
  const auto off_rad = [](const double(&q)[4]) {
    const double half = std::sqrt(0.5);  // level and to the north: a quarter turn about east
    return 2.0 * std::acos(std::min(1.0, std::abs(half * q[0] + half * q[1])));
  };
  const double one_rad = off_rad(pose_.camera_from_enu);
  const double other_rad = off_rad(pose_.alternative_camera_from_enu);
  EXPECT_LT(std::min(one_rad, other_rad), 0.2);
  EXPECT_GT(std::max(one_rad, other_rad), 0.5);
  EXPECT_NE(pose_.alternative_ecef_m[0], 0.0);
}

TEST(LensStep, RefusesMorePointsThanACallTakes) {
  auto lens = Sized<lodemark_lens>();
  lens.width_px = lens.height_px = 100;
  lens.fx_px = lens.fy_px = 100.0;
  const double pixel_px[2] = {50.0, 50.0};
  double direction[3];
  std::uint8_t valid = 0;
  EXPECT_EQ(
      lodemark_lens_unproject(&lens, pixel_px, LODEMARK_LARGEST_POINT_COUNT + 1, direction, &valid),
      LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "count is above LODEMARK_LARGEST_POINT_COUNT");
}

}  // namespace
}  // namespace lodemark::test
