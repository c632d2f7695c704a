// A map's buildings under a session: used where they are whole, and none where they are damaged.
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/unit/map/map_scene.h"

namespace lodemark::test {
namespace {

constexpr double kOrigin_geodetic[3] = {48.2, 16.37, 180.0};
// A few metres before the long wall of the scene's higher building.
constexpr double kPhone_enu_m[3] = {4.0, -2.0, 0.0};

class SessionBuildings : public ::testing::Test {
 protected:
  SessionBuildings() {
    MapScene scene(1);
    scene.info.origin = {kOrigin_geodetic[0] * kRadiansPerDegree,
                         kOrigin_geodetic[1] * kRadiansPerDegree, kOrigin_geodetic[2]};
    const Status made = scene.Make(path_);
    EXPECT_TRUE(made.ok()) << made.error().message;
    lodemark_session_options options = {};
    options.struct_size = sizeof options;
    options.ionosphere = LODEMARK_IONOSPHERE_NONE;
    options.troposphere = LODEMARK_TROPOSPHERE_NONE;
    EXPECT_EQ(lodemark_session_open(&options, &session_), LODEMARK_OK);
    const std::string orbits = Constellation::NavigationFile();
    EXPECT_EQ(
        lodemark_session_push_navigation(session_, "nav", orbits.data(), orbits.size(), nullptr),
        LODEMARK_OK);
  }
  ~SessionBuildings() override {
    lodemark_session_close(session_);
    lodemark_map_close(map_);
    std::remove(path_.c_str());
  }

  void Change(const char* sql) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(path_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }

  lodemark_status UseMap() {
    EXPECT_EQ(lodemark_session_use_map(session_, nullptr), LODEMARK_OK);
    lodemark_map_close(map_);
    map_ = nullptr;
    EXPECT_EQ(lodemark_map_open(path_.c_str(), &map_), LODEMARK_OK) << lodemark_last_error();
    return lodemark_session_use_map(session_, map_);
  }

  // Of two epochs, by the second of which the place is known: how many signals' sight was asked
  // for.
  int SightsAsked() {
    double place_in_ecef_m[3];
    double geodetic[3];
    EXPECT_EQ(lodemark_ecef_from_enu(kOrigin_geodetic, kPhone_enu_m, place_in_ecef_m), LODEMARK_OK);
    EXPECT_EQ(lodemark_geodetic_from_ecef(place_in_ecef_m, geodetic), LODEMARK_OK);
    StillPhone phone(geodetic, 1234.0);
    std::vector<lodemark_satellite> satellites(64);
    std::int32_t count = 0;
    for (int i = 0; i < 2; ++i) {
      time_ns_ += 1'000'000'000;
      phone.Measure(time_ns_);
      EXPECT_EQ(lodemark_session_push_gnss(session_, 0, &phone.clock, phone.measurements.data(),
                                           phone.count()),
                LODEMARK_OK);
      EXPECT_EQ(lodemark_session_process(session_), LODEMARK_OK);
      satellites[0].struct_size = sizeof satellites[0];
      EXPECT_EQ(lodemark_session_satellites(session_, satellites.data(), 64, &count), LODEMARK_OK);
    }
    int asked = 0;
    for (int i = 0; i < count; ++i) {
      const lodemark_satellite& satellite = satellites[static_cast<std::size_t>(i)];
      asked += (satellite.present & LODEMARK_SATELLITE_HAS_SIGHT) != 0 ? 1 : 0;
    }
    return asked;
  }

  lodemark_status PushPhotograph() {
    lodemark_lens lens = {};
    lens.struct_size = sizeof lens;
    lens.width_px = lens.height_px = 8;
    lens.fx_px = lens.fy_px = 8.0;
    lens.cx_px = lens.cy_px = 3.5;
    const std::vector<std::uint8_t> pixels(64);
    lodemark_frame frame = {};
    frame.struct_size = sizeof frame;
    frame.time_ns = time_ns_ + 1;
    return lodemark_session_push_image(session_, &frame, &lens, pixels.data(), 8);
  }

  std::string path_ =
      testing::TempDir() + "session_buildings." + std::to_string(::getpid()) + ".map";
  lodemark_session* session_ = nullptr;
  lodemark_map* map_ = nullptr;
  std::int64_t time_ns_ = Constellation::kReference_gps_ns;
};

TEST_F(SessionBuildings, TellWhichSatellitesMayBeHidden) {
  EXPECT_EQ(SightsAsked(), 0);
  EXPECT_EQ(UseMap(), LODEMARK_OK) << lodemark_last_error();
  EXPECT_GT(SightsAsked(), 4);
  EXPECT_EQ(PushPhotograph(), LODEMARK_OK) << lodemark_last_error();
}

// A file that opens, for its buildings are looked at only by whom they matter to.
TEST_F(SessionBuildings, ThatAreDamagedAreNotUsedAndNothingElseOfTheMap) {
  const char* const damages[] = {
      "DELETE FROM building_part_corners WHERE corner > 1",
      "UPDATE building_part_corners SET east_m = -east_m",
      "UPDATE building_part_corners SET north_m = 9e999",
      "DELETE FROM building_parts WHERE id = 4",
  };
  for (const char* const damage : damages) {
    ASSERT_EQ(UseMap(), LODEMARK_OK) << lodemark_last_error();
    EXPECT_GT(SightsAsked(), 4);
    const std::vector<std::uint8_t> whole = ReadBytes(path_);
    Change(damage);
    EXPECT_EQ(UseMap(), LODEMARK_ERROR_BAD_DATA) << damage;
    EXPECT_NE(std::string(lodemark_last_error()).find("building_part"), std::string::npos)
        << lodemark_last_error();
    EXPECT_EQ(SightsAsked(), 0) << damage;
    EXPECT_EQ(PushPhotograph(), LODEMARK_ERROR_OUT_OF_ORDER) << damage;
    WriteBytes(path_, whole);
  }
}

// The map that was used before does not go on.
TEST_F(SessionBuildings, ThatAreDamagedTakeThePlaceOfWholeOnes) {
  ASSERT_EQ(UseMap(), LODEMARK_OK) << lodemark_last_error();
  Change("DELETE FROM building_part_corners WHERE corner > 1");
  lodemark_map* damaged = nullptr;
  ASSERT_EQ(lodemark_map_open(path_.c_str(), &damaged), LODEMARK_OK) << lodemark_last_error();
  EXPECT_EQ(lodemark_session_use_map(session_, damaged), LODEMARK_ERROR_BAD_DATA);
  EXPECT_EQ(SightsAsked(), 0);
  lodemark_map_close(damaged);
}

}  // namespace
}  // namespace lodemark::test
