#include "core/fusion/coarse_position.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "test/unit/fusion/range_scene.h"

namespace lodemark {
namespace {

std::vector<Geodetic> PlacesAroundTheGlobe() {
  std::vector<Geodetic> places;
  for (const double latitude_deg : {-90.0, -89.99, -60.0, -30.0, 0.0, 23.4, 51.0, 80.0, 90.0}) {
    for (const double longitude_deg : {-180.0, -120.0, -77.0, 0.0, 13.4, 101.0, 179.999}) {
      places.push_back({latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree,
                        latitude_deg > 0.0 ? 8848.0 : -400.0});
    }
  }
  return places;
}

TEST(CoarsePosition, IsFoundFromNothingAnywhere) {
  for (const Geodetic& place : PlacesAroundTheGlobe()) {
    RangeScene scene(place);
    scene.AddSky(7);
    const auto position = CoarsePosition(scene.ranges);
    ASSERT_TRUE(position.has_value()) << place.latitude_rad << " " << place.longitude_rad;
    EXPECT_LT(scene.ErrorInEnu(*position).norm(), 100.0)
        << place.latitude_rad << " " << place.longitude_rad;
  }
}

TEST(CoarsePosition, SurvivesThreeGrossErrors) {
  for (const Geodetic& place : PlacesAroundTheGlobe()) {
    RangeScene scene(place);
    scene.AddSky(11);
    scene.ranges[1].range_m += 3e5;  // a millisecond
    scene.ranges[4].range_m -= 6e5;
    scene.ranges[8].range_m += 2e4;
    const auto position = CoarsePosition(scene.ranges);
    ASSERT_TRUE(position.has_value()) << place.latitude_rad << " " << place.longitude_rad;
    EXPECT_LT(scene.ErrorInEnu(*position).norm(), 10e3)
        << place.latitude_rad << " " << place.longitude_rad;
  }
}

TEST(CoarsePosition, GivesEachGroupItsOwnClock) {
  RangeScene scene;
  scene.AddSky(5, 0, 1e6);
  scene.AddSky(4, 3, -2e6);
  scene.AddSky(1, 9, 7e5);  // alone: helps nothing and harms nothing
  const auto position = CoarsePosition(scene.ranges);
  ASSERT_TRUE(position.has_value());
  EXPECT_LT(scene.ErrorInEnu(*position).norm(), 100.0);
}

TEST(CoarsePosition, ToleratesTheAtmosphere) {
  RangeScene scene;
  scene.AddSky(9);
  for (RangeObservation& range : scene.ranges) range.range_m += 15.0;
  scene.ranges[2].range_m += 25.0;
  const auto position = CoarsePosition(scene.ranges);
  ASSERT_TRUE(position.has_value());
  EXPECT_LT(scene.ErrorInEnu(*position).norm(), 5000.0);
}

TEST(CoarsePosition, IsEmptyWithoutEnoughOrWithNonsense) {
  EXPECT_FALSE(CoarsePosition({}).has_value());
  RangeScene scene;
  scene.AddSky(2);
  EXPECT_FALSE(CoarsePosition(scene.ranges).has_value());
  scene.ranges.clear();
  scene.AddSky(8);
  std::vector<RangeObservation> nonsense = scene.ranges;
  for (std::size_t i = 0; i < nonsense.size(); ++i) {
    nonsense[i].range_m = i % 2 == 0 ? 1e5 : 9e8;
  }
  EXPECT_FALSE(CoarsePosition(nonsense).has_value());
  scene.ranges[3].range_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(CoarsePosition(scene.ranges).has_value());
}

}  // namespace
}  // namespace lodemark
