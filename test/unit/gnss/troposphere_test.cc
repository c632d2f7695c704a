#include "core/gnss/troposphere.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"

namespace lodemark {
namespace {

Geodetic Place(double latitude_deg, double height_m) {
  return {latitude_deg * kRadiansPerDegree, 0.1, height_m};
}

std::int64_t DayOf2021(int day_of_year) {
  return *NanosecondsFromCalendar({2021, 1, 1, 0, 0, 0.0}) + (day_of_year - 1) * kDay_ns;
}

TEST(ClimatologicalMeteorology, GivesTheTablesRowsInMidwinter) {
  const Meteorology weather = ClimatologicalMeteorology(Place(45.0, 0.0), DayOf2021(28));
  EXPECT_NEAR(weather.pressure_hpa, 1015.75 + 2.25, 1e-9);
  EXPECT_NEAR(weather.temperature_k, 283.15 - 11.0, 1e-9);
  EXPECT_NEAR(weather.vapour_pressure_hpa, 11.66 - 7.24, 1e-9);
}

TEST(ClimatologicalMeteorology, TurnsTheSeasonsInTheSouth) {
  const Meteorology north = ClimatologicalMeteorology(Place(52.0, 0.0), DayOf2021(28));
  const Meteorology south = ClimatologicalMeteorology(Place(-52.0, 0.0), DayOf2021(211));
  EXPECT_NEAR(north.temperature_k, south.temperature_k, 1e-9);
}

TEST(ClimatologicalMeteorology, ThinsWithHeight) {
  // The ratio of pressures of the standard atmosphere at 5.5 km is one half.
  const Meteorology high = ClimatologicalMeteorology(Place(45.0, 5'500.0), DayOf2021(119));
  const Meteorology low = ClimatologicalMeteorology(Place(45.0, 0.0), DayOf2021(119));
  EXPECT_NEAR(high.pressure_hpa / low.pressure_hpa, 0.5, 0.01);
}

// ISO 2533 table 5: the standard atmosphere.
TEST(StandardMeteorology, GivesTheStandardAtmosphere) {
  EXPECT_NEAR(StandardMeteorology(0.0, 0.0).pressure_hpa, 1013.25, 1e-9);
  EXPECT_NEAR(StandardMeteorology(1'000.0, 0.0).pressure_hpa, 898.75, 0.05);
  EXPECT_NEAR(StandardMeteorology(5'000.0, 0.0).pressure_hpa, 540.20, 0.1);
  EXPECT_NEAR(StandardMeteorology(5'000.0, 0.0).temperature_k, 255.65, 1e-9);
  // Saturation over water at 15 degrees: 17.04 hPa (WMO).
  EXPECT_NEAR(StandardMeteorology(0.0, 1.0).vapour_pressure_hpa, 17.04, 0.02);
}

// 2.3 m of air at sea level: the figure every textbook gives, and Hopfield's model within 1 %.
TEST(ZenithDelay, OfTwoModelsAgree) {
  for (double height_m : {0.0, 500.0, 1'500.0}) {
    const Meteorology weather = StandardMeteorology(height_m, 0.5);
    const ZenithDelay saastamoinen = SaastamoinenZenithDelay(weather, Place(45.0, height_m));
    const ZenithDelay hopfield = HopfieldZenithDelay(weather);
    EXPECT_NEAR(hopfield.hydrostatic_m / saastamoinen.hydrostatic_m, 1.0, 0.01);
    EXPECT_NEAR(hopfield.wet_m, saastamoinen.wet_m, 0.02);
  }
  const Meteorology sea_level = StandardMeteorology(0.0, 0.0);
  EXPECT_NEAR(SaastamoinenZenithDelay(sea_level, Place(45.0, 0.0)).hydrostatic_m, 2.3070, 1e-3);
}

// Niell (1996) table 2: rays traced through the standard atmosphere of 45 degrees at 5 degrees of
// elevation stretch the hydrostatic delay by 10.15 and the wet one by 10.75, to 1 %.
TEST(NiellMapping, IsOneAtTheZenithAndTenAtFiveDegrees) {
  const NiellMapping mapping(Place(45.0, 0.0), DayOf2021(119));
  EXPECT_NEAR(mapping.At(kPi / 2.0).hydrostatic, 1.0, 1e-12);
  EXPECT_NEAR(mapping.At(kPi / 2.0).wet, 1.0, 1e-12);
  EXPECT_NEAR(mapping.At(5.0 * kRadiansPerDegree).hydrostatic, 10.15, 0.05);
  EXPECT_NEAR(mapping.At(5.0 * kRadiansPerDegree).wet, 10.75, 0.05);
}

TEST(NiellMapping, StandsStillBelowTwoDegrees) {
  const NiellMapping mapping(Place(45.0, 0.0), DayOf2021(119));
  EXPECT_EQ(mapping.At(-0.1).wet, mapping.At(2.0 * kRadiansPerDegree).wet);
}

TEST(SaastamoinenSlantDelay, IsTheZenithDelayAtTheZenith) {
  const Meteorology weather = StandardMeteorology(0.0, 0.5);
  const ZenithDelay zenith = SaastamoinenZenithDelay(weather, Place(45.0, 0.0));
  EXPECT_NEAR(SaastamoinenSlantDelay(weather, 0.0, kPi / 2.0), zenith.hydrostatic_m + zenith.wet_m,
              0.001);
}

TEST(TroposphereDelay, FallsWithElevationHeightAndIsNeverAbsurd) {
  const std::int64_t time_gps_ns = DayOf2021(200);
  for (double latitude_deg : {-80.0, -20.0, 0.0, 40.0, 90.0}) {
    double last_m = 1e9;
    for (double elevation_deg = -5.0; elevation_deg <= 90.0; elevation_deg += 2.5) {
      double sigma_m = 0.0;
      const double delay_m = TroposphereDelay(
          Place(latitude_deg, 100.0), elevation_deg * kRadiansPerDegree, time_gps_ns, &sigma_m);
      EXPECT_LE(delay_m, last_m);
      EXPECT_GT(delay_m, 2.0);
      EXPECT_LT(delay_m, 60.0);
      EXPECT_GT(sigma_m, 0.02);
      EXPECT_LT(sigma_m, 0.1 * delay_m);
      last_m = delay_m;
    }
  }
  EXPECT_LT(TroposphereDelay(Place(45.0, 3'000.0), 0.5, time_gps_ns, nullptr),
            TroposphereDelay(Place(45.0, 0.0), 0.5, time_gps_ns, nullptr));
  for (double height_m : {-1e9, 1e9}) {
    EXPECT_TRUE(std::isfinite(TroposphereDelay(Place(45.0, height_m), 0.5, time_gps_ns, nullptr)));
  }
}

}  // namespace
}  // namespace lodemark
