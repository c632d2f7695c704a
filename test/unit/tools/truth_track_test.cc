#include "tools/lodemark/truth_track.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <limits>

#include "tools/lodemark/command.h"
#include "tools/lodemark/run_errors.h"

namespace lodemark {
namespace {

constexpr std::int64_t kStart_ns = 1'400'000'000'000'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

TruthPoint PointAt(std::int64_t second, double latitude_deg, double longitude_deg,
                   std::optional<double> height_m = 10.0) {
  return {kStart_ns + second * kSecond, latitude_deg, longitude_deg, height_m, {}};
}

TEST(TruthTrack, OnePointHoldsAtAllTimesAndIsAtRest) {
  const TruthTrack track({PointAt(0, 30.0, 114.0)});
  const auto long_after = track.At(kStart_ns + 86'400 * kSecond);
  ASSERT_TRUE(long_after.has_value());
  EXPECT_EQ(long_after->latitude_deg, 30.0);
  EXPECT_EQ(long_after->velocity_enu_mps[0], 0.0);
}

TEST(TruthTrack, IsLinearBetweenNeighbours) {
  const TruthTrack track({PointAt(0, 30.0, 114.0, 10.0), PointAt(2, 30.0002, 114.0004, 14.0)});
  const auto point = track.At(kStart_ns + kSecond / 2);
  ASSERT_TRUE(point.has_value());
  EXPECT_NEAR(point->latitude_deg, 30.00005, 1e-12);
  EXPECT_NEAR(point->longitude_deg, 114.0001, 1e-12);
  EXPECT_NEAR(*point->height_m, 11.0, 1e-12);
}

TEST(TruthTrack, BridgesThreeSecondsButNoMore) {
  const TruthTrack track(
      {PointAt(0, 30.0, 114.0), PointAt(3, 30.0, 114.0), PointAt(7, 30.0, 114.0)});
  EXPECT_TRUE(track.At(kStart_ns + kSecond).has_value());
  EXPECT_FALSE(track.At(kStart_ns + 5 * kSecond).has_value());
  EXPECT_TRUE(track.At(kStart_ns + 7 * kSecond).has_value());
  EXPECT_FALSE(track.At(kStart_ns - 1).has_value());
  EXPECT_FALSE(track.At(kStart_ns + 7 * kSecond + 1).has_value());
}

TEST(TruthTrack, CrossesTheDateLineTheShortWay) {
  const TruthTrack track({PointAt(0, 0.0, 179.9999), PointAt(1, 0.0, -179.9999)});
  EXPECT_NEAR(std::abs(track.At(kStart_ns + kSecond / 2)->longitude_deg), 180.0, 1e-9);
}

TEST(TruthTrack, LeavesUnknownFieldsUnknown) {
  const TruthTrack track({PointAt(0, 30.0, 114.0, std::nullopt), PointAt(1, 30.0, 114.0)});
  const auto point = track.At(kStart_ns + kSecond / 2);
  ASSERT_TRUE(point.has_value());
  EXPECT_FALSE(point->height_m.has_value());
  EXPECT_FALSE(point->velocity_enu_mps[0].has_value());
}

TEST(TruthTrack, SurvivesTimesAtTheEndsOfTheRange) {
  TruthPoint first = PointAt(0, 30.0, 114.0);
  TruthPoint last = first;
  first.time_gps_ns = std::numeric_limits<std::int64_t>::min();
  last.time_gps_ns = std::numeric_limits<std::int64_t>::max();
  EXPECT_FALSE(TruthTrack({first, last}).At(0).has_value());
}

RunFolder RunWith(std::vector<RunEpoch> epochs) {
  RunFolder run;
  run.path = "run";
  run.epochs = std::move(epochs);
  return run;
}

RunEpoch EstimateAt(std::int64_t second, double latitude_deg, double longitude_deg) {
  RunEpoch epoch;
  epoch.time_gps_ns = kStart_ns + second * kSecond;
  epoch.answered = true;
  epoch.latitude_deg = latitude_deg;
  epoch.longitude_deg = longitude_deg;
  epoch.height_m = 12.0;
  return epoch;
}

TEST(ErrorsAgainst, MeasuresInEastNorthUp) {
  const TruthTrack truth({PointAt(0, 0.0, 114.0)});
  // On the equator 1e-5 degree is 1.113195 m of longitude and 1.105743 m of latitude (WGS 84).
  const auto result = ErrorsAgainst(RunWith({EstimateAt(0, -1e-5, 114.00001)}), truth);
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result->errors.size(), 1u);
  EXPECT_NEAR(result->errors[0].east_m, 1.113195, 1e-5);
  EXPECT_NEAR(result->errors[0].north_m, -1.105743, 1e-5);
  EXPECT_NEAR(*result->errors[0].up_m, 2.0, 1e-6);
}

TEST(ErrorsAgainst, CountsExpectedOnlyWhereTheTruthIsKnown) {
  const TruthTrack truth({PointAt(0, 30.0, 114.0), PointAt(1, 30.0, 114.0)});
  RunEpoch silent;
  silent.time_gps_ns = kStart_ns + kSecond;
  const auto result = ErrorsAgainst(
      RunWith({EstimateAt(0, 30.0, 114.0), silent, EstimateAt(9, 30.0, 114.0)}), truth);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->expected_epochs, 2);
  EXPECT_EQ(result->errors.size(), 1u);
  EXPECT_EQ(result->epochs_without_truth, 1);
}

TEST(ErrorsAgainst, RefusesTheTruthOfAnotherPlace) {
  const TruthTrack truth({PointAt(0, 30.0, 114.0)});
  const auto result = ErrorsAgainst(RunWith({EstimateAt(0, 31.0, 114.0)}), truth);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kBadData);
  EXPECT_NE(result.error().message.find("111 km"), std::string::npos) << result.error().message;
}

TEST(ErrorsAgainst, AcceptsAWildEstimateAmongGoodOnes) {
  const TruthTrack truth({PointAt(0, 30.0, 114.0)});
  const auto result =
      ErrorsAgainst(RunWith({EstimateAt(0, 30.0, 114.0), EstimateAt(1, 31.0, 114.0)}), truth);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->errors.size(), 2u);
}

TEST(ErrorsAgainst, RefusesTheTruthOfAnotherTime) {
  const TruthTrack truth({PointAt(0, 30.0, 114.0), PointAt(1, 30.0, 114.0)});
  const auto result = ErrorsAgainst(RunWith({EstimateAt(86'400, 30.0, 114.0)}), truth);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("another time"), std::string::npos);
}

}  // namespace
}  // namespace lodemark
