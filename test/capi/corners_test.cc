// The less usual ways through the interface: what callers leave out, state needlessly or state just
// beyond what is taken.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "core/capi/eyes.h"
#include "core/capi/last_error.h"
#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/capi/photo_scene.h"

namespace lodemark::test {
namespace {

constexpr lodemark_status kInvalid = LODEMARK_ERROR_INVALID_ARGUMENT;
constexpr double kPlace[3] = {48.2, 16.37, 180.0};

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof(T);
  return value;
}

lodemark_lens Pinhole() {
  auto lens = Sized<lodemark_lens>();
  lens.width_px = 640;
  lens.height_px = 480;
  lens.fx_px = lens.fy_px = 500.0;
  lens.cx_px = 319.5;
  lens.cy_px = 239.5;
  return lens;
}

TEST(CopyText, LeavesNothingOfATextThatIsNoUtf8) {
  char out[4] = {'x', 'x', 'x', 'x'};
  CopyText("\x80\x80\x80\x80\x80", 5, out, sizeof out);
  EXPECT_EQ(std::string(out, sizeof out), std::string(4, '\0'));
}

TEST(LensStep, RefusesPointsThatAreTooFarAway) {
  const lodemark_lens lens = Pinhole();
  const double point[3] = {0.0, 0.0, 1e10};
  double pixel[2] = {};
  std::uint8_t valid = 0;
  EXPECT_EQ(lodemark_lens_project(&lens, point, 1, pixel, &valid), kInvalid);
  EXPECT_STREQ(lodemark_last_error(), "points[0] is out of range");
  EXPECT_EQ(lodemark_lens_project(nullptr, point, 1, pixel, &valid), kInvalid);
}

TEST(LensStep, MarksPointsBehindTheCameraAndPixelsOfNothing) {
  const lodemark_lens lens = Pinhole();
  const double behind[3] = {0.0, 0.0, -1.0};
  double pixel[2] = {7.0, 7.0};
  std::uint8_t valid = 7;
  EXPECT_EQ(lodemark_lens_project(&lens, behind, 1, pixel, &valid), LODEMARK_OK);
  EXPECT_EQ(valid, 0);
  EXPECT_EQ(pixel[0], 0.0);

  lodemark_lens folding = Pinhole();
  folding.model = LODEMARK_LENS_BROWN;
  folding.coefficients[0] = -0.5;
  const double far_off[2] = {319.5 + 350.0, 239.5};
  EXPECT_EQ(lodemark_lens_undistort_points(&folding, far_off, 1, pixel, &valid), LODEMARK_OK);
  EXPECT_EQ(valid, 0);
  EXPECT_EQ(pixel[0], 0.0);
}

TEST(UndistortionStep, RefusesImagesThatAreTooWide) {
  lodemark_lens wide = Pinhole();
  wide.width_px = 40'000;
  wide.cx_px = 20'000.0;
  lodemark_undistortion* undistortion = nullptr;
  EXPECT_EQ(lodemark_undistortion_open(&wide, nullptr, nullptr, &undistortion),
            LODEMARK_ERROR_UNSUPPORTED);
  EXPECT_EQ(undistortion, nullptr);
}

TEST(UndistortionStep, RefusesRowsOfGigabytes) {
  const lodemark_lens lens = Pinhole();
  lodemark_undistortion* undistortion = nullptr;
  ASSERT_EQ(lodemark_undistortion_open(&lens, nullptr, nullptr, &undistortion), LODEMARK_OK);
  std::uint8_t pixel = 0;
  EXPECT_EQ(lodemark_undistortion_apply(undistortion, &pixel, INT64_MAX, &pixel, 640), kInvalid);
  lodemark_undistortion_close(undistortion);
}

class Priors : public ::testing::Test {
 protected:
  Priors() {
    lodemark_ecef_from_geodetic(kPlace, prior_.position_in_ecef_m);
    for (int i = 0; i < 9; i += 4) prior_.position_covariance_enu_m2[i] = 25.0;
    prior_.up_in_camera[1] = -9.8;
    prior_.up_sigma_deg = 1.0;
    prior_.heading_sigma_deg = 10.0;
    prior_.camera_from_enu[0] = 1.0;
  }

  lodemark_status Resect() {
    const lodemark_lens lens = Pinhole();
    auto pose = Sized<lodemark_pose>();
    auto residual = Sized<lodemark_sight_residual>();
    return lodemark_pose_resect(&lens, nullptr, 0, &prior_, nullptr, &pose, &residual, nullptr);
  }

  lodemark_view_prior prior_ = Sized<lodemark_view_prior>();
};

TEST_F(Priors, MayBeOfAnyParts) {
  constexpr std::uint32_t kParts[] = {
      0,
      LODEMARK_VIEW_HAS_GRAVITY,
      LODEMARK_VIEW_HAS_POSITION,
      LODEMARK_VIEW_HAS_POSITION | LODEMARK_VIEW_HAS_HEADING,
      LODEMARK_VIEW_HAS_POSITION | LODEMARK_VIEW_HAS_ORIENTATION,
  };
  for (const std::uint32_t parts : kParts) {
    for (const double value : {0.0, 50.0}) {
      prior_.present = parts;
      prior_.farthest_m = prior_.search_radius_px = value;
      EXPECT_EQ(Resect(), LODEMARK_NO_POSITION) << parts << ": " << lodemark_last_error();
    }
  }
}

TEST_F(Priors, AreOnTheGroundAndTurnsHaveUnitLength) {
  prior_.present = LODEMARK_VIEW_HAS_POSITION | LODEMARK_VIEW_HAS_ORIENTATION;
  for (const double norm : {0.4, 2.1}) {
    prior_.camera_from_enu[0] = norm;
    EXPECT_EQ(Resect(), kInvalid) << norm;
  }
  prior_.camera_from_enu[0] = 1.0;
  for (const double radius_m : {6.2e6, 6.6e6}) {
    prior_.position_in_ecef_m[0] = radius_m;
    prior_.position_in_ecef_m[1] = prior_.position_in_ecef_m[2] = 0.0;
    EXPECT_EQ(Resect(), kInvalid) << radius_m;
  }
  prior_.struct_size = 8;
  EXPECT_EQ(Resect(), kInvalid);
}

class Sky : public ::testing::Test {
 protected:
  void Open(const lodemark_session_options& options) {
    ASSERT_EQ(lodemark_session_open(&options, &session_), LODEMARK_OK) << lodemark_last_error();
  }
  ~Sky() override { lodemark_session_close(session_); }

  lodemark_session* session_ = nullptr;
};

TEST_F(Sky, IsLookedAtForTheSystemsThatAreAskedFor) {
  auto options = Sized<lodemark_session_options>();
  options.systems = 1u << LODEMARK_SYSTEM_GALILEO;
  Open(options);
  StillPhone phone(kPlace, 0.0);
  phone.Measure(Constellation::kReference_gps_ns);
  phone.clock.present |= LODEMARK_CLOCK_HAS_LEAP_SECOND;
  phone.clock.leap_second = 18;
  ASSERT_EQ(lodemark_session_push_gnss(session_, 0, &phone.clock, phone.measurements.data(),
                                       phone.count()),
            LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NO_POSITION);
  std::vector<lodemark_satellite> satellites(64, Sized<lodemark_satellite>());
  std::int32_t count = 0;
  ASSERT_EQ(lodemark_session_satellites(session_, satellites.data(), 64, &count), LODEMARK_OK);
  ASSERT_EQ(count, phone.count());
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(satellites[static_cast<std::size_t>(i)].verdict, LODEMARK_VERDICT_SYSTEM_OFF);
  }
}

TEST_F(Sky, HasSignalsThatNobodyKnows) {
  Open(Sized<lodemark_session_options>());
  StillPhone phone(kPlace, 0.0);
  phone.Measure(Constellation::kReference_gps_ns);
  phone.measurements[0].carrier_frequency_hz = 1.0e9;
  phone.measurements[0].present |= LODEMARK_MEASUREMENT_HAS_CARRIER_FREQUENCY;
  ASSERT_EQ(lodemark_session_push_gnss(session_, 0, &phone.clock, phone.measurements.data(), 1),
            LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NO_POSITION);
  auto satellite = Sized<lodemark_satellite>();
  std::int32_t count = 0;
  ASSERT_EQ(lodemark_session_satellites(session_, &satellite, 1, &count), LODEMARK_OK);
  ASSERT_EQ(count, 1);
  EXPECT_EQ(satellite.verdict, LODEMARK_VERDICT_UNKNOWN_SIGNAL);
  EXPECT_STREQ(satellite.signal, "");
}

TEST_F(Sky, TakesSignalsWithoutAnAttributeAndOfAStatedFrequency) {
  Open(Sized<lodemark_session_options>());
  auto epoch = Sized<lodemark_observation_epoch>();
  epoch.time_gps_ns = Constellation::kReference_gps_ns;
  auto observation = Sized<lodemark_observation>();
  observation.satellite = 5;
  observation.signal[0] = '1';
  observation.frequency_hz = 1575.42e6;
  observation.present = LODEMARK_OBSERVATION_HAS_PSEUDORANGE;
  observation.pseudorange_m = 2.2e7;
  const auto push = [&] {
    return lodemark_session_push_observations(session_, 0, &epoch, &observation, 1);
  };
  ASSERT_EQ(push(), LODEMARK_OK) << lodemark_last_error();
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NO_POSITION);
  auto satellite = Sized<lodemark_satellite>();
  std::int32_t count = 0;
  ASSERT_EQ(lodemark_session_satellites(session_, &satellite, 1, &count), LODEMARK_OK);
  EXPECT_STREQ(satellite.signal, "1");
  EXPECT_EQ(satellite.present & LODEMARK_SATELLITE_HAS_CN0, 0u);
  for (const char* bad : {":C", "1!", "1[", "1CC"}) {
    std::memcpy(observation.signal, bad, std::strlen(bad) + 1);
    EXPECT_EQ(push(), kInvalid) << bad;
  }
}

TEST_F(Sky, FilesNeedNoName) {
  Open(Sized<lodemark_session_options>());
  const std::string text = "no orbits";
  for (const char* name : {static_cast<const char*>(nullptr), "named"}) {
    EXPECT_EQ(
        lodemark_session_push_precise_orbits(session_, name, text.data(), text.size(), nullptr),
        LODEMARK_ERROR_BAD_DATA);
    EXPECT_EQ(lodemark_session_push_navigation(session_, name, text.data(), text.size(), nullptr),
              LODEMARK_ERROR_BAD_DATA);
  }
}

TEST_F(Sky, IsSmoothedOnlyIfAskedFor) {
  std::int32_t count = -1;
  EXPECT_EQ(lodemark_session_smoothed(nullptr, nullptr, 0, &count), kInvalid);
  Open(Sized<lodemark_session_options>());
  EXPECT_EQ(lodemark_session_smoothed(session_, nullptr, 0, &count), LODEMARK_OK);
  EXPECT_EQ(count, 0);
}

TEST(PositionSolve, NeedsNoResidualsWhereThereIsNoRange) {
  auto solution = Sized<lodemark_solution>();
  lodemark_range_residual residual = {};
  EXPECT_EQ(lodemark_position_solve(nullptr, 0, nullptr, &solution, &residual),
            LODEMARK_NO_POSITION);
}

// Rows of a text that the session has no use for.
TEST(Log, PassesMessagesWithoutBytesAndEpochsWithoutTheTimeSinceBoot) {
  const std::string path = testing::TempDir() + "corners." + std::to_string(::getpid()) + ".txt";
  std::string text =
      "# Raw,TimeNanos,FullBiasNanos,Svid,State,ReceivedSvTimeNanos,ConstellationType\n";
  for (int i = 0; i < 10'050; ++i) text += "Nav,3,257,1,1,1,34,34,34\n";
  text += "Nav,3,257,1,1,1\nRaw,1000000000,-1400000000000000000,5,16431,1000000,1\n";
  std::ofstream(path, std::ios::binary) << text;
  lodemark_log* log = nullptr;
  lodemark_session* session = nullptr;
  ASSERT_EQ(lodemark_log_open(path.c_str(), &log), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_open(nullptr, &session), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log, session), LODEMARK_OK) << lodemark_last_error();
  EXPECT_EQ(lodemark_log_push_next(log, session), LODEMARK_END_OF_LOG);
  lodemark_log_close(log);
  lodemark_session_close(session);
  std::remove(path.c_str());
}

// The heading of a camera whose axis is a plumb line is the one that it had before it was tilted.
TEST(Pose, LookingStraightDownHasAHeadingToo) {
  const EnuFrame frame({0.84, 0.29, 180.0});
  ResectedPose found;
  found.verdict = PoseVerdict::kWeak;
  EXPECT_TRUE(HasPose(found.verdict));
  EXPECT_FALSE(HasPose(PoseVerdict::kNotHere));
  for (const double up : {1.0, -1.0}) {
    // x east; the axis went up, or down, from the north.
    Eigen::Matrix3d camera_from_enu;
    camera_from_enu << 1.0, 0.0, 0.0, 0.0, up, 0.0, 0.0, 0.0, up;
    const Eigen::Quaterniond turn(camera_from_enu);
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Quaterniond signed_turn(sign * turn.coeffs());
      found.camera_from_enu = Rigid3(signed_turn, Eigen::Vector3d::Zero());
      const lodemark_pose pose = ToC(found, LensParameters(), frame);
      EXPECT_NEAR(std::abs(pose.pitch_deg), 90.0, 1e-4);
      EXPECT_GE(pose.camera_from_enu[0], 0.0);
      EXPECT_NEAR(std::abs(std::remainder(pose.heading_deg, 360.0)), 0.0, 1e-3);
    }
  }
}

TEST(Pose, IsNotSoughtWithoutALens) {
  auto pose = Sized<lodemark_pose>();
  EXPECT_EQ(lodemark_pose_resect(nullptr, nullptr, 0, nullptr, nullptr, &pose, nullptr, nullptr),
            kInvalid);
}

TEST(Map, IsAskedAboutPhotographsOfPlausibleRows) {
  const std::string path = testing::TempDir() + "corners." + std::to_string(::getpid()) + ".map";
  const PhotoScene scene(path);
  ASSERT_EQ(scene.problem, "");
  lodemark_map* map = nullptr;
  lodemark_session* session = nullptr;
  ASSERT_EQ(lodemark_map_open(path.c_str(), &map), LODEMARK_OK);
  auto options = Sized<lodemark_session_options>();
  options.flags = LODEMARK_SESSION_VARIANCE_COMPONENTS;
  options.ionosphere = LODEMARK_IONOSPHERE_NONE;
  options.troposphere = LODEMARK_TROPOSPHERE_NONE;
  ASSERT_EQ(lodemark_session_open(&options, &session), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_use_map(session, map), LODEMARK_OK);
  const std::uint8_t* pixels = scene.photo.data();
  std::int32_t count = 0;
  auto frame = Sized<lodemark_frame>();
  frame.time_ns = Constellation::kReference_gps_ns;
  EXPECT_EQ(lodemark_session_push_image(session, &frame, &scene.lens, pixels, INT64_MAX), kInvalid);
  EXPECT_EQ(
      lodemark_map_query(map, &scene.lens, pixels, INT64_MAX, nullptr, nullptr, nullptr, 0, &count),
      kInvalid);
  lodemark_query_options query = {};
  EXPECT_EQ(lodemark_map_query(map, &scene.lens, pixels, scene.lens.width_px, nullptr, &query,
                               nullptr, 0, &count),
            kInvalid);
  auto pose = Sized<lodemark_pose>();
  auto residual = Sized<lodemark_sight_residual>();
  EXPECT_EQ(lodemark_map_locate(map, &scene.lens, pixels, scene.lens.width_px, nullptr, nullptr,
                                nullptr, &pose, nullptr, &residual, 0, &count),
            LODEMARK_OK)
      << lodemark_last_error();
  EXPECT_GT(count, 100);

  // Landmarks are scaled by how they scatter.
  const std::string orbits = Constellation::NavigationFile();
  EXPECT_EQ(
      lodemark_session_push_navigation(session, nullptr, orbits.data(), orbits.size(), nullptr),
      LODEMARK_OK);
  double place[3];
  ASSERT_EQ(lodemark_geodetic_from_ecef(scene.camera_in_ecef_m, place), LODEMARK_OK);
  StillPhone phone(place, 500.0);
  phone.Measure(Constellation::kReference_gps_ns);
  EXPECT_EQ(lodemark_session_push_image(session, &frame, &scene.lens, pixels, scene.lens.width_px),
            LODEMARK_OK);
  EXPECT_EQ(lodemark_session_push_gnss(session, 0, &phone.clock, phone.measurements.data(),
                                       phone.count()),
            LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session), LODEMARK_OK);
  auto estimate = Sized<lodemark_estimate>();
  EXPECT_EQ(lodemark_session_estimate(session, &estimate), LODEMARK_OK);
  EXPECT_NE(estimate.present & LODEMARK_ESTIMATE_HAS_LANDMARK_SIGMA_FACTOR, 0u);
  lodemark_session_close(session);
  lodemark_map_close(map);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace lodemark::test
