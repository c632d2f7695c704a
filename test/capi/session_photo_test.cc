// Photographs and satellites in one session, on scenes that are known exactly.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/capi/photo_scene.h"

namespace lodemark::test {
namespace {

constexpr std::int64_t kStart_ns = Constellation::kReference_gps_ns;
constexpr std::int64_t kSecond = 1'000'000'000;

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof(T);
  return value;
}

double Distance(const double (&a)[3], const double* b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

class SessionPhoto : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    path_ = new std::string(::testing::TempDir() + "session_photo_test_" +
                            std::to_string(getpid()) + ".map");
    scene_ = new PhotoScene(*path_);
  }
  static void TearDownTestSuite() {
    std::remove(path_->c_str());
    delete scene_;
    delete path_;
  }

  void SetUp() override {
    ASSERT_EQ(lodemark_map_open(path_->c_str(), &map_), LODEMARK_OK) << lodemark_last_error();
    double geodetic[3];
    ASSERT_EQ(lodemark_geodetic_from_ecef(scene_->camera_in_ecef_m, geodetic), LODEMARK_OK);
    phone_ = new StillPhone(geodetic, 4321.0);
    Open(LODEMARK_SCHEME_JOINT);
  }
  void TearDown() override {
    lodemark_session_close(session_);
    lodemark_map_close(map_);
    delete phone_;
  }

  void Open(std::int32_t scheme, std::int32_t estimator = LODEMARK_ESTIMATOR_EPOCH) {
    lodemark_session_close(session_);
    lodemark_session_options options = Sized<lodemark_session_options>();
    options.ionosphere = LODEMARK_IONOSPHERE_NONE;
    options.troposphere = LODEMARK_TROPOSPHERE_NONE;
    options.scheme = scheme;
    options.estimator = estimator;
    ASSERT_EQ(lodemark_session_open(&options, &session_), LODEMARK_OK) << lodemark_last_error();
    ASSERT_EQ(lodemark_session_use_map(session_, map_), LODEMARK_OK);
    const std::string file = Constellation::NavigationFile();
    ASSERT_EQ(lodemark_session_push_navigation(session_, "nav", file.data(), file.size(), nullptr),
              LODEMARK_OK)
        << lodemark_last_error();
  }

  // An epoch of at most so many satellites.
  lodemark_status Epoch(std::int64_t time_ns, int satellites) {
    phone_->Measure(time_ns);
    const lodemark_status status =
        lodemark_session_push_gnss(session_, 0, &phone_->clock, phone_->measurements.data(),
                                   std::min(satellites, phone_->count()));
    EXPECT_EQ(status, LODEMARK_OK) << lodemark_last_error();
    return Process();
  }

  lodemark_status Photo(std::int64_t time_ns, const std::vector<std::uint8_t>& pixels) {
    lodemark_frame frame = Sized<lodemark_frame>();
    frame.time_ns = time_ns;
    const lodemark_status status = lodemark_session_push_image(
        session_, &frame, &scene_->lens, pixels.data(), scene_->lens.width_px);
    EXPECT_EQ(status, LODEMARK_OK) << lodemark_last_error();
    return Process();
  }
  lodemark_status Photo(std::int64_t time_ns) { return Photo(time_ns, scene_->photo); }

  lodemark_status Process() {
    const lodemark_status status = lodemark_session_process(session_);
    estimate_ = Sized<lodemark_estimate>();
    EXPECT_EQ(lodemark_session_estimate(session_, &estimate_), status) << lodemark_last_error();
    return status;
  }

  double Error() const { return Distance(estimate_.ecef_m, scene_->camera_in_ecef_m); }

  std::vector<lodemark_landmark> Landmarks() const {
    std::int32_t count = 0;
    EXPECT_EQ(lodemark_session_landmarks(session_, nullptr, 0, &count), LODEMARK_OK);
    std::vector<lodemark_landmark> landmarks(static_cast<std::size_t>(count));
    if (count == 0) return landmarks;
    landmarks[0].struct_size = sizeof(lodemark_landmark);
    EXPECT_EQ(lodemark_session_landmarks(session_, landmarks.data(), count, &count), LODEMARK_OK);
    return landmarks;
  }

  std::vector<lodemark_event> Events() const {
    std::int32_t count = 0;
    EXPECT_EQ(lodemark_session_events(session_, nullptr, 0, &count), LODEMARK_OK);
    std::vector<lodemark_event> events(static_cast<std::size_t>(count));
    if (count == 0) return events;
    events[0].struct_size = sizeof(lodemark_event);
    EXPECT_EQ(lodemark_session_events(session_, events.data(), count, &count), LODEMARK_OK);
    return events;
  }

  static std::string* path_;
  static PhotoScene* scene_;
  lodemark_map* map_ = nullptr;
  lodemark_session* session_ = nullptr;
  StillPhone* phone_ = nullptr;
  lodemark_estimate estimate_ = {};
};

std::string* SessionPhoto::path_ = nullptr;
PhotoScene* SessionPhoto::scene_ = nullptr;

TEST_F(SessionPhoto, APhotographAloneGivesAPosition) {
  ASSERT_EQ(Photo(kStart_ns), LODEMARK_OK);
  EXPECT_LT(Error(), 0.05);
  EXPECT_EQ(estimate_.sources, LODEMARK_SOURCE_VISION);
  EXPECT_EQ(estimate_.photo, LODEMARK_PHOTO_USED);
  EXPECT_EQ(estimate_.time_ns, kStart_ns);
  EXPECT_EQ(estimate_.satellites_used, 0);
  EXPECT_GT(estimate_.landmarks_used, 20);
  EXPECT_NE(estimate_.present & LODEMARK_ESTIMATE_HAS_ORIENTATION, 0u);
  // Level and to the north: x to the east, y down, z north.
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(std::abs(estimate_.camera_from_enu[0]), half, 1e-3);
  EXPECT_NEAR(std::abs(estimate_.camera_from_enu[1]), half, 1e-3);
}

// A compass beside a car, or a filter that has its heading wrong.
TEST_F(SessionPhoto, AWrongHeadingLosesNoRightPhotograph) {
  ASSERT_EQ(Epoch(kStart_ns, 24), LODEMARK_OK);
  for (const double heading_deg : {20.0, 90.0, 180.0}) {
    lodemark_frame frame = Sized<lodemark_frame>();
    frame.time_ns = estimate_.time_ns + kSecond / 4;
    frame.present = LODEMARK_FRAME_HAS_HEADING;
    frame.heading_deg = heading_deg;
    frame.heading_sigma_deg = 3.0;
    ASSERT_EQ(lodemark_session_push_image(session_, &frame, &scene_->lens, scene_->photo.data(),
                                          scene_->lens.width_px),
              LODEMARK_OK);
    ASSERT_EQ(Process(), LODEMARK_OK) << heading_deg;
    EXPECT_EQ(estimate_.photo, LODEMARK_PHOTO_USED) << heading_deg;
    EXPECT_LT(Error(), 0.2) << heading_deg;
    // It looks north.
    const double* q = estimate_.camera_from_enu;
    EXPECT_NEAR(std::atan2(2.0 * (q[1] * q[3] - q[0] * q[2]), 2.0 * (q[2] * q[3] + q[0] * q[1])),
                0.0, 0.01)
        << heading_deg;
  }
}

// The first words of the project: neither alone would do.
TEST_F(SessionPhoto, TwoSatellitesAndAPhotographGiveAPositionAndAClock) {
  ASSERT_EQ(Epoch(kStart_ns, 2), LODEMARK_NO_POSITION);
  EXPECT_EQ(estimate_.outcome, LODEMARK_OUTCOME_TOO_FEW);
  ASSERT_EQ(Photo(kStart_ns + kSecond), LODEMARK_OK);
  ASSERT_EQ(Epoch(kStart_ns + kSecond, 2), LODEMARK_OK);
  EXPECT_LT(Error(), 0.05);
  EXPECT_EQ(estimate_.sources, LODEMARK_SOURCE_GNSS | LODEMARK_SOURCE_VISION);
  EXPECT_EQ(estimate_.satellites_used, 2);
  EXPECT_NEAR(estimate_.clock_bias_m, 4321.0, 1.0);
}

TEST_F(SessionPhoto, EachSchemeIsNearTheTruth) {
  for (const std::int32_t scheme :
       {LODEMARK_SCHEME_JOINT, LODEMARK_SCHEME_TIGHT, LODEMARK_SCHEME_TIGHT_DIAGONAL,
        LODEMARK_SCHEME_VISION, LODEMARK_SCHEME_GNSS}) {
    Open(scheme);
    ASSERT_EQ(Photo(kStart_ns), scheme == LODEMARK_SCHEME_GNSS ? LODEMARK_NO_POSITION : LODEMARK_OK)
        << scheme;
    ASSERT_EQ(Epoch(kStart_ns, 24), LODEMARK_OK) << scheme;
    EXPECT_LT(Error(), 0.5) << scheme;
    std::uint32_t sources = LODEMARK_SOURCE_GNSS | LODEMARK_SOURCE_VISION;
    if (scheme == LODEMARK_SCHEME_VISION) sources = LODEMARK_SOURCE_VISION;
    if (scheme == LODEMARK_SCHEME_GNSS) sources = LODEMARK_SOURCE_GNSS;
    EXPECT_EQ(estimate_.sources, sources) << scheme;
  }
}

// Adjusted with the epoch half a second before, and told at its own time.
TEST_F(SessionPhoto, APhotographBetweenEpochsHasItsOwnEstimate) {
  ASSERT_EQ(Epoch(kStart_ns, 24), LODEMARK_OK);
  const double alone_m = estimate_.accuracy_m;
  ASSERT_EQ(Photo(kStart_ns + kSecond / 2), LODEMARK_OK);
  EXPECT_EQ(estimate_.time_ns, kStart_ns + kSecond / 2);
  EXPECT_EQ(estimate_.time_gps_ns, kStart_ns + kSecond / 2);
  EXPECT_LT(Error(), 0.5);
  EXPECT_LT(estimate_.accuracy_m, alone_m);
  EXPECT_EQ(estimate_.sources, LODEMARK_SOURCE_GNSS | LODEMARK_SOURCE_VISION);
  // Ten seconds later it is too old to be of use.
  ASSERT_EQ(Epoch(kStart_ns + 10 * kSecond, 24), LODEMARK_OK);
  EXPECT_EQ(estimate_.sources, LODEMARK_SOURCE_GNSS);
  EXPECT_EQ(estimate_.photo, LODEMARK_PHOTO_NONE);
  EXPECT_TRUE(Landmarks().empty());
}

TEST_F(SessionPhoto, TellsHowEachLandmarkFared) {
  ASSERT_EQ(Photo(kStart_ns), LODEMARK_OK);
  const std::vector<lodemark_landmark> landmarks = Landmarks();
  ASSERT_EQ(static_cast<std::int32_t>(landmarks.size()), estimate_.landmarks_seen);
  int used = 0;
  for (const lodemark_landmark& landmark : landmarks) {
    if (landmark.verdict != LODEMARK_VERDICT_USED) continue;
    ++used;
    EXPECT_GE(landmark.weight, 0.5);
    ASSERT_NE(landmark.present & LODEMARK_LANDMARK_HAS_RESIDUAL, 0u);
    EXPECT_LT(std::hypot(landmark.residual_px[0], landmark.residual_px[1]), 5.0);
    EXPECT_NEAR(landmark.range_m, Distance(landmark.landmark_in_ecef_m, scene_->camera_in_ecef_m),
                0.1);
    EXPECT_GT(landmark.range_sigma_m, 0.0);
  }
  EXPECT_EQ(used, estimate_.landmarks_used);
}

// Satellites of one place, a photograph of another a kilometre away.
TEST_F(SessionPhoto, AMapOfAnotherPlaceDoesNoHarm) {
  const double elsewhere[3] = {48.21, 16.37, 180.0};
  delete phone_;
  phone_ = new StillPhone(elsewhere, 4321.0);
  ASSERT_EQ(Epoch(kStart_ns, 24), LODEMARK_OK);
  ASSERT_EQ(Photo(kStart_ns + kSecond), LODEMARK_OK);
  EXPECT_EQ(estimate_.photo, LODEMARK_PHOTO_CONTRADICTED);
  EXPECT_EQ(estimate_.landmarks_used, 0);
  EXPECT_LT(Distance(estimate_.ecef_m, phone_->ecef_m()), 1.0);
  ASSERT_EQ(Epoch(kStart_ns + kSecond, 24), LODEMARK_OK);
  EXPECT_EQ(estimate_.photo, LODEMARK_PHOTO_CONTRADICTED);
  EXPECT_LT(Distance(estimate_.ecef_m, phone_->ecef_m()), 1.0);
  for (const lodemark_landmark& landmark : Landmarks()) {
    EXPECT_EQ(landmark.verdict, LODEMARK_VERDICT_PHOTO_NOT_USED);
  }
  int told = 0;
  for (const lodemark_event& event : Events()) {
    told += event.kind == LODEMARK_EVENT_PHOTO_CONTRADICTED ? 1 : 0;
  }
  EXPECT_EQ(told, 1);
}

TEST_F(SessionPhoto, ACoveredCameraDoesNoHarm) {
  ASSERT_EQ(Epoch(kStart_ns, 24), LODEMARK_OK);
  const std::vector<std::uint8_t> black(scene_->photo.size(), 0);
  EXPECT_EQ(Photo(kStart_ns + kSecond, black), LODEMARK_NO_POSITION);
  EXPECT_EQ(estimate_.photo, LODEMARK_PHOTO_NOT_RECOGNISED);
  ASSERT_EQ(Epoch(kStart_ns + kSecond, 24), LODEMARK_OK);
  EXPECT_EQ(estimate_.photo, LODEMARK_PHOTO_NOT_RECOGNISED);
  EXPECT_EQ(estimate_.sources, LODEMARK_SOURCE_GNSS);
  EXPECT_LT(Error(), 0.5);
}

TEST_F(SessionPhoto, WhatWaitsIsTakenInTheOrderOfItsTime) {
  lodemark_frame frame = Sized<lodemark_frame>();
  for (const int i : {2, 3, 4, 5}) {
    frame.time_ns = kStart_ns + i * kSecond;
    ASSERT_EQ(lodemark_session_push_image(session_, &frame, &scene_->lens, scene_->photo.data(),
                                          scene_->lens.width_px),
              LODEMARK_OK);
  }
  EXPECT_EQ(lodemark_session_push_image(session_, &frame, &scene_->lens, scene_->photo.data(),
                                        scene_->lens.width_px),
            LODEMARK_ERROR_QUEUE_FULL);
  phone_->Measure(kStart_ns + kSecond);
  ASSERT_EQ(lodemark_session_push_gnss(session_, 0, &phone_->clock, phone_->measurements.data(),
                                       phone_->count()),
            LODEMARK_OK);
  std::int32_t queued = 0;
  ASSERT_EQ(lodemark_session_queued(session_, &queued), LODEMARK_OK);
  EXPECT_EQ(queued, 5);
  for (int i = 1; i <= 5; ++i) {
    ASSERT_EQ(Process(), LODEMARK_OK);
    EXPECT_EQ(estimate_.time_ns, kStart_ns + i * kSecond);
  }
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NOTHING_QUEUED);
}

// A filter hears it at its time, and what came after it once more; up to 3 s late.
TEST_F(SessionPhoto, OneThatComesLateGivesWhatItWouldHaveGivenInTime) {
  lodemark_estimate photo[3] = {};
  lodemark_estimate after[3] = {};
  for (const int late : {0, 2, 4}) {
    Open(LODEMARK_SCHEME_JOINT, LODEMARK_ESTIMATOR_FILTER);
    for (int i = 0; i < 6; ++i) {
      if (i == 1 + late) {
        Photo(kStart_ns + kSecond / 2);
        photo[late / 2] = estimate_;
      }
      ASSERT_EQ(Epoch(kStart_ns + i * kSecond, 24), LODEMARK_OK);
    }
    after[late / 2] = estimate_;
  }
  EXPECT_EQ(photo[0].photo, LODEMARK_PHOTO_USED);
  EXPECT_EQ(std::memcmp(&photo[0], &photo[1], sizeof photo[0]), 0);
  EXPECT_EQ(std::memcmp(&after[0], &after[1], sizeof after[0]), 0);
  // 3.5 s is too late.
  EXPECT_EQ(photo[2].outcome, LODEMARK_OUTCOME_NO_DATA);
  EXPECT_EQ(photo[2].time_ns, kStart_ns + kSecond / 2);
  EXPECT_EQ(photo[2].photo, LODEMARK_PHOTO_NONE);
  int told = 0;
  for (const lodemark_event& event : Events()) {
    if (event.kind != LODEMARK_EVENT_PHOTO_TOO_LATE) continue;
    ++told;
    EXPECT_NEAR(event.value, 3.5, 1e-9);
  }
  EXPECT_EQ(told, 1);
}

TEST_F(SessionPhoto, RefusesWhatMakesNoSense) {
  constexpr lodemark_status kInvalid = LODEMARK_ERROR_INVALID_ARGUMENT;
  const std::uint8_t* pixels = scene_->photo.data();
  const std::int64_t stride = scene_->lens.width_px;
  lodemark_frame frame = Sized<lodemark_frame>();
  const auto push = [&] {
    return lodemark_session_push_image(session_, &frame, &scene_->lens, pixels, stride);
  };
  EXPECT_EQ(lodemark_session_push_image(nullptr, &frame, &scene_->lens, pixels, stride), kInvalid);
  EXPECT_EQ(lodemark_session_push_image(session_, nullptr, &scene_->lens, pixels, stride),
            kInvalid);
  EXPECT_EQ(lodemark_session_push_image(session_, &frame, nullptr, pixels, stride), kInvalid);
  EXPECT_EQ(lodemark_session_push_image(session_, &frame, &scene_->lens, nullptr, stride),
            kInvalid);
  EXPECT_EQ(lodemark_session_push_image(session_, &frame, &scene_->lens, pixels, stride - 1),
            kInvalid);
  frame.present = 8;
  EXPECT_EQ(push(), LODEMARK_ERROR_UNSUPPORTED);
  frame.present = LODEMARK_FRAME_HAS_GRAVITY;
  EXPECT_EQ(push(), kInvalid);
  EXPECT_STREQ(lodemark_last_error(), "frame.up_in_camera has no length");
  frame.up_in_camera[1] = -9.8;
  EXPECT_EQ(push(), kInvalid);
  EXPECT_STREQ(lodemark_last_error(), "frame.up_sigma_deg is out of range");
  frame.up_sigma_deg = 1.0;
  EXPECT_EQ(push(), LODEMARK_OK);
  frame.present = LODEMARK_FRAME_HAS_HEADING;
  frame.heading_deg = 400.0;
  EXPECT_EQ(push(), kInvalid);
  frame.present = 0;
  frame.time_ns = INT64_MAX;
  EXPECT_EQ(push(), kInvalid);
  frame.time_ns = 0;
  ASSERT_EQ(lodemark_session_use_map(session_, nullptr), LODEMARK_OK);
  EXPECT_EQ(push(), LODEMARK_ERROR_OUT_OF_ORDER);
  EXPECT_EQ(lodemark_session_use_map(nullptr, map_), kInvalid);
  std::int32_t count = 0;
  EXPECT_EQ(lodemark_session_landmarks(nullptr, nullptr, 0, &count), kInvalid);
  EXPECT_EQ(lodemark_session_landmarks(session_, nullptr, 0, nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_landmarks(session_, nullptr, -1, &count), kInvalid);
  lodemark_session* other = nullptr;
  lodemark_session_options options = Sized<lodemark_session_options>();
  options.scheme = 5;
  EXPECT_EQ(lodemark_session_open(&options, &other), LODEMARK_ERROR_UNSUPPORTED);
  options.scheme = 0;
  options.estimator = 77;
  EXPECT_EQ(lodemark_session_open(&options, &other), LODEMARK_ERROR_UNSUPPORTED);
}

}  // namespace
}  // namespace lodemark::test
