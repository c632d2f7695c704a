#include "core/session/map_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "core/base/units.h"

namespace lodemark {
namespace {

MapInfo MapIn(const char* datum, double epoch_year) {
  MapInfo info;
  info.origin = {39.9 * kRadiansPerDegree, 116.4 * kRadiansPerDegree, 50.0};
  info.datum = datum;
  info.epoch_year = epoch_year;
  return info;
}

double MovedBy(const MapInfo& info, const MapFrame& found) {
  return (found.frame.origin_in_ecef() - EcefFromGeodetic(info.origin)).norm();
}

TEST(FrameForFix, LeavesAMapOfTodaysWgs84WhereItIs) {
  const MapInfo info = MapIn("WGS 84", 0.0);
  const MapFrame found = FrameForFix(info, 2024.5);
  EXPECT_LT(MovedBy(info, found), 1e-6);
  EXPECT_EQ(found.sigma_m, 0.0);
  EXPECT_TRUE(found.remark.empty());
}

TEST(FrameForFix, MovesAMapOfCgcs2000WithItsPlate) {
  const MapInfo info = MapIn("CGCS2000", 0.0);
  const MapFrame found = FrameForFix(info, 2024.5);
  EXPECT_NEAR(MovedBy(info, found), 0.7, 0.1);
  EXPECT_GT(found.sigma_m, 0.05);
  EXPECT_NE(found.remark.find("CGCS2000"), std::string::npos);
}

TEST(FrameForFix, IsUnsureOfAnOldMapAndOfANameItDoesNotKnow) {
  EXPECT_GT(FrameForFix(MapIn("ITRF2014", 2010.0), 2024.5).sigma_m, 0.3);
  const MapInfo info = MapIn("Potsdam", 0.0);
  const MapFrame found = FrameForFix(info, 2024.5);
  EXPECT_EQ(MovedBy(info, found), 0.0);
  EXPECT_EQ(found.sigma_m, 1.0);
  EXPECT_NE(found.remark.find("Potsdam"), std::string::npos);
}

TEST(FrameForFix, TakesAMapAsItIsWithoutADate) {
  const MapInfo info = MapIn("CGCS2000", 0.0);
  EXPECT_EQ(MovedBy(info, FrameForFix(info, std::nullopt)), 0.0);
}

TEST(YearOfGps, IsTheDecimalYear) {
  // 2024-07-02 00:00 GPS, the middle of the year: week 2321, 2 days.
  const std::int64_t time_ns = (2321LL * 7 + 2) * 86'400 * kSecond_ns;
  EXPECT_NEAR(YearOfGps(time_ns), 2024.5, 0.005);
}

}  // namespace
}  // namespace lodemark
