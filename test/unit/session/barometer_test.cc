#include "core/session/barometer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "test/unit/session/filter_scene.h"

namespace lodemark::test {
namespace {

constexpr double kSamplesPerSecond = 20.0;

// Pressure of air that is so warm at the ground, by the weight of the air in between.
class Air {
 public:
  explicit Air(double ground_k, double ground_hpa = 1013.25, double ground_m = 100.0)
      : ground_k_(ground_k), ground_hpa_(ground_hpa), ground_m_(ground_m) {}

  double PressureAt(double height_m) const {
    constexpr double kGravity_mps2 = 9.80665;
    constexpr double kGas_m2ps2k = 287.053;
    constexpr int kSteps = 200;
    double pressure_hpa = ground_hpa_;
    const double step_m = (height_m - ground_m_) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double temperature_k = ground_k_ - 0.0065 * (i + 0.5) * step_m;
      pressure_hpa -= pressure_hpa * kGravity_mps2 / (kGas_m2ps2k * temperature_k) * step_m;
    }
    return pressure_hpa;
  }

 private:
  double ground_k_;
  double ground_hpa_;
  double ground_m_;
};

using Course = std::function<double(double seconds)>;

std::vector<SensorSample> Samples(double from_s, double to_s, const Course& pressure_hpa) {
  std::vector<SensorSample> samples;
  for (double s = from_s; s < to_s - 1e-9; s += 1.0 / kSamplesPerSecond) {
    samples.push_back({SensorKind::kBarometer,
                       kSceneStart_ns + std::llround(1e9 * s),
                       {pressure_hpa(s), 0.0, 0.0}});
  }
  return samples;
}

class BarometerTest : public ::testing::Test {
 protected:
  void Feel(const Course& pressure_hpa, double to_s = 60.0) {
    for (const SensorSample& sample : Samples(0.0, to_s, pressure_hpa)) sensors_.Push(sample);
  }
  std::optional<Rise> Between(double from_s, double to_s, double height_m = 100.0) const {
    return barometer_.RiseBetween(kSceneStart_ns + std::llround(1e9 * from_s),
                                  kSceneStart_ns + std::llround(1e9 * to_s), height_m, 1.0);
  }

  SensorBuffer sensors_;
  Barometer barometer_{&sensors_};
};

TEST_F(BarometerTest, TellsHowFarItRoseWhateverTheWeather) {
  for (const double warmer_k : {-25.0, 0.0, 20.0}) {
    for (const double ground_hpa : {965.0, 1013.25, 1040.0}) {
      sensors_.Forget();
      const Air air(288.15 - 0.65 + warmer_k, ground_hpa);
      Feel([&](double s) { return air.PressureAt(100.0 + 0.5 * s); });
      for (const double seconds : {0.2, 1.0, 7.3, 40.0}) {
        const std::optional<Rise> rise = Between(15.0, 15.0 + seconds);
        ASSERT_TRUE(rise.has_value());
        EXPECT_NEAR(rise->rise_m, 0.5 * seconds, 0.1 * seconds) << warmer_k;
        EXPECT_LT(std::abs(rise->rise_m - 0.5 * seconds), 2.0 * rise->sigma_m);
        EXPECT_LT(rise->sigma_m, 0.2 + 0.2 * seconds);
      }
    }
  }
}

// The mean of noise over many draws is as far off as it says.
TEST_F(BarometerTest, StatesTheScatterOfItsNoise) {
  Random random(3);
  double squares = 0.0;
  double stated = 0.0;
  constexpr double kNoise_hpa = 0.06;  // half a metre a sample: a poor one
  for (int draw = 0; draw < 300; ++draw) {
    sensors_.Forget();
    Feel([&](double) { return random.Gaussian(1001.0, kNoise_hpa); }, 14.0);
    const std::optional<Rise> rise = Between(12.0, 13.0);
    ASSERT_TRUE(rise.has_value());
    squares += rise->rise_m * rise->rise_m;
    stated += rise->sigma_m * rise->sigma_m;
  }
  EXPECT_NEAR(stated / squares, 1.0, 0.25);
}

TEST_F(BarometerTest, SaysNothingWhereItCannotBeTheAirOutside) {
  const Air air(288.15);
  const Course rising = [&](double s) { return air.PressureAt(100.0 + 0.2 * s); };
  Feel(rising);
  EXPECT_TRUE(Between(20.0, 21.0).has_value());
  EXPECT_FALSE(Between(20.0, 21.0, 2000.0).has_value());
  EXPECT_FALSE(Between(59.99, 62.0).has_value());  // no samples any more
  EXPECT_FALSE(Between(-5.0, -4.0).has_value());
  EXPECT_FALSE(Between(21.0, 20.0).has_value());
  EXPECT_FALSE(Barometer(nullptr).RiseBetween(0, 1, 0.0, 0.0).has_value());
  for (const double unit : {1e-3, 0.1, 0.750062, 0.02953}) {  // bar, kPa, mmHg, inHg
    sensors_.Forget();
    Feel([&](double s) { return unit * rising(s); });
    EXPECT_FALSE(Between(20.0, 21.0).has_value()) << unit;
  }
  sensors_.Forget();
  Feel([](double) { return 1001.3; });  // stuck
  EXPECT_FALSE(Between(20.0, 21.0).has_value());
}

// A door that shuts is no lift.
TEST_F(BarometerTest, JumpsDoNotCount) {
  const Air air(288.15);
  Feel([&](double s) { return air.PressureAt(100.0 + 0.2 * s) + (s < 30.0 ? 0.0 : 1.0); });
  const std::optional<Rise> rise = Between(25.0, 35.0);
  ASSERT_TRUE(rise.has_value());
  EXPECT_NEAR(rise->rise_m, 2.0, 3.0 * rise->sigma_m);
  EXPECT_GT(rise->sigma_m, 0.8);
  EXPECT_LT(rise->sigma_m, 3.0);
}

TEST_F(BarometerTest, IsBelievedLessWhereItErredAndAgainLater) {
  const Air air(288.15);
  Feel([&](double s) { return air.PressureAt(100.0 + 0.2 * s); });
  const double sigma_m = Between(20.0, 21.0)->sigma_m;
  barometer_.Learn(1.0, 0.2, 60.0);
  EXPECT_GT(Between(20.0, 21.0)->sigma_m, 1.5 * sigma_m);
  barometer_.Learn(1.0, 0.2, std::nan(""));
  for (int i = 0; i < 120; ++i) barometer_.Learn(1.0, i % 2 == 0 ? 0.2 : -0.2, 0.5);
  EXPECT_DOUBLE_EQ(Between(20.0, 21.0)->sigma_m, sigma_m);
}

// The air is as warm all the way up, so sixty rises are as wrong together as one of all.
TEST_F(BarometerTest, OfManyRisesTheSumIsAsUnsureAsOne) {
  const Air air(288.15);
  Feel([&](double s) { return air.PressureAt(100.0 + 4.0 * s); }, 80.0);
  const double whole_m = Between(15.0, 75.0)->sigma_m;
  double squares_m2 = 0.0;
  for (int second = 15; second < 75; ++second) {
    const std::optional<Rise> rise = Between(second, second + 1.0);
    ASSERT_TRUE(rise.has_value());
    squares_m2 += rise->sigma_m * rise->sigma_m;
    barometer_.Learn(1.0, rise->rise_m, 0.1);
  }
  EXPECT_GT(whole_m, 0.09 * 240.0);
  EXPECT_NEAR(std::sqrt(squares_m2), whole_m, 0.1 * whole_m);
}

// Samples that come a second late tell nothing of the second that has passed.
TEST_F(BarometerTest, SaysNothingOfASecondWhoseSamplesHaveNotCome) {
  const Air air(288.15);
  Feel([&](double s) { return air.PressureAt(100.0 + 0.5 * s); }, 30.0);
  EXPECT_TRUE(Between(29.0, 30.0).has_value());
  EXPECT_FALSE(Between(30.0, 31.0).has_value());
  EXPECT_FALSE(Between(29.8, 30.8).has_value());
}

// Up a hill and down again, by foot, where satellites tell the height badly.
class BarometerInSession : public ::testing::Test {
 protected:
  static constexpr int kEpochs = 150;

  BarometerInSession() : filter_scene_(Eigen::Vector3d::Zero()) {
    const Geodetic place = filter_scene_.scene.place;
    filter_scene_.scene.path = [this, place](double s) {
      const Eigen::Vector3d enu_m(1.3 * s, 0.0, RiseAt(s));
      return Eigen::Vector3d(EcefFromGeodetic(place) +
                             EnuFromEcefRotation(place).transpose() * enu_m);
    };
    drive_ = filter_scene_.Drive(kEpochs, 4, {6.0, 0.4, 0.004});
    for (ObservationEpoch& epoch : drive_) {
      for (SignalObservation& signal : epoch.signals) signal.present &= ~kHasCarrierPhase;
    }
  }

  static double RiseAt(double s) {
    return s < 40.0 ? 0.0 : 6.0 * (1.0 - std::cos(0.06 * (s - 40.0)));
  }
  Course True() const {
    const Air air(295.0, 1009.0, filter_scene_.scene.place.height_m);
    const double ground_m = filter_scene_.scene.place.height_m;
    return [air, ground_m](double s) { return air.PressureAt(ground_m + RiseAt(s)); };
  }
  // With noise of 1 Pa, and weather.
  Course Real(std::uint64_t seed) const {
    const Course truth = True();
    auto random = std::make_shared<Random>(seed);
    auto wander_hpa = std::make_shared<double>(0.0);
    return [=](double s) {
      *wander_hpa += random->Gaussian(0.0, 0.01 / std::sqrt(kSamplesPerSecond));
      return truth(s) + *wander_hpa + random->Gaussian(0.0, 0.01);
    };
  }

  std::vector<SessionEstimate> Run(const Course* pressure_hpa) const {
    const std::unique_ptr<Session> session = filter_scene_.scene.Open();
    std::vector<SessionEstimate> estimates;
    for (int i = 0; i < kEpochs; ++i) {
      if (pressure_hpa != nullptr && i > 0) {
        EXPECT_TRUE(session->PushSensors(Samples(i - 1, i, *pressure_hpa)).ok());
      }
      estimates.push_back(ProcessEpoch(session.get(), drive_[static_cast<std::size_t>(i)]));
    }
    return estimates;
  }
  // Of the height, and of how it changes: without what all have in common.
  double ScatterOfHeight(const std::vector<SessionEstimate>& estimates) const {
    double mean_m = 0.0;
    double squares_m2 = 0.0;
    for (int i = 30; i < kEpochs; ++i) {
      const double error_m = filter_scene_.ErrorEnu(estimates[static_cast<std::size_t>(i)], i).z();
      mean_m += error_m / (kEpochs - 30);
      squares_m2 += error_m * error_m / (kEpochs - 30);
    }
    return std::sqrt(squares_m2 - mean_m * mean_m);
  }
  double LargestError(const std::vector<SessionEstimate>& estimates) const {
    double largest = 0.0;  // in its sigma
    for (int i = 30; i < kEpochs; ++i) {
      const SessionEstimate& estimate = estimates[static_cast<std::size_t>(i)];
      largest = std::max(largest, std::abs(filter_scene_.ErrorEnu(estimate, i).z()) /
                                      std::sqrt(estimate.covariance_enu_m2(2, 2)));
    }
    return largest;
  }

  FilterScene filter_scene_;
  std::vector<ObservationEpoch> drive_;
};

TEST_F(BarometerInSession, FollowsAHillThatSatellitesBlur) {
  const Course pressure = Real(5);
  const std::vector<SessionEstimate> alone = Run(nullptr);
  const std::vector<SessionEstimate> with = Run(&pressure);
  EXPECT_LT(ScatterOfHeight(with), 0.6 * ScatterOfHeight(alone));
  EXPECT_LT(LargestError(with), 3.0);
  // And says so.
  EXPECT_LT(with.back().vertical_accuracy_m, alone.back().vertical_accuracy_m);
}

// No satellites on the way up.
TEST_F(BarometerInSession, KeepsTheHeightInTheDark) {
  for (std::size_t i = 60; i < 75; ++i) drive_[i].signals.clear();
  const Course pressure = Real(7);
  const std::vector<SessionEstimate> alone = Run(nullptr);
  const std::vector<SessionEstimate> with = Run(&pressure);
  const auto lost_m = [&](const std::vector<SessionEstimate>& estimates) {
    return std::abs(filter_scene_.ErrorEnu(estimates[73], 73).z() -
                    filter_scene_.ErrorEnu(estimates[59], 59).z());
  };
  ASSERT_EQ(with[73].status, EstimateStatus::kFix);
  ASSERT_EQ(alone[73].status, EstimateStatus::kFix);
  EXPECT_LT(lost_m(with), 1.5);
  EXPECT_LT(lost_m(with), 0.5 * lost_m(alone));
  EXPECT_LT(LargestError(with), 3.0);
}

// Whatever it says, the height is not much worse than without it, and not beyond what is stated.
TEST_F(BarometerInSession, DoesNoHarm) {
  const std::vector<SessionEstimate> alone = Run(nullptr);
  const double alone_m = ScatterOfHeight(alone);
  auto random = std::make_shared<Random>(9);
  const Course real = Real(6);
  const std::vector<Course> wrong = {
      [real](double s) { return real(s) + (std::fmod(s, 20.0) < 10.0 ? 0.0 : 1.0); },  // a window
      [real](double s) { return real(s) + 0.5 * std::clamp(s - 60.0, 0.0, 3.0); },  // ventilation
      [real](double s) { return s < 60.0 ? real(s) : 1009.0; },                     // stuck
      [random](double) { return random->Uniform(950.0, 1050.0); },                  // wild
      [real](double s) { return 0.01 * real(s); }};
  for (const Course& pressure : wrong) {
    const std::vector<SessionEstimate> misled = Run(&pressure);
    EXPECT_LT(ScatterOfHeight(misled), 1.25 * alone_m);
    EXPECT_LT(LargestError(misled), 4.0);
  }
}

}  // namespace
}  // namespace lodemark::test
