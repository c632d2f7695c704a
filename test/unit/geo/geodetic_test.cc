#include "core/geo/geodetic.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/base/random.h"
#include "core/base/units.h"

namespace lodemark {
namespace {

// WGS 84 (NGA.STND.0036, table 3.1).
constexpr double kSemiMajor_m = 6'378'137.0;
constexpr double kFlattening = 1.0 / 298.257'223'563;
constexpr double kSemiMinor_m = 6'356'752.314'2;

Geodetic Degrees(double latitude_deg, double longitude_deg, double height_m) {
  return {latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, height_m};
}

Geodetic AnyPlace(Random& random, double lowest_m, double highest_m) {
  // Statements, since the order of a call's arguments is the compiler's choice.
  const double latitude_deg = random.Uniform(-90.0, 90.0);
  const double longitude_deg = random.Uniform(-180.0, 180.0);
  return Degrees(latitude_deg, longitude_deg, random.Uniform(lowest_m, highest_m));
}

TEST(EcefFromGeodetic, AgreesWithPublishedPoints) {
  // The example of GeographicLib's CartConvert manual.
  const Eigen::Vector3d jerusalem_east = EcefFromGeodetic(Degrees(33.3, 44.4, 6000.0));
  EXPECT_LT((jerusalem_east - Eigen::Vector3d(3'816'209.60, 3'737'108.55, 3'485'109.57)).norm(),
            0.01);
  EXPECT_LT((EcefFromGeodetic({}) - Eigen::Vector3d(kSemiMajor_m, 0.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((EcefFromGeodetic(Degrees(-90.0, 77.0, 10.0)) -
             Eigen::Vector3d(0.0, 0.0, -kSemiMinor_m - 10.0))
                .norm(),
            1e-4);
}

TEST(GeodeticFromEcef, AgreesWithAPublishedPointDeepInTheEarth) {
  // The second example of GeographicLib's CartConvert manual: 6.483 45 -6335709.73.
  const Geodetic geodetic = GeodeticFromEcef({30'000.0, 30'000.0, 0.0});
  EXPECT_NEAR(geodetic.latitude_rad * kDegreesPerRadian, 6.483, 5e-4);
  EXPECT_NEAR(geodetic.longitude_rad * kDegreesPerRadian, 45.0, 1e-12);
  EXPECT_NEAR(geodetic.height_m, -6'335'709.73, 0.005);
}

TEST(EcefFromGeodetic, AgreesWithTheTextbookFormula) {
  Random random(1);
  const double eccentricity2 = kFlattening * (2.0 - kFlattening);
  for (int i = 0; i < 1000; ++i) {
    const Geodetic place = AnyPlace(random, -500.0, 30'000'000.0);
    const double sin_lat = std::sin(place.latitude_rad);
    const double cos_lat = std::cos(place.latitude_rad);
    const double normal_m = kSemiMajor_m / std::sqrt(1.0 - eccentricity2 * sin_lat * sin_lat);
    const Eigen::Vector3d expected(
        (normal_m + place.height_m) * cos_lat * std::cos(place.longitude_rad),
        (normal_m + place.height_m) * cos_lat * std::sin(place.longitude_rad),
        (normal_m * (1.0 - eccentricity2) + place.height_m) * sin_lat);
    // A few units in the last place of 36,000 km.
    ASSERT_LT((EcefFromGeodetic(place) - expected).norm(), 5e-8);
  }
}

TEST(GeodeticFromEcef, IsTheInverse) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Geodetic place = AnyPlace(random, -10'000.0, 30'000'000.0);
    const Geodetic back = GeodeticFromEcef(EcefFromGeodetic(place));
    ASSERT_NEAR(back.height_m, place.height_m, 5e-8);
    ASSERT_LT((EcefFromGeodetic(back) - EcefFromGeodetic(place)).norm(), 1e-7);
    ASSERT_NEAR(back.latitude_rad, place.latitude_rad, 1e-14);
  }
}

TEST(GeodeticFromEcef, HasAnAnswerForTheCentreAndTheAxis) {
  const Geodetic centre = GeodeticFromEcef(Eigen::Vector3d::Zero());
  EXPECT_TRUE(std::isfinite(centre.latitude_rad) && std::isfinite(centre.longitude_rad));
  EXPECT_LT(centre.height_m, -6.3e6);
  const Geodetic pole = GeodeticFromEcef({0.0, 0.0, kSemiMinor_m + 5.0});
  EXPECT_NEAR(pole.latitude_rad, kPi / 2.0, 1e-12);
  EXPECT_NEAR(pole.height_m, 5.0, 1e-4);
}

TEST(EnuFromEcefRotation, IsARotation) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d rotation = EnuFromEcefRotation(AnyPlace(random, 0.0, 100.0));
    ASSERT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    ASSERT_NEAR(rotation.determinant(), 1.0, 1e-14);
  }
}

// East, north and up are where the geodetic coordinates grow: the rotation against differences.
TEST(EnuFromEcefRotation, FollowsTheGeodeticCoordinates) {
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    Geodetic place = AnyPlace(random, 0.0, 3000.0);
    place.latitude_rad *= 0.99;  // east has no direction on the pole
    constexpr double kStep_rad = 1e-6;
    constexpr double kStep_m = 6.0;
    const auto difference = [&](double latitude_rad, double longitude_rad, double height_m) {
      Geodetic ahead = place;
      ahead.latitude_rad += latitude_rad;
      ahead.longitude_rad += longitude_rad;
      ahead.height_m += height_m;
      Geodetic behind = place;
      behind.latitude_rad -= latitude_rad;
      behind.longitude_rad -= longitude_rad;
      behind.height_m -= height_m;
      const Eigen::Vector3d line = EcefFromGeodetic(ahead) - EcefFromGeodetic(behind);
      return Eigen::Vector3d(line.normalized());
    };
    const Eigen::Matrix3d rotation = EnuFromEcefRotation(place);
    // A nanometre of rounding over the shortest of the differences, 0.4 m.
    ASSERT_LT((rotation * difference(0.0, kStep_rad, 0.0) - Eigen::Vector3d::UnitX()).norm(), 1e-8);
    ASSERT_LT((rotation * difference(kStep_rad, 0.0, 0.0) - Eigen::Vector3d::UnitY()).norm(), 1e-8);
    ASSERT_LT((rotation * difference(0.0, 0.0, kStep_m) - Eigen::Vector3d::UnitZ()).norm(), 1e-8);
  }
}

TEST(EnuFrame, RoundTripsAndKeepsDistances) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const EnuFrame frame(AnyPlace(random, 0.0, 3000.0));
    EXPECT_LT(frame.FromEcef(frame.origin_in_ecef()).norm(), 1e-9);
    const double east_m = random.Uniform(-5e4, 5e4);
    const double north_m = random.Uniform(-5e4, 5e4);
    const Eigen::Vector3d point_in_enu(east_m, north_m, random.Uniform(-500.0, 500.0));
    const Eigen::Vector3d point_in_ecef = frame.ToEcef(point_in_enu);
    ASSERT_LT((frame.FromEcef(point_in_ecef) - point_in_enu).norm(), 1e-8);
    ASSERT_NEAR((point_in_ecef - frame.origin_in_ecef()).norm(), point_in_enu.norm(), 1e-8);
  }
}

TEST(EnuFrame, PutsTheZenithStraightUp) {
  const Geodetic place = Degrees(48.1, 11.6, 515.0);
  Geodetic above = place;
  above.height_m += 100.0;
  const Eigen::Vector3d zenith = EnuFrame(place).FromEcef(EcefFromGeodetic(above));
  EXPECT_LT((zenith - Eigen::Vector3d(0.0, 0.0, 100.0)).norm(), 1e-8);
}

struct Direction {
  double azimuth_deg;
  double elevation_deg;
};

TEST(LookAnglesTo, GivesBackTheDirectionATargetWasPlacedIn) {
  const EnuFrame frame(Degrees(-33.9, 151.2, 40.0));
  constexpr std::array<Direction, 8> kDirections = {{{0.0, 10.0},
                                                     {90.0, 0.0},
                                                     {180.0, 45.0},
                                                     {270.0, 89.0},
                                                     {359.9, 30.0},
                                                     {0.1, 30.0},
                                                     {225.0, -20.0},
                                                     {135.0, 60.0}}};
  for (const Direction& direction : kDirections) {
    const double azimuth_rad = direction.azimuth_deg * kRadiansPerDegree;
    const double elevation_rad = direction.elevation_deg * kRadiansPerDegree;
    const Eigen::Vector3d target_in_enu =
        22e6 * Eigen::Vector3d(std::cos(elevation_rad) * std::sin(azimuth_rad),
                               std::cos(elevation_rad) * std::cos(azimuth_rad),
                               std::sin(elevation_rad));
    const LookAngles angles =
        LookAnglesTo(frame.ToEcef(target_in_enu), frame.origin_in_ecef(), frame.enu_from_ecef());
    // Azimuths a rounding error west of north come out just below 2 pi.
    EXPECT_NEAR(std::remainder(angles.azimuth_rad - azimuth_rad, 2.0 * kPi), 0.0, 1e-12);
    EXPECT_GE(angles.azimuth_rad, 0.0);
    EXPECT_LE(angles.azimuth_rad, 2.0 * kPi);
    EXPECT_NEAR(angles.elevation_rad, elevation_rad, 1e-12);
  }
}

TEST(LookAnglesTo, SeesTheZenithAtNinetyDegrees) {
  const EnuFrame frame(Degrees(10.0, 20.0, 0.0));
  const LookAngles angles =
      LookAnglesTo(frame.ToEcef({0.0, 0.0, 20e6}), frame.origin_in_ecef(), frame.enu_from_ecef());
  // The arc sine is flat there: half the digits are left.
  EXPECT_NEAR(angles.elevation_rad, kPi / 2.0, 1e-7);
}

}  // namespace
}  // namespace lodemark
