// A car that rolls evenly on a straight road: neither its wheels nor a phone in it feel anything,
// as where it stands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "test/unit/session/filter_scene.h"

namespace lodemark::test {
namespace {

constexpr double kSlowsFrom_s = 45.0;
constexpr double kSlowing_s = 10.0;
constexpr int kSilentFrom_s = 60;
constexpr int kEnd_s = 80;

// A drive with bends, by which sensors are aligned, that slows down to a share of its speed and
// goes on so through a time without satellites.
class Rolling : public ::testing::TestWithParam<double> {
 protected:
  Rolling() : filter_scene_(Eigen::Vector3d::Zero()) {
    filter_scene_.scene.path = [this](double seconds) { return PlaceAt(seconds); };
  }

  Eigen::Vector2d WayAt(double seconds) const {
    const double slowed_s = std::clamp(seconds - kSlowsFrom_s, 0.0, kSlowing_s);
    const double after_s = std::max(0.0, seconds - kSlowsFrom_s - kSlowing_s);
    const double driven_s = std::min(seconds, kSlowsFrom_s) + slowed_s -
                            0.5 * (1.0 - GetParam()) * slowed_s * slowed_s / kSlowing_s +
                            GetParam() * after_s;
    return {10.0 * driven_s + 15.0 * std::sin(0.3 * driven_s), 40.0 * std::sin(0.15 * driven_s)};
  }
  Eigen::Vector3d PlaceAt(double seconds) const {
    const Eigen::Vector2d way = WayAt(seconds);
    const EnuFrame frame(filter_scene_.scene.place);
    return frame.ToEcef({way.x(), way.y(), 0.0});
  }
  Eigen::Vector2d VelocityAt(double seconds) const {
    return (WayAt(seconds + 0.01) - WayAt(seconds - 0.01)) / 0.02;
  }

  std::vector<SensorSample> Wheels(int from_s) const {
    std::vector<SensorSample> samples;
    for (int i = 0; i < 10; ++i) {
      const double seconds = from_s + 0.1 * i;
      const Eigen::Vector2d before = VelocityAt(seconds - 0.02);
      const Eigen::Vector2d after = VelocityAt(seconds + 0.02);
      const double turned_rad =
          std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
      samples.push_back({SensorKind::kVehicle,
                         kSceneStart_ns + std::llround(1e9 * seconds),
                         {VelocityAt(seconds).norm(), turned_rad / 0.04, 0.0}});
    }
    return samples;
  }

  FilterScene filter_scene_;
};

TEST_P(Rolling, IsNotTakenForStandingStill) {
  std::vector<ObservationEpoch> drive = filter_scene_.Drive(kEnd_s + 1);
  const std::unique_ptr<Session> session = filter_scene_.scene.Open();
  for (int i = 0; i <= kEnd_s; ++i) {
    ObservationEpoch& epoch = drive[static_cast<std::size_t>(i)];
    if (i >= kSilentFrom_s) epoch.signals.clear();
    if (i > 0) {
      (void)session->PushSensors(Wheels(i - 1));
    }
    ProcessEpoch(session.get(), epoch);
  }
  ASSERT_EQ(CountEvents(*session, EventKind::kInertialAligned), 1);
  const SessionEstimate& last = session->estimate();
  ASSERT_EQ(last.status, EstimateStatus::kFix);
  EXPECT_EQ(last.sources, kSourceInertial);
  const double speed_mps = VelocityAt(kEnd_s).norm();
  ASSERT_GT(speed_mps, 0.1);
  EXPECT_NEAR(last.velocity_enu_mps.norm(), speed_mps, 0.1 + 0.02 * speed_mps);
  EXPECT_LT(filter_scene_.HorizontalError(last, kEnd_s), 3.0 * last.accuracy_m);
  EXPECT_LT(filter_scene_.HorizontalError(last, kEnd_s), 2.5);
}

// Shares of some 10 m/s: below half a metre a second, where a phone that feels nothing is heard to
// be at rest, and above.
INSTANTIATE_TEST_SUITE_P(Shares, Rolling, ::testing::Values(0.03, 0.045, 0.3));

}  // namespace
}  // namespace lodemark::test
