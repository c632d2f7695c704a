// The filter with a phone's inertial sensors, through the session: a bending drive with noise.
#include "core/session/inertial_carrier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "test/unit/fusion/inertial_scene.h"
#include "test/unit/session/filter_scene.h"

namespace lodemark::test {
namespace {

class InertialCarrierTest : public ::testing::Test {
 protected:
  InertialCarrierTest() : filter_scene_(Eigen::Vector3d::Zero()) {
    const InertialScene scene = scene_;
    filter_scene_.scene.path = [scene](double seconds) { return scene.PlaceAt(seconds); };
  }

  // What the phone's sensors say from one second to the next, with noise and biases.
  std::vector<SensorSample> Samples(int from_s, bool exchanged = false) {
    std::vector<SensorSample> samples;
    std::vector<InertialSample> felt = scene_.Felt(from_s, from_s + 1);
    felt.pop_back();
    for (const InertialSample& sample : felt) {
      Eigen::Vector3d force = sample.specific_force_mps2 + Eigen::Vector3d(0.1, -0.1, 0.05);
      Eigen::Vector3d rate = sample.turn_rate_radps + Eigen::Vector3d(0.02, -0.01, 0.01);
      for (int axis = 0; axis < 3; ++axis) {
        force[axis] += random_.Gaussian(0.0, 0.1);
        rate[axis] += random_.Gaussian(0.0, 0.003);
      }
      if (exchanged) {
        std::swap(force.x(), force.y());
        std::swap(rate.x(), rate.y());
      }
      const std::int64_t time_ns = kSceneStart_ns + sample.time_ns;
      samples.push_back({SensorKind::kAccelerometer, time_ns, force});
      samples.push_back({SensorKind::kGyroscope, time_ns, rate});
    }
    return samples;
  }

  // What the vehicle says of itself five times a second, rounded as its bus does.
  std::vector<SensorSample> Wheels(int from_s) const {
    std::vector<SensorSample> samples;
    for (int i = 0; i < 5; ++i) {
      const double seconds = from_s + 0.2 * i;
      const Eigen::Vector3d before = scene_.enu_from_ecef() * scene_.VelocityAt(seconds - 0.01);
      const Eigen::Vector3d after = scene_.enu_from_ecef() * scene_.VelocityAt(seconds + 0.01);
      const double turned_rad = std::atan2(before.x() * after.y() - before.y() * after.x(),
                                           before.head<2>().dot(after.head<2>()));
      const double speed_mps = 0.02 * std::round(after.norm() / 0.02);
      samples.push_back({SensorKind::kVehicle,
                         kSceneStart_ns + std::llround(1e9 * seconds),
                         {speed_mps, turned_rad / 0.02 + 0.002, 0.0}});
    }
    return samples;
  }

  std::vector<ObservationEpoch> DriveWithOutage() const {
    std::vector<ObservationEpoch> drive = filter_scene_.Drive(90);
    for (std::size_t i = 60; i < 75; ++i) drive[i].signals.clear();
    return drive;
  }

  enum class Sensors : std::uint8_t { kNone, kTrue, kExchanged, kUntilHalf, kWheels };
  std::vector<SessionEstimate> Run(Sensors sensors) {
    const std::vector<ObservationEpoch> drive = DriveWithOutage();
    const std::unique_ptr<Session> session = filter_scene_.scene.Open();
    std::vector<SessionEstimate> estimates;
    for (std::size_t i = 0; i < drive.size(); ++i) {
      const bool pushes = sensors != Sensors::kNone && (sensors != Sensors::kUntilHalf || i < 50);
      if (pushes && i > 0) {
        const int from_s = static_cast<int>(i) - 1;
        const std::vector<SensorSample> samples =
            sensors == Sensors::kWheels ? Wheels(from_s)
                                        : Samples(from_s, sensors == Sensors::kExchanged);
        EXPECT_TRUE(session->PushSensors(samples).ok());
      }
      estimates.push_back(ProcessEpoch(session.get(), drive[i]));
    }
    events_.clear();
    for (const SessionEvent& event : session->events()) events_.push_back(event.kind);
    return estimates;
  }
  // By which turn about east, north and up the phone is held otherwise.
  Eigen::Vector3d TurnedOff(const SessionEstimate& estimate, int epoch) const {
    const Eigen::Quaterniond enu_from_device =
        Eigen::Quaterniond(EnuFromEcefRotation(estimate.position)) * scene_.EcefFromSensor(epoch);
    return TurnOf(enu_from_device * estimate.attitude->device_from_enu);
  }
  std::ptrdiff_t Count(EventKind kind) const {
    return std::count(events_.begin(), events_.end(), kind);
  }
  double Error(const std::vector<SessionEstimate>& estimates, int epoch) const {
    return filter_scene_.HorizontalError(estimates[static_cast<std::size_t>(epoch)], epoch);
  }

  FilterScene filter_scene_;
  InertialScene scene_{filter_scene_.scene.place};
  Random random_{17};
  std::vector<EventKind> events_;  // of the last run
};

TEST_F(InertialCarrierTest, FollowsTheBendsWithoutSatellites) {
  const std::vector<SessionEstimate> alone = Run(Sensors::kNone);
  const std::vector<SessionEstimate> carried = Run(Sensors::kTrue);
  for (int i = 60; i < 75; ++i) {
    const SessionEstimate& estimate = carried[static_cast<std::size_t>(i)];
    ASSERT_EQ(estimate.status, EstimateStatus::kFix) << i;
    EXPECT_LT(Error(carried, i), 3.0 * estimate.accuracy_m) << i;
    EXPECT_EQ(estimate.sources, kSourceInertial) << i;
    ASSERT_TRUE(estimate.attitude.has_value()) << i;
    const Eigen::Vector3d off_rad = TurnedOff(estimate, i);
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma_rad = std::sqrt(estimate.attitude->covariance_enu_rad2(axis, axis));
      EXPECT_LT(std::abs(off_rad[axis]), 3.0 * sigma_rad) << i;
      EXPECT_LT(sigma_rad, 2.0 * kRadiansPerDegree) << i;
    }
  }
  EXPECT_FALSE(carried[5].attitude.has_value());
  EXPECT_FALSE(alone[74].attitude.has_value());
  EXPECT_LT(Error(carried, 74), 10.0);
  EXPECT_LT(Error(carried, 74), 0.3 * Error(alone, 74));
  EXPECT_LT(carried[74].accuracy_m, 0.5 * alone[74].accuracy_m);
  EXPECT_LT(Error(carried, 89), 3.0);
  EXPECT_EQ(carried[89].sources, kSourceGnss | kSourceInertial);
  EXPECT_EQ(alone[89].sources, kSourceGnss);
  EXPECT_EQ(Count(EventKind::kInertialAligned), 1);
  EXPECT_EQ(Count(EventKind::kInertialLost), 0);
}

// No phone's sensors, but a car that tells its speed and how it turns.
TEST_F(InertialCarrierTest, FollowsAVehiclesWheels) {
  const std::vector<SessionEstimate> carried = Run(Sensors::kWheels);
  EXPECT_EQ(Count(EventKind::kInertialAligned), 1);
  for (int i = 60; i < 75; ++i) {
    const SessionEstimate& estimate = carried[static_cast<std::size_t>(i)];
    ASSERT_EQ(estimate.status, EstimateStatus::kFix) << i;
    EXPECT_EQ(estimate.sources, kSourceInertial) << i;
    EXPECT_FALSE(estimate.attitude.has_value()) << i;  // the car's is no phone's
    EXPECT_LT(Error(carried, i), 3.0 * estimate.accuracy_m) << i;
  }
  EXPECT_LT(Error(carried, 74), 5.0);
  EXPECT_LT(Error(carried, 89), 3.0);
}

// A receiver that gives no epochs at all meanwhile.
TEST_F(InertialCarrierTest, GoesThroughASilence) {
  const std::vector<ObservationEpoch> drive = filter_scene_.Drive(90);
  const std::unique_ptr<Session> session = filter_scene_.scene.Open();
  for (int i = 0; i < 76; ++i) {
    if (i > 0) {
      EXPECT_TRUE(session->PushSensors(Samples(i - 1)).ok());
    }
    if (i >= 60 && i < 75) continue;
    ObservationEpoch epoch = drive[static_cast<std::size_t>(i)];
    if (i == 75) epoch.signals.clear();
    const SessionEstimate estimate = ProcessEpoch(session.get(), epoch);
    if (i < 75) continue;
    ASSERT_EQ(estimate.status, EstimateStatus::kFix);
    EXPECT_EQ(estimate.sources, kSourceInertial);
    EXPECT_LT(filter_scene_.HorizontalError(estimate, i), 10.0);
    EXPECT_LT(filter_scene_.HorizontalError(estimate, i), 3.0 * estimate.accuracy_m);
  }
}

// Two axes exchanged, as no phone has them: no worse than without.
TEST_F(InertialCarrierTest, ASensorThatMovesOtherwiseDoesNoHarm) {
  const std::vector<SessionEstimate> alone = Run(Sensors::kNone);
  const std::vector<SessionEstimate> misled = Run(Sensors::kExchanged);
  double square_alone = 0.0;
  double square_misled = 0.0;
  for (int i = 20; i < 60; ++i) {
    square_alone += Error(alone, i) * Error(alone, i);
    square_misled += Error(misled, i) * Error(misled, i);
  }
  EXPECT_LT(square_misled, 1.5 * square_alone);
  EXPECT_LT(Error(misled, 89), Error(alone, 89) + 1.0);
}

// A sensor that breaks on the way: five times the turn, the force turned round.
TEST_F(InertialCarrierTest, LeavesASensorThatBreaks) {
  const std::vector<ObservationEpoch> drive = filter_scene_.Drive(60);
  const std::unique_ptr<Session> session = filter_scene_.scene.Open();
  for (int i = 0; i < 60; ++i) {
    std::vector<SensorSample> samples;
    if (i > 0) samples = Samples(i - 1);
    for (SensorSample& sample : samples) {
      if (i > 30) sample.value *= sample.kind == SensorKind::kGyroscope ? 5.0 : -1.0;
    }
    EXPECT_TRUE(session->PushSensors(samples).ok());
    const SessionEstimate estimate =
        ProcessEpoch(session.get(), drive[static_cast<std::size_t>(i)]);
    if (i == 29) {
      EXPECT_EQ(estimate.sources, kSourceGnss | kSourceInertial);
    }
    if (i == 34) {
      EXPECT_EQ(estimate.sources, kSourceGnss);
    }
    if (i < 36) continue;
    EXPECT_LT(filter_scene_.HorizontalError(estimate, i), 3.0 * estimate.accuracy_m) << i;
    EXPECT_LT(filter_scene_.HorizontalError(estimate, i), 15.0) << i;
  }
}

TEST_F(InertialCarrierTest, GoesOnWhereTheSamplesEnd) {
  const std::vector<SessionEstimate> alone = Run(Sensors::kNone);
  const std::vector<SessionEstimate> halfway = Run(Sensors::kUntilHalf);
  EXPECT_EQ(Count(EventKind::kInertialAligned), 1);
  EXPECT_EQ(Count(EventKind::kInertialLost), 1);
  EXPECT_EQ(halfway[59].status, EstimateStatus::kFix);
  EXPECT_LT(Error(halfway, 59), Error(alone, 59) + 1.0);
  EXPECT_LT(Error(halfway, 89), Error(alone, 89) + 1.0);
}

}  // namespace
}  // namespace lodemark::test
