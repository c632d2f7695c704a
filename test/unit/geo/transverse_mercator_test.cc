#include "core/geo/transverse_mercator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

Geodetic Degrees(double latitude_deg, double longitude_deg, double height_m = 0.0) {
  return {latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, height_m};
}

TEST(TransverseMercator, PutsTheCentralMeridianAtTheFalseEasting) {
  const auto grid = GridByName("utm31N");
  ASSERT_TRUE(grid.has_value());
  const Eigen::Vector3d at = GridFromGeodetic(*grid, Degrees(0.0, 3.0, 12.5));
  EXPECT_NEAR(at.x(), 500'000.0, 1e-9);
  EXPECT_NEAR(at.y(), 0.0, 1e-9);
  EXPECT_EQ(at.z(), 12.5);
}

// The example of GeoConvert's manual: 38SMB4488, the middle of a square of a kilometre.
TEST(TransverseMercator, AgreesWithAPublishedPlace) {
  const auto grid = GridByName("38N");
  ASSERT_TRUE(grid.has_value());
  const auto place = GeodeticFromGrid(*grid, 444'500.0, 3'688'500.0, 0.0);
  ASSERT_TRUE(place.has_value());
  EXPECT_NEAR(place->latitude_rad * kDegreesPerRadian, 33.33424, 0.5e-5);
  EXPECT_NEAR(place->longitude_rad * kDegreesPerRadian, 44.40363, 0.5e-5);
}

// Redfearn's series written down independently (to the terms in longitude to the fourth), good to
// a millimetre within a degree.
Eigen::Vector2d Redfearn(double latitude, double longitude_off, double scale) {
  const double a = 6'378'137.0;
  const double f = 1.0 / 298.257223563;
  const double e2 = f * (2.0 - f);
  const double n = f / (2.0 - f);
  const double meridian = a / (1.0 + n) *
                          ((1.0 + n * n / 4.0 + n * n * n * n / 64.0) * latitude -
                           1.5 * (n - n * n * n / 8.0) * std::sin(2.0 * latitude) +
                           15.0 / 16.0 * (n * n - n * n * n * n / 4.0) * std::sin(4.0 * latitude) -
                           35.0 / 48.0 * n * n * n * std::sin(6.0 * latitude));
  const double s = std::sin(latitude);
  const double c = std::cos(latitude);
  const double t = std::tan(latitude);
  const double nu = a / std::sqrt(1.0 - e2 * s * s);
  const double psi = (1.0 - e2 * s * s) / (1.0 - e2);
  const double w = longitude_off * c;
  const double x = nu * w * (1.0 + w * w / 6.0 * (psi - t * t));
  const double y = meridian + nu * s * longitude_off * w / 2.0 *
                                  (1.0 + w * w / 12.0 * (4.0 * psi * psi + psi - t * t));
  return scale * Eigen::Vector2d(x, y);
}

TEST(TransverseMercator, AgreesWithRedfearnsSeriesNearTheMeridian) {
  const auto grid = GridByName("tm:114,1,500000,0");
  ASSERT_TRUE(grid.has_value());
  for (const double latitude_deg : {-50.0, -10.0, 5.0, 30.5, 61.0}) {
    for (const double off_deg : {-0.4, -0.1, 0.2, 0.4}) {
      const Eigen::Vector3d at = GridFromGeodetic(*grid, Degrees(latitude_deg, 114.0 + off_deg));
      const Eigen::Vector2d expected =
          Redfearn(latitude_deg * kRadiansPerDegree, off_deg * kRadiansPerDegree, 1.0);
      EXPECT_NEAR(at.x() - 500'000.0, expected.x(), 1e-3);
      EXPECT_NEAR(at.y(), expected.y(), 1e-3);
    }
  }
}

TEST(TransverseMercator, ComesBack) {
  for (const char* const name : {"11N", "utm58S", "tm:9,0.9999,3500000,-100"}) {
    const auto grid = GridByName(name);
    ASSERT_TRUE(grid.has_value()) << name;
    const double meridian_deg = grid->central_meridian_rad * kDegreesPerRadian;
    for (double latitude_deg = -79.0; latitude_deg < 80.0; latitude_deg += 13.0) {
      const Geodetic place = Degrees(latitude_deg, meridian_deg + 2.5, -31.0);
      const Eigen::Vector3d at = GridFromGeodetic(*grid, place);
      const auto back = GeodeticFromGrid(*grid, at.x(), at.y(), at.z());
      ASSERT_TRUE(back.has_value());
      EXPECT_NEAR(back->latitude_rad, place.latitude_rad, 1e-14);
      EXPECT_NEAR(std::remainder(back->longitude_rad - place.longitude_rad, 2.0 * kPi), 0.0, 1e-13);
      EXPECT_EQ(back->height_m, -31.0);
    }
  }
}

TEST(TransverseMercator, RefusesNamesAndPlacesThatAreNone) {
  for (const char* const name : {"", "N", "0N", "61N", "11", "11X", "utm", "utm111N", "tm:", "tm:a",
                                 "tm:9,2", "tm:9,1,1,1,1", "tm:nan", "tm:9,1,1e9", "mercator"}) {
    EXPECT_FALSE(GridByName(name).has_value()) << name;
  }
  const auto grid = GridByName("33N");
  ASSERT_TRUE(grid.has_value());
  EXPECT_FALSE(GeodeticFromGrid(*grid, 1e8, 0.0, 0.0).has_value());
  EXPECT_FALSE(GeodeticFromGrid(*grid, 5e5, 2e7, 0.0).has_value());
  EXPECT_FALSE(GeodeticFromGrid(*grid, std::nan(""), 0.0, 0.0).has_value());
}

}  // namespace
}  // namespace lodemark
