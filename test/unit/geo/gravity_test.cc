#include "core/geo/gravity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

// NIMA TR8350.2, third edition, equation 4-1 and table 3.4: gravity on the ellipsoid.
double Somigliana(double latitude_rad) {
  const double sine2 = std::sin(latitude_rad) * std::sin(latitude_rad);
  return 9.7803253359 * (1.0 + 0.00193185265241 * sine2) /
         std::sqrt(1.0 - 0.00669437999014 * sine2);
}

TEST(Gravity, IsSomiglianasOnTheEllipsoid) {
  for (const double latitude_deg : {-80.0, -33.0, 0.0, 12.0, 45.0, 90.0}) {
    const Geodetic place{latitude_deg * kRadiansPerDegree, 0.7, 0.0};
    const Eigen::Vector3d point = EcefFromGeodetic(place);
    const Eigen::Vector3d enu = EnuFromEcefRotation(place) * GravityInEcef(point);
    EXPECT_NEAR(-enu.z(), Somigliana(place.latitude_rad), 1e-7) << latitude_deg;
    EXPECT_NEAR(enu.head<2>().norm(), 0.0, 1e-8) << latitude_deg;
  }
}

// Free air: 0.3086 mGal a metre.
TEST(Gravity, FadesWithHeight) {
  const Geodetic low{0.8, 0.1, 0.0};
  const Geodetic high{0.8, 0.1, 1000.0};
  const double fading =
      GravityInEcef(EcefFromGeodetic(low)).norm() - GravityInEcef(EcefFromGeodetic(high)).norm();
  EXPECT_NEAR(fading, 3.086e-3, 2e-6);
}

}  // namespace
}  // namespace lodemark
