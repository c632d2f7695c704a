#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "lodemark/lodemark.h"

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(EcefFromGeodetic, AgreesWithThePublishedExample) {
  // GeographicLib, CartConvert(1), EXAMPLES.
  const double geodetic[3] = {33.3, 44.4, 6000.0};
  double ecef_m[3];
  ASSERT_EQ(lodemark_ecef_from_geodetic(geodetic, ecef_m), LODEMARK_OK);
  EXPECT_NEAR(ecef_m[0], 3816209.60, 0.006);
  EXPECT_NEAR(ecef_m[1], 3737108.55, 0.006);
  EXPECT_NEAR(ecef_m[2], 3485109.57, 0.006);
}

TEST(GeodeticFromEcef, ReturnsWhereItCameFromInPlace) {
  for (const double latitude_deg : {-90.0, -33.0, 0.0, 51.5, 90.0}) {
    for (const double longitude_deg : {-180.0, -0.1, 0.0, 139.7}) {
      double point[3] = {latitude_deg, longitude_deg, 123.0};
      ASSERT_EQ(lodemark_ecef_from_geodetic(point, point), LODEMARK_OK);
      ASSERT_EQ(lodemark_geodetic_from_ecef(point, point), LODEMARK_OK);
      EXPECT_NEAR(point[0], latitude_deg, 1e-12);
      if (std::abs(latitude_deg) < 90.0) {
        EXPECT_NEAR(std::remainder(point[1] - longitude_deg, 360.0), 0.0, 1e-12);
      }
      EXPECT_NEAR(point[2], 123.0, 1e-8);
    }
  }
}

TEST(EnuFromEcef, HasItsAxesEastNorthUp) {
  // On the equator at 90 degrees east, east is -x, north is z and up is y.
  const double origin[3] = {0.0, 90.0, 0.0};
  const double point[3] = {-1.0, 6378137.0 + 3.0, 2.0};
  double enu_m[3];
  ASSERT_EQ(lodemark_enu_from_ecef(origin, point, enu_m), LODEMARK_OK);
  EXPECT_NEAR(enu_m[0], 1.0, 1e-8);
  EXPECT_NEAR(enu_m[1], 2.0, 1e-8);
  EXPECT_NEAR(enu_m[2], 3.0, 1e-8);
  double back[3];
  ASSERT_EQ(lodemark_ecef_from_enu(origin, enu_m, back), LODEMARK_OK);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], point[i], 1e-8);
}

TEST(Conversions, RefuseNullAndNonsense) {
  const double good[3] = {1.0, 2.0, 3.0};
  double out[3] = {7.0, 7.0, 7.0};
  EXPECT_EQ(lodemark_ecef_from_geodetic(nullptr, out), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lodemark_ecef_from_geodetic(good, nullptr), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lodemark_geodetic_from_ecef(nullptr, out), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lodemark_geodetic_from_ecef(good, nullptr), LODEMARK_ERROR_INVALID_ARGUMENT);
  for (const auto convert : {lodemark_enu_from_ecef, lodemark_ecef_from_enu}) {
    EXPECT_EQ(convert(nullptr, good, out), LODEMARK_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(convert(good, nullptr, out), LODEMARK_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(convert(good, good, nullptr), LODEMARK_ERROR_INVALID_ARGUMENT);
  }
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e10}) {
    for (int i = 0; i < 3; ++i) {
      double point[3] = {1.0, 2.0, 3.0};
      point[i] = bad;
      EXPECT_EQ(lodemark_ecef_from_geodetic(point, out), LODEMARK_ERROR_INVALID_ARGUMENT);
      EXPECT_EQ(lodemark_geodetic_from_ecef(point, out), LODEMARK_ERROR_INVALID_ARGUMENT);
      EXPECT_EQ(lodemark_enu_from_ecef(point, good, out), LODEMARK_ERROR_INVALID_ARGUMENT);
      EXPECT_EQ(lodemark_enu_from_ecef(good, point, out), LODEMARK_ERROR_INVALID_ARGUMENT);
      EXPECT_EQ(lodemark_ecef_from_enu(point, good, out), LODEMARK_ERROR_INVALID_ARGUMENT);
      EXPECT_EQ(lodemark_ecef_from_enu(good, point, out), LODEMARK_ERROR_INVALID_ARGUMENT);
    }
  }
  const double beyond_the_pole[3] = {90.1, 0.0, 0.0};
  EXPECT_EQ(lodemark_ecef_from_geodetic(beyond_the_pole, out), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "geodetic.latitude is out of range");
  EXPECT_EQ(out[0], 7.0) << "an error leaves the output alone";
}

struct Instant {
  std::int64_t gps_s;
  std::int64_t unix_s;
};

TEST(UnixFromGps, KnowsTheLeapSeconds) {
  // The two epochs; GPS second 1e9 (2011-09-14 01:46:25 UTC, 15 s); 2017-01-01 (18 s).
  for (const Instant instant : {Instant{0, 315964800}, Instant{1'000'000'000, 1315964785},
                                Instant{1167264018, 1483228800}}) {
    std::int64_t time_ns = 0;
    ASSERT_EQ(lodemark_unix_from_gps(instant.gps_s * 1'000'000'000 + 7, &time_ns), LODEMARK_OK);
    EXPECT_EQ(time_ns, instant.unix_s * 1'000'000'000 + 7);
    ASSERT_EQ(lodemark_gps_from_unix(instant.unix_s * 1'000'000'000 + 7, &time_ns), LODEMARK_OK);
    EXPECT_EQ(time_ns, instant.gps_s * 1'000'000'000 + 7);
  }
}

TEST(UnixFromGps, RefusesTimesOutsideTheCalendar) {
  std::int64_t time_ns = 7;
  for (const std::int64_t bad : {std::int64_t{-1}, INT64_MIN, INT64_MAX}) {
    EXPECT_EQ(lodemark_unix_from_gps(bad, &time_ns), LODEMARK_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(lodemark_gps_from_unix(bad, &time_ns), LODEMARK_ERROR_INVALID_ARGUMENT);
  }
  EXPECT_EQ(lodemark_unix_from_gps(0, nullptr), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lodemark_gps_from_unix(1483228800'000'000'000, nullptr),
            LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(time_ns, 7);
}

}  // namespace
