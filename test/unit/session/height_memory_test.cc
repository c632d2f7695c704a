#include "core/session/height_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "test/unit/session/session_scene.h"

namespace lodemark::test {
namespace {

SessionEstimate FixAt(double height_m, double sigma_m) {
  SessionEstimate estimate;
  estimate.status = EstimateStatus::kFix;
  estimate.time_gps_ns = kSceneStart_ns;
  estimate.position.height_m = height_m;
  estimate.covariance_enu_m2 = Eigen::Matrix3d::Identity() * sigma_m * sigma_m;
  return estimate;
}

TEST(HeightMemory, IsEmptyBeforeAFixAndLongAfter) {
  HeightMemory memory;
  EXPECT_FALSE(memory.At(kSceneStart_ns).has_value());
  memory.Learn(FixAt(100.0, 6.0));
  EXPECT_TRUE(memory.At(kSceneStart_ns + kSecond_ns).has_value());
  EXPECT_FALSE(memory.At(kSceneStart_ns - kSecond_ns).has_value());
  EXPECT_FALSE(memory.At(kSceneStart_ns + 3600 * kSecond_ns).has_value());
  memory.Forget();
  EXPECT_FALSE(memory.At(kSceneStart_ns + kSecond_ns).has_value());
}

TEST(HeightMemory, GrowsVagueWithTimeAndSpeed) {
  HeightMemory memory;
  memory.Learn(FixAt(100.0, 6.0));
  const double soon_m = memory.At(kSceneStart_ns + kSecond_ns)->sigma_m;
  const double later_m = memory.At(kSceneStart_ns + 20 * kSecond_ns)->sigma_m;
  EXPECT_GE(soon_m, 6.0);
  EXPECT_GT(later_m, 2.0 * soon_m);
  // Standing still says more than not knowing.
  SessionEstimate still = FixAt(100.0, 6.0);
  still.has_velocity = true;
  still.velocity_covariance_enu_m2ps2 = Eigen::Matrix3d::Identity();
  memory.Learn(still);
  EXPECT_LT(memory.At(kSceneStart_ns + 20 * kSecond_ns)->sigma_m, later_m);
}

TEST(HeightMemory, FollowsAMeasuredClimb) {
  SessionEstimate climbing = FixAt(100.0, 6.0);
  climbing.has_velocity = true;
  climbing.velocity_enu_mps = {15.0, 0.0, 1.5};
  climbing.velocity_covariance_enu_m2ps2 = 0.01 * Eigen::Matrix3d::Identity();
  HeightMemory memory;
  memory.Learn(climbing);
  EXPECT_NEAR(memory.At(kSceneStart_ns + 2 * kSecond_ns)->height_m, 103.0, 0.1);
}

struct HeightErrors {
  double mean_m = 0.0;
  double rmse_m = 0.0;
};

// A drive of two minutes with 5 m of noise in each range.
HeightErrors Drive(bool memory, bool doppler, double climb_mps) {
  SessionScene scene({kSceneGps});
  scene.options.height_memory = memory;
  scene.velocity_enu_mps = {15.0, 0.0, climb_mps};
  const std::unique_ptr<Session> session = scene.Open();
  std::mt19937_64 random(9);
  std::normal_distribution<double> noise_m(0.0, 5.0);
  HeightErrors errors;
  int count = 0;
  for (int second = 0; second < 120; ++second) {
    ObservationEpoch epoch = scene.Epoch(second);
    for (SignalObservation& signal : epoch.signals) {
      signal.pseudorange_m += noise_m(random);
      if (!doppler) signal.present &= ~static_cast<std::uint32_t>(kHasDoppler);
    }
    const SessionEstimate& estimate = ProcessEpoch(session.get(), epoch);
    if (estimate.status != EstimateStatus::kFix) continue;
    const double truth_m = GeodeticFromEcef(scene.PlaceAt(second)).height_m;
    const double error_m = estimate.position.height_m - truth_m;
    errors.mean_m += error_m;
    errors.rmse_m += error_m * error_m;
    ++count;
  }
  errors.mean_m /= count;
  errors.rmse_m = std::sqrt(errors.rmse_m / count);
  return errors;
}

TEST(HeightMemory, HelpsOnTheLevelAndDoesNoHarmOnHills) {
  for (const bool doppler : {true, false}) {
    for (const double climb_mps : {0.0, 1.5, -1.5}) {
      const HeightErrors without = Drive(false, doppler, climb_mps);
      const HeightErrors with = Drive(true, doppler, climb_mps);
      EXPECT_LT(with.rmse_m, without.rmse_m) << doppler << climb_mps;
      EXPECT_LT(std::abs(with.mean_m - without.mean_m), 1.5) << doppler << climb_mps;
    }
  }
}

}  // namespace
}  // namespace lodemark::test
