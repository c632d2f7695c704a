#include "tools/lodemark/sky_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/units.h"
#include "tools/lodemark/sky_drawing.h"

namespace lodemark {
namespace {

const Geodetic kOrigin = {0.84, 0.2, 250.0};

// A tower of 10 x 10 m, 30 m high, its near wall 20 m to the east.
BuildingScene TowerInTheEast() {
  BuildingPrism tower;
  tower.footprint = {{20.0, -5.0}, {30.0, -5.0}, {30.0, 5.0}, {20.0, 5.0}};
  tower.top_m = 30.0;
  return std::move(BuildingScene::Make(std::vector{tower})).value();
}

SkyPlace PlaceAt(const Eigen::Vector3d& in_enu_m) {
  SkyPlace place;
  place.in_ecef = EnuFrame(kOrigin).ToEcef(in_enu_m);
  return place;
}

SkySatellite SatelliteAt(std::uint8_t number, double azimuth_deg, double elevation_deg) {
  SkySatellite satellite;
  satellite.satellite = {System::kGps, number};
  satellite.azimuth_rad = azimuth_deg * kRadiansPerDegree;
  satellite.elevation_rad = elevation_deg * kRadiansPerDegree;
  satellite.wavelength_m = 0.19;
  return satellite;
}

TEST(SkyView, HidesWhatIsBehindTheTowerAndNothingElse) {
  const BuildingScene scene = TowerInTheEast();
  SkyView view(&scene, EnuFrame(kOrigin));
  const std::vector<SkySatellite> satellites = {
      SatelliteAt(1, 90.0, 40.0), SatelliteAt(2, 90.0, 70.0), SatelliteAt(3, 270.0, 10.0)};
  const SkyMoment moment = view.Look(PlaceAt({0.0, 0.0, 0.0}), satellites);
  ASSERT_EQ(moment.satellites.size(), 3u);
  EXPECT_EQ(moment.satellites[0].probability, 0.0);
  EXPECT_EQ(moment.satellites[1].probability, 1.0);
  EXPECT_EQ(moment.satellites[2].probability, 1.0);
  const double roof_rad = std::atan2(30.0, 20.0);
  EXPECT_NEAR(moment.satellites[0].skyline_rad, roof_rad, 1e-9);
  EXPECT_EQ(moment.satellites[2].skyline_rad, 0.0);
  EXPECT_NEAR(view.last_skyline()[90], roof_rad, 1e-9);
  EXPECT_EQ(view.last_skyline()[110], 0.0);
  EXPECT_NEAR(view.nearest_building_m(), 20.0, 1e-6);
}

TEST(SkyView, KeepsLowestAndHighestRoofsAndLeavesOutPlacesIndoors) {
  const BuildingScene scene = TowerInTheEast();
  SkyView view(&scene, EnuFrame(kOrigin));
  view.Look(PlaceAt({0.0, 0.0, 0.0}), {});
  view.Look(PlaceAt({10.0, 0.0, 0.0}), {});
  EXPECT_NEAR(view.lowest_skyline()[90], std::atan2(30.0, 20.0), 1e-9);
  EXPECT_NEAR(view.highest_skyline()[90], std::atan2(30.0, 10.0), 1e-9);
  EXPECT_TRUE(view.Look(PlaceAt({25.0, 0.0, 1.0}), {}).inside_building);
  EXPECT_NEAR(view.highest_skyline()[90], std::atan2(30.0, 10.0), 1e-9);
  EXPECT_EQ(view.nearest_building_m(), 0.0);
}

TEST(DrawSky, IsSoundWhateverTheNameAndEvenWithoutSatellites) {
  const BuildingScene scene = TowerInTheEast();
  SkyView view(&scene, EnuFrame(kOrigin));
  const std::vector<SkySatellite> satellites = {SatelliteAt(7, 90.0, 40.0)};
  const SkyMoment moments[] = {view.Look(PlaceAt({0.0, 0.0, 0.0}), satellites)};
  const std::string drawn = DrawSky("<a & \x01>", view, moments);
  EXPECT_NE(drawn.find("&lt;a &amp; ?&gt;"), std::string::npos);
  EXPECT_NE(drawn.find("G07: azimuth 90°, elevation 40°, skyline 56°"), std::string::npos);
  EXPECT_EQ(drawn.find("nan"), std::string::npos);
  EXPECT_TRUE(drawn.ends_with("</svg>\n"));
  EXPECT_TRUE(DrawSky("", view, {}).ends_with("</svg>\n"));
}

}  // namespace
}  // namespace lodemark
