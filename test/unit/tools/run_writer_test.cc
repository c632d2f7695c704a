#include "tools/lodemark/run_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace lodemark {
namespace {

lodemark_estimate EstimateAt(std::int64_t time_gps_ns) {
  lodemark_estimate estimate = {};
  estimate.struct_size = sizeof estimate;
  estimate.present = LODEMARK_ESTIMATE_HAS_GPS_TIME | LODEMARK_ESTIMATE_HAS_POSITION |
                     LODEMARK_ESTIMATE_HAS_VELOCITY;
  estimate.outcome = LODEMARK_OUTCOME_FIX;
  estimate.time_gps_ns = time_gps_ns;
  estimate.latitude_deg = 48.2;
  estimate.longitude_deg = 16.37;
  estimate.velocity_enu_mps[0] = 0.0;
  return estimate;
}

// Photographs alone say nothing of the receiver's clock.
TEST(RunWriter, LeavesTheClockEmptyWhereAnEstimateDidNotHearIt) {
  const std::string folder = testing::TempDir() + "run_writer_" + std::to_string(::getpid());
  constexpr std::int64_t kStart_ns = 1'400'000'000'000'000'000;
  RunWriter writer;
  ASSERT_TRUE(writer.Open(folder, false).ok());
  lodemark_estimate estimate = EstimateAt(kStart_ns);
  writer.WriteEpoch(estimate, {}, {});
  estimate = EstimateAt(kStart_ns + 1'000'000'000);
  estimate.clock_bias_m = -12.5;
  estimate.clock_drift_mps = 0.75;
  writer.WriteEpoch(estimate, {}, {});
  ASSERT_TRUE(writer.Finish().ok());
  ReadReport report;
  const Result<Trajectory> written = ReadTrajectory(folder + "/trajectory.csv", &report);
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(written.ok()) << written.error().message;
  ASSERT_EQ(written->points().size(), 2U);
  const TrajectoryPoint& deaf = written->points()[0];
  EXPECT_FALSE(deaf.clock_bias_m.has_value());
  EXPECT_FALSE(deaf.clock_drift_mps.has_value());
  EXPECT_EQ(deaf.velocity_enu_mps[0], 0.0);
  const TrajectoryPoint& heard = written->points()[1];
  EXPECT_EQ(heard.clock_bias_m, -12.5);
  EXPECT_EQ(heard.clock_drift_mps, 0.75);
}

}  // namespace
}  // namespace lodemark
