#include "core/geo/datum.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

const Eigen::Vector3d kBeijing_m(-2144855.42, 4397605.07, 4078049.85);
const Eigen::Vector3d kMunich_m(4157177.0660, 671230.4770, 4774767.0310);

TEST(DatumFromName, KnowsTheNamesInUse) {
  EXPECT_EQ(DatumFromName("WGS 84"), Datum::kWgs84);
  EXPECT_EQ(DatumFromName("WGS84 (G2139)"), Datum::kWgs84);
  EXPECT_EQ(DatumFromName("itrf-2014"), Datum::kItrf2014);
  EXPECT_EQ(DatumFromName("ETRS89"), Datum::kEtrf2000);
  EXPECT_EQ(DatumFromName("CGCS2000 / 3-degree GK"), Datum::kCgcs2000);
  EXPECT_EQ(DatumFromName("local"), Datum::kUnknown);
  EXPECT_EQ(DatumFromName(""), Datum::kUnknown);
}

// What PROJ 9.1 gives (cct with its own file ITRF2014, and the parameters of EUREF Technical Note
// 1).
TEST(ShiftBetween, AgreesWithProj) {
  const auto moved = [](const Eigen::Vector3d& point, Datum to, double year) -> Eigen::Vector3d {
    return point + ShiftBetween(point, Datum::kItrf2014, year, to, year).in_ecef_m;
  };
  constexpr double kMicrometres_m = 5e-6;
  EXPECT_LT((moved(kBeijing_m, Datum::kItrf2008, 2000.0) -
             Eigen::Vector3d(-2144855.417714, 4397605.070493, 4078049.852095))
                .norm(),
            kMicrometres_m);
  EXPECT_LT((moved(kBeijing_m, Datum::kItrf2000, 2000.0) -
             Eigen::Vector3d(-2144855.422488, 4397605.074686, 4078049.847060))
                .norm(),
            kMicrometres_m);
  EXPECT_LT((moved(kMunich_m, Datum::kEtrf2000, 2024.5) -
             Eigen::Vector3d(4157177.631762, 671229.899914, 4774766.605857))
                .norm(),
            kMicrometres_m);
}

TEST(ShiftBetween, ComesBack) {
  for (const Datum datum : {Datum::kItrf2020, Datum::kItrf97, Datum::kCgcs2000, Datum::kEtrf2000,
                            Datum::kWgs84, Datum::kBdcs}) {
    const DatumShift there = ShiftBetween(kMunich_m, Datum::kWgs84, 2024.5, datum, 2012.0);
    const DatumShift back =
        ShiftBetween(kMunich_m + there.in_ecef_m, datum, 2012.0, Datum::kWgs84, 2024.5);
    EXPECT_LT((there.in_ecef_m + back.in_ecef_m).norm(), 1e-6) << NameOf(datum);
  }
}

// Coordinates of ETRS89 do not change as Europe moves; those of the ITRF do, by 2.5 cm a year.
TEST(ShiftBetween, EuropeMovesInTheItrfAndNotInItsOwnFrame) {
  const Eigen::Vector3d in_2004 =
      ShiftBetween(kMunich_m, Datum::kEtrf2000, 2004.0, Datum::kItrf2014, 2004.0).in_ecef_m;
  const Eigen::Vector3d in_2024 =
      ShiftBetween(kMunich_m, Datum::kEtrf2000, 2024.0, Datum::kItrf2014, 2024.0).in_ecef_m;
  const Eigen::Vector3d moved_enu_m =
      EnuFromEcefRotation(GeodeticFromEcef(kMunich_m)) * (in_2024 - in_2004);
  EXPECT_NEAR(moved_enu_m.x(), 0.42, 0.03);  // to the north-east
  EXPECT_NEAR(moved_enu_m.y(), 0.31, 0.03);
  EXPECT_NEAR(moved_enu_m.z(), 0.0, 0.02);
}

// The reason why maps of China of 2000 are half a metre off for a phone of today.
TEST(ShiftBetween, ChinaHasMovedSince2000) {
  const DatumShift shift = ShiftBetween(kBeijing_m, Datum::kCgcs2000, 0.0, Datum::kWgs84, 2024.5);
  const Eigen::Vector3d enu_m = EnuFromEcefRotation(GeodeticFromEcef(kBeijing_m)) * shift.in_ecef_m;
  // Eurasia carries Beijing east-south-east, by 2.7 cm a year (PROJ, with the rotation alone).
  const Eigen::Vector3d by_plate =
      Eigen::Vector3d(-2144856.079415, 4397604.915004, 4078049.670321) - kBeijing_m;
  EXPECT_LT((shift.in_ecef_m - by_plate).norm(), 0.05);
  EXPECT_GT(enu_m.x(), 0.55);
  EXPECT_LT(enu_m.y(), -0.1);
  EXPECT_NEAR(shift.sigma_m, 0.12, 0.03);
}

TEST(ShiftBetween, SaysWhatItDoesNotKnow) {
  EXPECT_EQ(ShiftBetween(kMunich_m, Datum::kWgs84, 2024.0, Datum::kWgs84, 2024.0).sigma_m, 0.0);
  const DatumShift old = ShiftBetween(kMunich_m, Datum::kItrf2014, 2014.0, Datum::kWgs84, 2024.0);
  EXPECT_LT(old.in_ecef_m.norm(), 0.01);
  EXPECT_GT(old.sigma_m, 0.2);
  EXPECT_EQ(ShiftBetween(kMunich_m, Datum::kUnknown, 0.0, Datum::kWgs84, 2024.0).sigma_m, 1.0);
}

}  // namespace
}  // namespace lodemark
