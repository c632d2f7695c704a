#include "core/session/sight_lines.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/units.h"
#include "core/map/feature_map.h"
#include "core/map/feature_map_writer.h"
#include "core/session/map_buildings.h"
#include "test/unit/session/session_scene.h"

namespace lodemark {
namespace {

using test::ProcessEpoch;
using test::SessionScene;

const Geodetic kOrigin = {0.84, 0.2, 250.0};

// A wall of 60 m length and 20 m height across the north, 10 m thick, so many metres away.
BuildingPart WallInTheNorth(std::uint32_t id, double away_m, std::string name) {
  BuildingPart part;
  part.id = id;
  part.building = std::move(name);
  part.footprint_in_enu_m = {
      {-30.0, away_m}, {30.0, away_m}, {30.0, away_m + 10.0}, {-30.0, away_m + 10.0}};
  part.base_m = -2.0;
  part.top_m = 20.0;
  return part;
}

class MapOfBuildings : public testing::Test {
 protected:
  MapOfBuildings() {
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("sight_lines_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~MapOfBuildings() override { std::filesystem::remove_all(folder_); }

  std::unique_ptr<FeatureMap> Make(const std::vector<BuildingPart>& parts) {
    const std::string path = (folder_ / (std::to_string(++maps_) + ".map")).string();
    MapInfo info;
    info.origin = kOrigin;
    info.datum = "WGS84";
    auto writer = FeatureMapWriter::Create(path, info);
    if (!writer) return nullptr;
    for (const BuildingPart& part : parts) {
      EXPECT_TRUE((*writer)->AddBuildingPart(part).ok());
    }
    EXPECT_TRUE((*writer)->Commit().ok());
    auto map = FeatureMap::Open(path);
    return map ? std::move(*map) : nullptr;
  }

  std::filesystem::path folder_;
  int maps_ = 0;
};

PlacePrior PlaceAt(const Eigen::Vector3d& in_enu_m, double sigma_m) {
  PlacePrior prior;
  prior.position_in_ecef = EnuFrame(kOrigin).ToEcef(in_enu_m);
  prior.covariance_enu_m2 = Eigen::Vector3d::Constant(sigma_m * sigma_m).asDiagonal();
  return prior;
}

LookAngles Look(double azimuth_deg, double elevation_deg) {
  return {azimuth_deg * kRadiansPerDegree, elevation_deg * kRadiansPerDegree};
}

TEST_F(MapOfBuildings, MakesPartsOfOneNameOneBuilding) {
  const auto map = Make({WallInTheNorth(1, 20.0, "a"), WallInTheNorth(2, 60.0, "a"),
                         WallInTheNorth(3, 80.0, ""), WallInTheNorth(4, 100.0, "")});
  ASSERT_NE(map, nullptr);
  const Result<BuildingScene> scene = BuildingsOf(*map);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  ASSERT_EQ(scene->part_count(), 4u);
  EXPECT_EQ(scene->building(0), scene->building(1));
  EXPECT_NE(scene->building(1), scene->building(2));
  EXPECT_NE(scene->building(2), scene->building(3));
  EXPECT_EQ(scene->top_m(0), 20.0);
}

TEST_F(MapOfBuildings, HideSatellitesAndWhatIsBehindThem) {
  const auto map = Make({WallInTheNorth(1, 20.0, "a")});
  ASSERT_NE(map, nullptr);
  SightLines sights;
  const SatelliteId low = {System::kGps, 1};
  EXPECT_FALSE(sights.ProbabilityOfSight(low, Look(0.0, 30.0), 0.19).has_value());
  sights.Use(std::move(BuildingsOf(*map)).value());
  EXPECT_FALSE(sights.ProbabilityOfSight(low, Look(0.0, 30.0), 0.19).has_value());
  EXPECT_TRUE(sights.MayBeSeen({0.0, 50.0, 5.0}));

  sights.Stand(EnuFrame(kOrigin), PlaceAt({0.0, 0.0, 0.0}, 1.0));
  EXPECT_LT(*sights.ProbabilityOfSight(low, Look(0.0, 30.0), 0.19), 0.05);  // roof at 45 degrees
  EXPECT_GT(*sights.ProbabilityOfSight({System::kGps, 2}, Look(0.0, 60.0), 0.19), 0.95);
  EXPECT_GT(*sights.ProbabilityOfSight({System::kGps, 3}, Look(180.0, 10.0), 0.19), 0.95);
  EXPECT_TRUE(sights.MayBeSeen({0.0, 20.0, 5.0}));   // on the wall
  EXPECT_TRUE(sights.MayBeSeen({10.0, 22.0, 5.0}));  // a little behind it, as maps have it
  EXPECT_FALSE(sights.MayBeSeen({0.0, 50.0, 5.0}));  // behind the house
  EXPECT_TRUE(sights.MayBeSeen({0.0, 50.0, 60.0}));  // above it
  EXPECT_TRUE(sights.MayBeSeen({0.0, -50.0, 5.0}));  // away from it

  // Who may stand beside the house may see what is behind it.
  sights.Stand(EnuFrame(kOrigin), PlaceAt({0.0, 0.0, 0.0}, 30.0));
  EXPECT_TRUE(sights.MayBeSeen({0.0, 50.0, 5.0}));
  // In the middle of the house there is nothing to say, nor at an unknown place.
  sights.Stand(EnuFrame(kOrigin), PlaceAt({0.0, 25.0, 0.0}, 1.0));
  EXPECT_FALSE(sights.ProbabilityOfSight(low, Look(0.0, 30.0), 0.19).has_value());
  EXPECT_TRUE(sights.MayBeSeen({0.0, 50.0, 5.0}));
  sights.Stand(EnuFrame(kOrigin), std::nullopt);
  EXPECT_FALSE(sights.ProbabilityOfSight(low, Look(0.0, 30.0), 0.19).has_value());
}

TEST_F(MapOfBuildings, AreNotLookedAtFromBelowTheGround) {
  const auto map = Make({WallInTheNorth(1, 20.0, "a")});  // from 2 m below the origin to 20 m above
  ASSERT_NE(map, nullptr);
  SightLines sights;
  sights.Use(std::move(BuildingsOf(*map)).value());
  // From the ground the roof is at 48 degrees, from 20 m below it would be at 63.
  sights.Stand(EnuFrame(kOrigin), PlaceAt({0.0, 0.0, -20.0}, 0.5));
  EXPECT_GT(*sights.ProbabilityOfSight({System::kGps, 1}, Look(0.0, 54.0), 0.19), 0.9);
  EXPECT_LT(*sights.ProbabilityOfSight({System::kGps, 2}, Look(0.0, 42.0), 0.19), 0.1);
}

// Six epochs, some ranges a little late; the estimates and what became of each signal.
std::vector<SessionEstimate> Replay(const SessionScene& scene, const FeatureMap* map,
                                    std::vector<SatelliteStatus>* statuses) {
  const std::unique_ptr<Session> session = scene.Open();
  EXPECT_TRUE(session->UseMap(map).ok());
  std::vector<SessionEstimate> estimates;
  for (int second = 0; second < 6; ++second) {
    ObservationEpoch epoch = scene.Epoch(second);
    for (std::size_t i = 0; i < epoch.signals.size(); ++i) {
      epoch.signals[i].pseudorange_m += 1.5 * std::sin(static_cast<double>(7 * i) + second);
      if (i % 4 == 1) epoch.signals[i].cn0_dbhz = 31.0;
    }
    estimates.push_back(ProcessEpoch(session.get(), epoch));
    statuses->insert(statuses->end(), session->satellites().begin(), session->satellites().end());
  }
  return estimates;
}

TEST_F(MapOfBuildings, ChangeNothingWhereThereAreNone) {
  const auto map = Make({});
  ASSERT_NE(map, nullptr);
  const SessionScene scene;
  std::vector<SatelliteStatus> without;
  std::vector<SatelliteStatus> with;
  const std::vector<SessionEstimate> expected = Replay(scene, nullptr, &without);
  const std::vector<SessionEstimate> found = Replay(scene, map.get(), &with);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found[i].status, EstimateStatus::kFix);
    EXPECT_EQ(found[i].position_in_ecef, expected[i].position_in_ecef);
    EXPECT_EQ(found[i].covariance_enu_m2, expected[i].covariance_enu_m2);
    EXPECT_EQ(found[i].protection_level_m, expected[i].protection_level_m);
  }
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].residual_m, without[i].residual_m);
    EXPECT_EQ(with[i].weight, without[i].weight);
    EXPECT_FALSE(with[i].has_sight);
  }
}

TEST_F(MapOfBuildings, TellTheChanceOfEachSatelliteOnceThereWasAFix) {
  BuildingPart tower = WallInTheNorth(1, 20.0, "a");
  tower.top_m = 90.0;
  const auto map = Make({tower});
  ASSERT_NE(map, nullptr);
  const SessionScene scene;
  const std::unique_ptr<Session> session = scene.Open();
  ASSERT_TRUE(session->UseMap(map.get()).ok());
  ASSERT_EQ(ProcessEpoch(session.get(), scene.Epoch(0.0)).status, EstimateStatus::kFix);
  for (const SatelliteStatus& satellite : session->satellites()) EXPECT_FALSE(satellite.has_sight);
  ASSERT_EQ(ProcessEpoch(session.get(), scene.Epoch(1.0)).status, EstimateStatus::kFix);
  int hidden = 0;
  for (const SatelliteStatus& satellite : session->satellites()) {
    ASSERT_TRUE(satellite.has_sight);
    const bool north = std::cos(satellite.azimuth_rad) > 0.0;
    EXPECT_TRUE(north || satellite.sight_probability > 0.9);
    if (satellite.sight_probability < 0.5) {
      ++hidden;
      EXPECT_NE(satellite.weight, 0.0);  // doubted, not thrown out
    }
  }
  EXPECT_GT(hidden, 0);
  // After a gap nobody knows which walls are around.
  ASSERT_EQ(ProcessEpoch(session.get(), scene.Epoch(20.0)).status, EstimateStatus::kFix);
  for (const SatelliteStatus& satellite : session->satellites()) EXPECT_FALSE(satellite.has_sight);
}

}  // namespace
}  // namespace lodemark
