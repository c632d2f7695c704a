// Photographs that come after epochs younger than they are: a drive past a painted wall.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/camera/lens.h"
#include "core/map/feature_map.h"
#include "core/session/recent_moments.h"
#include "test/capi/photo_scene.h"
#include "test/unit/fusion/inertial_scene.h"
#include "test/unit/session/filter_scene.h"

namespace lodemark::test {
namespace {

constexpr double kPhoto_s = 40.3;  // when the receiver is where the map's photograph was taken
constexpr int kEpochs = 60;
const Eigen::Vector3d kDriving_mps(9.0, -4.0, 0.0);

class LatePhoto : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    path_ = new std::string(::testing::TempDir() + "late_photo_test_" + std::to_string(getpid()) +
                            ".map");
    photo_scene_ = new PhotoScene(*path_);
  }
  static void TearDownTestSuite() {
    std::remove(path_->c_str());
    delete photo_scene_;
    delete path_;
  }

  LatePhoto() : filter_scene_(kDriving_mps) {
    EXPECT_EQ(photo_scene_->problem, "");
    map_ = std::move(FeatureMap::Open(*path_)).value();
    camera_in_ecef_ = Eigen::Vector3d(photo_scene_->camera_in_ecef_m);
    filter_scene_.scene.place = GeodeticFromEcef(camera_in_ecef_);
    felt_ = InertialScene(filter_scene_.scene.place);
    const Eigen::Vector3d velocity =
        EnuFromEcefRotation(filter_scene_.scene.place).transpose() * kDriving_mps;
    const Eigen::Vector3d camera = camera_in_ecef_;
    filter_scene_.scene.path = [camera, velocity](double seconds) -> Eigen::Vector3d {
      return camera + (seconds - kPhoto_s) * velocity;
    };
    drive_ = filter_scene_.Drive(kEpochs);
  }

  CameraFrame Frame(double seconds) const {
    LensParameters parameters;
    parameters.width_px = photo_scene_->lens.width_px;
    parameters.height_px = photo_scene_->lens.height_px;
    parameters.fx_px = photo_scene_->lens.fx_px;
    parameters.fy_px = photo_scene_->lens.fy_px;
    parameters.cx_px = photo_scene_->lens.cx_px;
    parameters.cy_px = photo_scene_->lens.cy_px;
    CameraFrame frame(Lens::Create(parameters).value());
    frame.time_ns = kSceneStart_ns + std::llround(1e9 * seconds);
    frame.image = {photo_scene_->photo.data(), parameters.width_px, parameters.height_px,
                   parameters.width_px};
    return frame;
  }

  std::unique_ptr<Session> Open() const {
    std::unique_ptr<Session> session = filter_scene_.scene.Open();
    EXPECT_TRUE(session->UseMap(map_.get()).ok());
    return session;
  }

  struct Run {
    std::vector<SessionEstimate> epochs;
    SessionEstimate photo;
    std::vector<SessionEstimate> smoothed;
    std::vector<SessionEvent> events;
    int Count(EventKind kind) const {
      return static_cast<int>(
          std::count_if(events.begin(), events.end(),
                        [kind](const SessionEvent& event) { return event.kind == kind; }));
    }
  };
  // The photograph comes right before an epoch.
  Run Drive(std::size_t photo_before) { return Drive(Open().get(), photo_before); }
  Run Drive(Session* session, std::size_t photo_before) {
    Run run;
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      if (i == photo_before) {
        EXPECT_TRUE(session->PushFrame(Frame(kPhoto_s)).ok());
        EXPECT_TRUE(session->ProcessNext());
        run.photo = session->estimate();
      }
      if (samples_) {
        EXPECT_TRUE(session->PushSensors(Samples(static_cast<int>(i))).ok());
      }
      run.epochs.push_back(ProcessEpoch(session, drive_[i]));
    }
    run.smoothed = session->Smoothed();
    run.events.assign(session->events().begin(), session->events().end());
    return run;
  }

  // With bends, on which what a phone's sensors feel tells how they are turned.
  void BendTheWay() {
    const InertialScene felt = felt_;
    const Eigen::Vector3d camera = camera_in_ecef_;
    filter_scene_.scene.path = [camera, felt](double seconds) -> Eigen::Vector3d {
      return camera + (felt.PlaceAt(seconds) - felt.PlaceAt(kPhoto_s));
    };
    drive_ = filter_scene_.Drive(kEpochs);
    samples_ = true;
  }
  // Of the second before an epoch, its end included.
  std::vector<SensorSample> Samples(int epoch) const {
    std::vector<SensorSample> samples;
    if (epoch == 0) return samples;
    std::vector<InertialSample> felt = felt_.Felt(epoch - 1, epoch);
    felt.erase(felt.begin());
    for (const InertialSample& sample : felt) {
      const std::int64_t time_ns = kSceneStart_ns + sample.time_ns;
      samples.push_back({SensorKind::kAccelerometer, time_ns, sample.specific_force_mps2});
      samples.push_back({SensorKind::kGyroscope, time_ns, sample.turn_rate_radps});
    }
    return samples;
  }

  static void ExpectSame(const SessionEstimate& first, const SessionEstimate& second) {
    EXPECT_EQ(first.status, second.status);
    EXPECT_EQ(first.time_ns, second.time_ns);
    EXPECT_EQ(first.time_gps_ns, second.time_gps_ns);
    EXPECT_EQ(first.position_in_ecef, second.position_in_ecef);
    EXPECT_EQ(first.covariance_enu_m2, second.covariance_enu_m2);
    EXPECT_EQ(first.velocity_enu_mps, second.velocity_enu_mps);
    EXPECT_EQ(first.velocity_covariance_enu_m2ps2, second.velocity_covariance_enu_m2ps2);
    EXPECT_EQ(first.clock_bias_m, second.clock_bias_m);
    EXPECT_EQ(first.satellites_used, second.satellites_used);
    EXPECT_EQ(first.satellites_seen, second.satellites_seen);
    EXPECT_EQ(first.landmarks_used, second.landmarks_used);
    EXPECT_EQ(first.photo, second.photo);
    EXPECT_EQ(first.sources, second.sources);
    EXPECT_EQ(first.accuracy_m, second.accuracy_m);
  }
  static void ExpectSame(const std::vector<SessionEstimate>& first,
                         const std::vector<SessionEstimate>& second, std::size_t from) {
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = from; i < first.size(); ++i) ExpectSame(first[i], second[i]);
  }
  double Error(const Run& run, std::size_t epoch) const {
    return filter_scene_.HorizontalError(run.epochs[epoch], static_cast<int>(epoch));
  }

  static std::string* path_;
  static PhotoScene* photo_scene_;
  std::unique_ptr<FeatureMap> map_;
  Eigen::Vector3d camera_in_ecef_;
  FilterScene filter_scene_;
  std::vector<ObservationEpoch> drive_;
  InertialScene felt_{filter_scene_.scene.place};
  bool samples_ = false;
};

std::string* LatePhoto::path_ = nullptr;
PhotoScene* LatePhoto::photo_scene_ = nullptr;

// In time it comes before epoch 41. To the last bit: what came after it is heard again.
TEST_F(LatePhoto, GivesWhatItWouldHaveGivenInTime) {
  const Run in_time = Drive(41);
  ASSERT_EQ(in_time.photo.photo, PhotoOutcome::kUsed);
  EXPECT_LT((in_time.photo.position_in_ecef - camera_in_ecef_).norm(), 0.5);
  for (const std::size_t before : {42u, 43u, 44u}) {
    const Run late = Drive(before);
    ExpectSame(late.photo, in_time.photo);
    ExpectSame(late.epochs, in_time.epochs, before);
    // What was said before it came stays said: it is that of satellites.
    EXPECT_GT(Error(late, before - 1), 2.0 * Error(late, before));
    EXPECT_EQ(late.Count(EventKind::kPhotoTooLate), 0);
  }
}

// The other way round: epochs that come after a photograph younger than they are.
TEST_F(LatePhoto, LateEpochsAreHeardAtTheirTimesToo) {
  const Run in_time = Drive(41);
  for (const std::size_t before : {40u, 39u}) {
    const Run early = Drive(before);
    EXPECT_EQ(early.Count(EventKind::kFilterRestarted), 0);
    EXPECT_EQ(early.Count(EventKind::kFixLost), 0);
    for (std::size_t i = before; i < early.epochs.size(); ++i) {
      ASSERT_EQ(early.epochs[i].status, EstimateStatus::kFix) << i;
      if (i < 41) continue;
      EXPECT_LT((early.epochs[i].position_in_ecef - in_time.epochs[i].position_in_ecef).norm(),
                0.02)
          << i;
      EXPECT_LT((early.epochs[i].velocity_enu_mps - in_time.epochs[i].velocity_enu_mps).norm(),
                0.02)
          << i;
    }
  }
}

TEST_F(LatePhoto, ThatComesTooLateIsDroppedAndAnEventTells) {
  const Run never = Drive(kEpochs);
  const Run late = Drive(45);  // after the epoch 3.7 s later
  EXPECT_EQ(late.photo.status, EstimateStatus::kNoData);
  EXPECT_EQ(late.photo.time_ns, kSceneStart_ns + std::llround(1e9 * kPhoto_s));
  EXPECT_EQ(late.photo.photo, PhotoOutcome::kNone);
  ExpectSame(late.epochs, never.epochs, 0);
  ASSERT_EQ(late.Count(EventKind::kPhotoTooLate), 1);
  for (const SessionEvent& event : late.events) {
    if (event.kind != EventKind::kPhotoTooLate) continue;
    EXPECT_NEAR(event.value, 3.7, 1e-9);
    EXPECT_EQ(event.time_ns, late.photo.time_ns);
    EXPECT_NE(event.text.find("3.700 s"), std::string::npos) << event.text;
  }
}

TEST_F(LatePhoto, IsHeardAtItsTimeAlsoThroughAnOutage) {
  for (std::size_t i = 36; i < 50; ++i) drive_[i].signals.clear();
  const Run in_time = Drive(41);
  const Run late = Drive(43);
  ExpectSame(late.photo, in_time.photo);
  ExpectSame(late.epochs, in_time.epochs, 43);
  EXPECT_GT(late.epochs[42].accuracy_m, 1.5 * late.epochs[43].accuracy_m);
  // Without epochs for some seconds it has a moment of its own.
  drive_.erase(drive_.begin() + 36, drive_.begin() + 43);
  const Run in_time_alone = Drive(36);
  const Run late_alone = Drive(37);
  ASSERT_EQ(in_time_alone.photo.photo, PhotoOutcome::kUsed);
  ExpectSame(late_alone.photo, in_time_alone.photo);
  ExpectSame(late_alone.epochs, in_time_alone.epochs, 37);
}

// Half a kilometre off until just before: the filter finds out, with the photograph or without.
TEST_F(LatePhoto, IsHeardAtItsTimeAlsoWhereTheFilterBeganAnewSince) {
  FilterScene elsewhere = filter_scene_;
  const auto path = filter_scene_.scene.path;
  elsewhere.scene.path = [path](double seconds) -> Eigen::Vector3d {
    return path(seconds) + Eigen::Vector3d(0.0, 0.0, 500.0);
  };
  const std::vector<ObservationEpoch> wrong = elsewhere.Drive(kEpochs, 5);
  for (const std::size_t right_from : {39u, 41u}) {
    drive_ = filter_scene_.Drive(kEpochs);
    std::copy(wrong.begin(), wrong.begin() + static_cast<std::ptrdiff_t>(right_from),
              drive_.begin());
    const Run in_time = Drive(41);
    const Run late = Drive(44);
    EXPECT_GT(in_time.Count(EventKind::kFilterRestarted), 0) << right_from;
    ExpectSame(late.photo, in_time.photo);
    ExpectSame(late.epochs, in_time.epochs, 44);
  }
}

TEST_F(LatePhoto, IsSmoothedWithWhatItWouldHaveBeenInTime) {
  filter_scene_.scene.options.estimator = Estimator::kSmoother;
  const Run in_time = Drive(41);
  Run late = Drive(43);
  // In the order they were given: the photograph's is the 43rd, not the 41st.
  ASSERT_EQ(late.smoothed.size(), in_time.smoothed.size());
  std::rotate(late.smoothed.begin() + 41, late.smoothed.begin() + 43, late.smoothed.begin() + 44);
  ExpectSame(late.smoothed, in_time.smoothed, 0);
  // One that is dropped is not carried to another time.
  const Run dropped = Drive(45);
  EXPECT_EQ(dropped.smoothed[45].status, EstimateStatus::kNoData);
}

TEST_F(LatePhoto, IsHeardAtItsTimeByAFilterWithSensors) {
  BendTheWay();
  const Run in_time = Drive(41);
  EXPECT_EQ(in_time.photo.sources, kSourceVision | kSourceInertial);
  const Run late = Drive(43);
  ExpectSame(late.photo, in_time.photo);
  ExpectSame(late.epochs, in_time.epochs, 43);
  for (std::size_t i = 40; i < kEpochs; ++i) {
    EXPECT_NE(late.epochs[i].sources & kSourceInertial, 0u) << i;
  }
}

TEST_F(LatePhoto, WaitsWithOthersInTheOrderOfTheirTimes) {
  const std::unique_ptr<Session> session = Open();
  for (const double seconds : {3.0, 1.0, 2.0}) {
    ASSERT_TRUE(session->PushFrame(Frame(seconds)).ok());
  }
  for (const int seconds : {1, 2, 3}) {
    ASSERT_TRUE(session->ProcessNext());
    EXPECT_EQ(session->estimate().time_ns, kSceneStart_ns + seconds * kSecond_ns);
  }
}

// Twenty times a second, forty moments are two seconds.
TEST_F(LatePhoto, GoesBackNoFartherThanThereIsRoomFor) {
  const std::unique_ptr<Session> session = Open();
  for (int i = 0; i < 80; ++i)
    (void)ProcessEpoch(session.get(), filter_scene_.scene.Epoch(0.05 * i));
  const auto outcome_at = [&](double seconds) {
    EXPECT_TRUE(session->PushFrame(Frame(seconds)).ok());
    EXPECT_TRUE(session->ProcessNext());
    return session->estimate().status;
  };
  static_assert(RecentMoments::kMost == 40);
  EXPECT_EQ(outcome_at(1.96), EstimateStatus::kNoData);
  EXPECT_EQ(outcome_at(2.01), EstimateStatus::kFix);
  EXPECT_EQ(ProcessEpoch(session.get(), filter_scene_.scene.Epoch(4.0)).status,
            EstimateStatus::kFix);
}

}  // namespace
}  // namespace lodemark::test
