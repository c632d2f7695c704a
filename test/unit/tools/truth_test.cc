#include "tools/lodemark/truth.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tools/lodemark/run_errors.h"

namespace lodemark {
namespace {

constexpr std::int64_t kStart_ns = 1'400'000'000'000'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

TrajectoryPoint PointAt(std::int64_t second, double latitude_deg, double longitude_deg) {
  TrajectoryPoint point;
  point.time_gps_ns = kStart_ns + second * kSecond;
  point.latitude_deg = latitude_deg;
  point.longitude_deg = longitude_deg;
  point.height_m = 10.0;
  return point;
}

Truth TruthOf(std::vector<TrajectoryPoint> points) {
  return {Trajectory(std::move(points)), {}, "truth.csv"};
}

TEST(Truth, OnePointHoldsAtAllTimesAndIsAtRest) {
  const auto long_after = TruthOf({PointAt(0, 30.0, 114.0)}).At(kStart_ns + 86'400 * kSecond);
  ASSERT_TRUE(long_after.has_value());
  EXPECT_EQ(long_after->latitude_deg, 30.0);
  EXPECT_EQ(long_after->velocity_enu_mps[0], 0.0);
}

TEST(Truth, OfSeveralPointsKnowsNoVelocityThatTheFileLacks) {
  const auto point =
      TruthOf({PointAt(0, 30.0, 114.0), PointAt(1, 30.0, 114.0)}).At(kStart_ns + kSecond / 2);
  ASSERT_TRUE(point.has_value());
  EXPECT_FALSE(point->velocity_enu_mps[0].has_value());
}

TEST(Truth, ReachesFiveMillisecondsBeyondItsEnds) {
  const Truth truth = TruthOf({PointAt(0, 30.0, 114.0), PointAt(1, 31.0, 114.0)});
  const auto after = truth.At(kStart_ns + kSecond + 4'900'000);
  ASSERT_TRUE(after.has_value());
  EXPECT_EQ(after->latitude_deg, 31.0);
  EXPECT_TRUE(truth.At(kStart_ns - 4'900'000).has_value());
  EXPECT_FALSE(truth.At(kStart_ns + kSecond + 5'100'000).has_value());
  EXPECT_FALSE(truth.At(kStart_ns - 5'100'000).has_value());
}

RunFolder RunWith(std::vector<TrajectoryPoint> epochs) {
  RunFolder run;
  run.path = "run";
  run.epochs = std::move(epochs);
  return run;
}

TrajectoryPoint EstimateAt(std::int64_t second, double latitude_deg, double longitude_deg) {
  TrajectoryPoint point = PointAt(second, latitude_deg, longitude_deg);
  point.height_m = 12.0;
  return point;
}

TEST(ErrorsAgainst, MeasuresInEastNorthUp) {
  const Truth truth = TruthOf({PointAt(0, 0.0, 114.0)});
  // On the equator 1e-5 degree is 1.113195 m of longitude and 1.105743 m of latitude (WGS 84).
  const auto result = ErrorsAgainst(RunWith({EstimateAt(0, -1e-5, 114.00001)}), truth);
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result->errors.size(), 1u);
  EXPECT_NEAR(result->errors[0].east_m, 1.113195, 1e-5);
  EXPECT_NEAR(result->errors[0].north_m, -1.105743, 1e-5);
  EXPECT_NEAR(*result->errors[0].up_m, 2.0, 1e-6);
}

TEST(ErrorsAgainst, LeavesTheHeightOutWhereEitherIsUnknown) {
  TrajectoryPoint flat = PointAt(0, 0.0, 114.0);
  flat.height_m.reset();
  const auto result = ErrorsAgainst(RunWith({EstimateAt(0, 0.0, 114.00001)}), TruthOf({flat}));
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result->errors[0].up_m.has_value());
  EXPECT_NEAR(result->errors[0].east_m, 1.113195, 1e-5);
}

TEST(ErrorsAgainst, CountsExpectedOnlyWhereTheTruthIsKnown) {
  const Truth truth = TruthOf({PointAt(0, 30.0, 114.0), PointAt(1, 30.0, 114.0)});
  TrajectoryPoint silent;
  silent.time_gps_ns = kStart_ns + kSecond;
  const auto result = ErrorsAgainst(
      RunWith({EstimateAt(0, 30.0, 114.0), silent, EstimateAt(9, 30.0, 114.0)}), truth);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->expected_epochs, 2);
  EXPECT_EQ(result->errors.size(), 1u);
  EXPECT_EQ(result->epochs_without_truth, 1);
}

TEST(ErrorsAgainst, RefusesTheTruthOfAnotherPlace) {
  const Truth truth = TruthOf({PointAt(0, 30.0, 114.0)});
  const auto result = ErrorsAgainst(RunWith({EstimateAt(0, 31.0, 114.0)}), truth);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kBadData);
  EXPECT_NE(result.error().message.find("111 km"), std::string::npos) << result.error().message;
}

TEST(ErrorsAgainst, AcceptsAWildEstimateAmongGoodOnes) {
  const Truth truth = TruthOf({PointAt(0, 30.0, 114.0)});
  const auto result =
      ErrorsAgainst(RunWith({EstimateAt(0, 30.0, 114.0), EstimateAt(1, 31.0, 114.0)}), truth);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->errors.size(), 2u);
}

TEST(ErrorsAgainst, RefusesTheTruthOfAnotherTime) {
  const Truth truth = TruthOf({PointAt(0, 30.0, 114.0), PointAt(1, 30.0, 114.0)});
  const auto result = ErrorsAgainst(RunWith({EstimateAt(86'400, 30.0, 114.0)}), truth);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("another time"), std::string::npos);
}

}  // namespace
}  // namespace lodemark
