#include "tools/lodemark/report_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "tools/lodemark/report_signals.h"
#include "tools/report/motion_data.h"

namespace lodemark {
namespace {

constexpr std::int64_t kStart_ns = 1'400'000'000'000'000'000;

TrajectoryPoint PointAt(std::int64_t time_ns, double east_m, double north_m, double up_m) {
  const EnuFrame frame(Geodetic{0.5, 2.0, 20.0});
  const Geodetic place = GeodeticFromEcef(frame.ToEcef({east_m, north_m, up_m}));
  TrajectoryPoint point;
  point.time_gps_ns = kStart_ns + time_ns;
  point.latitude_deg = place.latitude_rad * kDegreesPerRadian;
  point.longitude_deg = place.longitude_rad * kDegreesPerRadian;
  point.height_m = place.height_m;
  return point;
}

// Ten seconds at 3 m/s east, 4 m/s south and 1 m/s down, a point a second.
Truth StraightTruth() {
  std::vector<TrajectoryPoint> points;
  for (int i = 0; i <= 10; ++i) points.push_back(PointAt(i * kSecond_ns, 3.0 * i, -4.0 * i, -i));
  return {Trajectory(std::move(points)), {}, "truth.csv"};
}

TEST(TruthVelocity, IsThatOfThePositionsWhereNoneIsStated) {
  const Truth truth = StraightTruth();
  const TruthVelocity velocity(truth);
  EXPECT_TRUE(velocity.by_differences());
  const auto at = velocity.At(kStart_ns + 4 * kSecond_ns + 300'000'000);
  ASSERT_TRUE(at.has_value());
  EXPECT_NEAR(at->east_mps, 3.0, 1e-3);
  EXPECT_NEAR(at->north_mps, -4.0, 1e-3);
  EXPECT_NEAR(*at->up_mps, -1.0, 1e-3);
  EXPECT_FALSE(velocity.At(kStart_ns + 10 * kSecond_ns).has_value());
  EXPECT_FALSE(velocity.At(kStart_ns - kSecond_ns).has_value());
}

TEST(TruthVelocity, IsTheStatedOneWhereThereIsOne) {
  std::vector<TrajectoryPoint> points = StraightTruth().track.points();
  for (TrajectoryPoint& point : points) point.velocity_enu_mps = {7.0, 0.0, std::nullopt};
  const Truth truth{Trajectory(std::move(points)), {}, "truth.csv"};
  const TruthVelocity velocity(truth);
  EXPECT_FALSE(velocity.by_differences());
  EXPECT_DOUBLE_EQ(velocity.At(kStart_ns)->east_mps, 7.0);
  EXPECT_FALSE(velocity.At(kStart_ns)->up_mps.has_value());
}

TEST(TruthVelocity, OfAPlaceAtRestIsNone) {
  const Truth truth{Trajectory({PointAt(0, 0.0, 0.0, 0.0)}), {}, "truth.csv"};
  const TruthVelocity velocity(truth);
  EXPECT_FALSE(velocity.by_differences());
  EXPECT_EQ(velocity.At(kStart_ns + 100 * kSecond_ns)->east_mps, 0.0);
}

TEST(VelocityErrors, AreTakenWhereBothKnowTheVelocity) {
  const Truth truth = StraightTruth();
  RunFolder run;
  for (int i = 0; i <= 10; ++i) {
    TrajectoryPoint epoch = PointAt(i * kSecond_ns, 0.0, 0.0, 0.0);
    // 0.3 and 0.4 m/s off; the last second is out of the truth's reach.
    epoch.velocity_enu_mps = {3.3, -3.6, i == 5 ? std::optional<double>() : 1.0};
    epoch.speed_accuracy_mps = i < 3 ? 1.0 : 0.1;
    run.epochs.push_back(epoch);
  }
  const ReportVelocityErrors errors = VelocityErrorsOf(run, TruthVelocity(truth));
  ASSERT_TRUE(errors.horizontal_mps && errors.up_mps && errors.within_accuracy);
  EXPECT_NEAR((*errors.horizontal_mps)[0], 0.5, 1e-3);
  EXPECT_NEAR((*errors.horizontal_mps)[1], 0.5, 1e-3);
  EXPECT_NEAR((*errors.up_mps)[1], 2.0, 1e-3);
  EXPECT_NEAR(*errors.within_accuracy, 2.0 / 9.0, 1e-9);  // of seconds 1 to 9
  EXPECT_FALSE(VelocityErrorsOf({}, TruthVelocity(truth)).horizontal_mps.has_value());
}

TEST(AddMotion, LeavesOutAClockThatWasNotHeard) {
  TrajectoryPoint epoch;
  epoch.velocity_enu_mps = {3.0, -4.0, 0.5};
  epoch.clock_drift_mps = -2.0;
  ReportEpoch drawn;
  AddMotion(epoch, &drawn);
  EXPECT_DOUBLE_EQ(*drawn.speed_mps, 5.0);
  EXPECT_DOUBLE_EQ(*drawn.climb_mps, 0.5);
  EXPECT_FALSE(drawn.clock_bias_m.has_value());
  EXPECT_DOUBLE_EQ(*drawn.clock_drift_mps, -2.0);
}

RunSignal Row(std::int64_t time_ns, std::string_view reason, double residual_m, double rate_mps) {
  RunSignal row;
  row.time_gps_ns = time_ns;
  row.satellite = "G07";
  row.signal = "1C";
  row.reason = reason;
  row.used = reason != "outlier";
  row.residual_m = residual_m;
  row.sigma_m = 2.0;
  row.range_rate_residual_mps = rate_mps;
  return row;
}

TEST(ReportSignals, KeepTheWorstResidualOfASlice) {
  ReportSignals signals(0, 9, 3);
  signals.Add(Row(0, "used", 1.0, -0.3));
  signals.Add(Row(1, "outlier", -30.0, 0.1));
  signals.Add(Row(2, "down_weighted", 8.0, 0.2));
  signals.Add(Row(9, "used", -3.0, 0.0));
  const ReportSignal signal = signals.Finish().at(0);
  ASSERT_TRUE(signal.code_residual_sigmas[0] && signal.rate_residual_mps[0]);
  EXPECT_DOUBLE_EQ(signal.code_residual_sigmas[0]->value, -15.0);
  EXPECT_EQ(signal.code_residual_sigmas[0]->state, ReportSignalState::kRejected);
  EXPECT_DOUBLE_EQ(signal.rate_residual_mps[0]->value, -0.3);
  EXPECT_EQ(signal.rate_residual_mps[0]->state, ReportSignalState::kUsed);
  EXPECT_FALSE(signal.code_residual_sigmas[1].has_value());
  EXPECT_EQ(signal.beyond_3_sigma, 1);
  EXPECT_EQ(signal.code_residuals, 3);
}

TEST(AppendResiduals, WritesALevelAndAStateForEachSlice) {
  ReportSignal signal;
  const auto used = ReportSignalState::kUsed;
  signal.code_residual_sigmas = {ReportResidual{0.0, used},
                                 std::nullopt,
                                 ReportResidual{-0.5, ReportSignalState::kDownWeighted},
                                 ReportResidual{1e9, ReportSignalState::kRejected},
                                 ReportResidual{-8.0, used},
                                 ReportResidual{std::nan(""), used}};
  signal.rate_residual_mps.resize(2);
  signal.code_residuals = 5;
  std::string text = "{";
  AppendResiduals(signal, 0.01, &text);
  const auto json = nlohmann::json::parse(text + "}");
  EXPECT_EQ(json["code"], "f-d+A-");
  EXPECT_EQ(json["codeStates"], "u-druu");
  EXPECT_EQ(json["rate"], "");
  EXPECT_EQ(json["beyond"], nlohmann::json::parse("[0, 5]"));
}

TEST(RateStep, LeavesRoomForWhatIsUsual) {
  ReportSignal signal;
  for (int i = 0; i < 100; ++i)
    signal.rate_residual_mps.push_back(ReportResidual{i < 95 ? 0.31 : 900.0});
  EXPECT_NEAR(RateStep_mps({signal}), 0.02, 1e-9);
  EXPECT_GT(RateStep_mps({}), 0.0);
  signal.rate_residual_mps.assign(3, ReportResidual{0.0});
  EXPECT_GT(RateStep_mps({signal}), 0.0);
}

TEST(AppendMotion, LeavesOutColumnsThatNobodyKnows) {
  std::vector<ReportEpoch> epochs(3);
  epochs[1].speed_mps = 1.25;
  epochs[1].sources = "gnss+</script>";
  std::string text = "{";
  AppendMotion(epochs, &text);
  EXPECT_EQ(text.find('<'), std::string::npos);
  const auto json = nlohmann::json::parse(text + "}");
  EXPECT_EQ(json["speed"], nlohmann::json::parse("[null, 125, null]"));
  EXPECT_TRUE(json["bias"].empty());
  EXPECT_EQ(json["sources"][json["source"][1].get<std::size_t>()], "gnss+</script>");
  EXPECT_EQ(json["sources"][json["source"][2].get<std::size_t>()], "");
}

}  // namespace
}  // namespace lodemark
