// Samples of inertial sensors that come after the epoch they belong to.
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "test/unit/fusion/inertial_scene.h"
#include "test/unit/session/filter_scene.h"

namespace lodemark::test {
namespace {

class LateSamples : public ::testing::Test {
 protected:
  LateSamples() : filter_scene_(Eigen::Vector3d::Zero()) {
    const InertialScene felt = felt_;
    filter_scene_.scene.path = [felt](double seconds) { return felt.PlaceAt(seconds); };
    drive_ = filter_scene_.Drive(90);
  }

  // What was felt in the second before an epoch.
  std::vector<SensorSample> Before(std::size_t epoch) const {
    std::vector<SensorSample> samples;
    std::vector<InertialSample> felt =
        felt_.Felt(static_cast<double>(epoch) - 1.0, static_cast<double>(epoch));
    felt.erase(felt.begin());
    for (const InertialSample& sample : felt) {
      const std::int64_t time_ns = kSceneStart_ns + sample.time_ns;
      samples.push_back({SensorKind::kAccelerometer, time_ns, sample.specific_force_mps2});
      samples.push_back({SensorKind::kGyroscope, time_ns, sample.turn_rate_radps});
    }
    return samples;
  }

  // late(epoch): whether the samples before it come after it.
  template <typename Late>
  std::vector<SessionEstimate> Run(const Late& late) {
    const std::unique_ptr<Session> session = filter_scene_.scene.Open();
    std::vector<SessionEstimate> estimates;
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      if (i > 1 && late(i - 1)) {
        EXPECT_TRUE(session->PushSensors(Before(i - 1)).ok());
      }
      if (i > 0 && !late(i)) {
        EXPECT_TRUE(session->PushSensors(Before(i)).ok());
      }
      estimates.push_back(ProcessEpoch(session.get(), drive_[i]));
    }
    lost_ = CountEvents(*session, EventKind::kInertialLost);
    dropped_ = CountEvents(*session, EventKind::kSensorDropped);
    return estimates;
  }

  FilterScene filter_scene_;
  InertialScene felt_{filter_scene_.scene.place};
  std::vector<ObservationEpoch> drive_;
  int lost_ = 0;
  int dropped_ = 0;
};

// Always so: nobody knows how the phone is turned, and the filter is the one without sensors.
TEST_F(LateSamples, AreNotHeardAndDoNoHarm) {
  const std::vector<SessionEstimate> late = Run([](std::size_t) { return true; });
  EXPECT_EQ(dropped_, 0);
  const std::vector<SessionEstimate> alone =
      FilterScene::Run(filter_scene_.scene.Open().get(), drive_);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(late[i].status, alone[i].status);
    EXPECT_EQ(late[i].position_in_ecef, alone[i].position_in_ecef) << i;
    EXPECT_EQ(late[i].covariance_enu_m2, alone[i].covariance_enu_m2) << i;
    EXPECT_EQ(late[i].sources, kSourceGnss) << i;
  }
}

// Once: the filter goes on without them, says so, and is carried again after a while.
TEST_F(LateSamples, OfOneSecondCostTheFilterItsSensorsForAWhile) {
  const std::vector<SessionEstimate> in_time = Run([](std::size_t) { return false; });
  EXPECT_EQ(lost_, 0);
  EXPECT_NE(in_time[50].sources & kSourceInertial, 0u);
  const std::vector<SessionEstimate> late = Run([](std::size_t epoch) { return epoch == 50; });
  EXPECT_EQ(lost_, 1);
  EXPECT_EQ(late[50].sources, kSourceGnss);
  EXPECT_NE(late[89].sources & kSourceInertial, 0u);
  for (std::size_t i = 50; i < late.size(); ++i) {
    ASSERT_EQ(late[i].status, EstimateStatus::kFix) << i;
    const double error_m = filter_scene_.HorizontalError(late[i], static_cast<int>(i));
    EXPECT_LT(error_m, 3.0 * late[i].accuracy_m) << i;
    EXPECT_LT(error_m, filter_scene_.HorizontalError(in_time[i], static_cast<int>(i)) + 1.0) << i;
  }
}

}  // namespace
}  // namespace lodemark::test
