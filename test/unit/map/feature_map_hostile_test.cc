#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <cstdio>
#include <set>

#include "core/map/feature_map.h"
#include "test/unit/map/map_scene.h"

namespace lodemark {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Changes a file past all of Lodemark's checks.
void Change(const std::string& path, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK)
      << sql << ": " << (message == nullptr ? "" : message);
  sqlite3_free(message);
  sqlite3_close(database);
}

std::string WhyNotOpened(const std::string& path) {
  const auto map = FeatureMap::Open(path);
  return map ? "opened" : map.error().message;
}

class HostileMap : public ::testing::Test {
 protected:
  void SetUp() override {
    const Status made = scene_.Make(path_);
    ASSERT_TRUE(made.ok()) << made.error().message;
  }

  std::string WhyNot() const { return WhyNotOpened(path_); }

  // The first thing a look at everything finds.
  std::string FirstFinding() const {
    const auto map = FeatureMap::Open(path_);
    if (!map) return map.error().message;
    const std::vector<Error> errors = (*map)->Check(1);
    return errors.empty() ? "sound" : errors.front().message;
  }

  ScratchFolder folder_;
  MapScene scene_{31};
  std::string path_ = folder_.File("map.db");
};

// Whatever was read is as a map could have it.
void ExpectSound(const FeatureMap& map) {
  const auto sound_place = [](const Eigen::Vector3d& place) {
    return place.allFinite() && place.norm() <= 100'001.0;
  };
  const auto expect_message = [](const Error& error) {
    EXPECT_THAT(error.message, HasSubstr("fuzzed"));
  };
  if (const auto landmarks = map.Landmarks()) {
    for (const Landmark& landmark : *landmarks) {
      EXPECT_TRUE(sound_place(landmark.position_in_enu_m));
      EXPECT_LT(landmark.id, map.landmark_id_limit());
      EXPECT_TRUE(landmark.covariance_m2.allFinite());
      EXPECT_GE(landmark.covariance_m2.diagonal().minCoeff(), 0.0);
    }
  } else {
    expect_message(landmarks.error());
  }
  if (const auto around = map.LandmarksWithin({0, 0, 0}, 300.0); !around) {
    expect_message(around.error());
  }
  if (const auto images = map.Images(); !images) expect_message(images.error());
  if (const auto parts = map.BuildingParts(); !parts) expect_message(parts.error());

  const std::size_t bytes_each = DescriptorBytes(map.info().descriptor_kind);
  const std::vector<std::uint8_t> queries(2 * bytes_each, 60);
  DescriptorSearch search(map.quantizer(), queries, {});
  const Status visited = map.VisitLists(
      search.lists(), [&](int list, const auto& view) { search.Visit(list, view, SearchScope()); });
  if (!visited) expect_message(visited.error());
  for (const Error& error : map.Check(5)) expect_message(error);
}

// The map with the smallest pages there are, so that most bytes mean something.
std::vector<std::uint8_t> SmallMap(const ScratchFolder& folder, DescriptorKind kind) {
  MapScene::Size size;
  size.landmarks = 8;
  size.images = 2;
  size.views = 2;
  size.kind = kind;
  const std::string path = folder.File("small.db");
  std::filesystem::remove(path);
  EXPECT_TRUE(MapScene(32, size).Make(path).ok());
  Change(path, "PRAGMA page_size = 512; VACUUM");
  return ReadBytes(path);
}

TEST_F(HostileMap, SaysWhatAFileIsInstead) {
  EXPECT_THAT(WhyNotOpened(folder_.File("none.db")), HasSubstr("none.db: no such file"));
  EXPECT_THAT(WhyNotOpened(folder_.path().string()), HasSubstr("is a folder"));
  EXPECT_THAT(WhyNotOpened(""), HasSubstr("path is empty"));
  EXPECT_THAT(WhyNotOpened(std::string("a\0b", 3)), HasSubstr("zero byte"));
  WriteBytes(folder_.File("empty.db"), {});
  EXPECT_THAT(WhyNotOpened(folder_.File("empty.db")), HasSubstr("empty.db: is empty"));
  WriteBytes(folder_.File("text.db"), std::vector<std::uint8_t>(5000, 'a'));
  EXPECT_THAT(WhyNotOpened(folder_.File("text.db")), HasSubstr("not an SQLite file"));
  ASSERT_EQ(mkfifo(folder_.File("pipe").c_str(), 0600), 0);
  EXPECT_THAT(WhyNotOpened(folder_.File("pipe")), HasSubstr("is a device or a pipe"));
  Change(folder_.File("other.db"), "CREATE TABLE landmarks (id)");
  EXPECT_THAT(WhyNotOpened(folder_.File("other.db")), HasSubstr("an SQLite file of another kind"));
  Change(folder_.File("ahead.db"), "PRAGMA journal_mode = WAL; CREATE TABLE landmarks (id)");
  EXPECT_THAT(WhyNotOpened(folder_.File("ahead.db")), HasSubstr("an SQLite file of another kind"));
}

TEST_F(HostileMap, RefusesOtherVersions) {
  Change(path_, "PRAGMA user_version = 3");
  const auto map = FeatureMap::Open(path_);
  ASSERT_FALSE(map.ok());
  EXPECT_EQ(map.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(map.error().message, HasSubstr("map.db: is a feature map of version 3, newer"));
  Change(path_, "PRAGMA user_version = 0");
  EXPECT_THAT(WhyNot(), HasSubstr("is damaged"));
  Change(path_, "PRAGMA user_version = 2; PRAGMA application_id = 7");
  EXPECT_THAT(WhyNot(), HasSubstr("an SQLite file of another kind"));
}

// As the version before wrote it, its building tables empty or not.
TEST_F(HostileMap, ReadsVersion1ButNotItsBuildings) {
  Change(path_,
         "DROP TABLE building_parts; DROP TABLE building_part_corners;"
         "CREATE TABLE building_part_corners (\n  part_id INTEGER NOT NULL,\n"
         "  corner INTEGER NOT NULL,\n  east_m REAL NOT NULL,\n  north_m REAL NOT NULL,\n"
         "  up_m REAL NOT NULL,\n  PRIMARY KEY (part_id, corner)\n) STRICT, WITHOUT ROWID;"
         "CREATE TABLE building_parts (id INTEGER PRIMARY KEY) STRICT;"
         "PRAGMA user_version = 1");
  EXPECT_THAT(FirstFinding(), HasSubstr("map.db: holds buildings in the form of version 1"));
  Change(path_, "UPDATE map SET building_parts = 0");
  EXPECT_EQ(FirstFinding(), "sound");
  EXPECT_THAT(*(*FeatureMap::Open(path_))->BuildingParts(), IsEmpty());
  auto writer = FeatureMapWriter::Open(path_);
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  EXPECT_THAT((*writer)->AddBuildingPart(scene_.parts[0]).error().message,
              HasSubstr("takes no buildings"));
  EXPECT_TRUE((*writer)->RemoveImage(10).ok());
  EXPECT_TRUE((*writer)->Commit().ok());
  EXPECT_EQ(FirstFinding(), "sound");
  Change(path_, "PRAGMA user_version = 2");
  EXPECT_THAT(WhyNot(), HasSubstr("not those of a feature map of version 2"));
}

TEST_F(HostileMap, RefusesASchemaOfOtherMaking) {
  const std::vector<std::uint8_t> sound = ReadBytes(path_);
  const char* changes[] = {
      "CREATE TRIGGER t AFTER INSERT ON map BEGIN DELETE FROM landmarks; END",
      "CREATE VIEW v AS SELECT * FROM landmarks",
      "CREATE TABLE extra (id INTEGER)",
      "CREATE INDEX i ON images (name)",
      "ALTER TABLE landmarks ADD COLUMN colour INTEGER",
      "ALTER TABLE landmarks RENAME COLUMN up_m TO down_m",
      "DROP TABLE image_lists",
      "DROP TABLE images; CREATE VIEW images AS SELECT 1 AS id",
      "DROP TABLE landmark_places; CREATE VIRTUAL TABLE landmark_places USING fts5(id)",
      "DROP TABLE landmark_places; CREATE VIRTUAL TABLE landmark_places USING rtree(id, a, b)",
      "DROP TABLE images; CREATE TABLE images (id INTEGER PRIMARY KEY, "
      "name TEXT AS (abs(id)))",
  };
  for (const char* change : changes) {
    WriteBytes(path_, sound);
    Change(path_, change);
    EXPECT_THAT(WhyNot(), AnyOf(HasSubstr("map.db: is not to be trusted"),
                                HasSubstr("map.db: is damaged: a table is missing")))
        << change;
    EXPECT_FALSE(FeatureMapWriter::Open(path_).ok()) << change;
  }
  WriteBytes(path_, sound);
  Change(path_, "PRAGMA journal_mode = WAL");
  EXPECT_THAT(WhyNot(), HasSubstr("its journal is of another kind"));
}

TEST_F(HostileMap, RefusesValuesNoMapCanHave) {
  const std::vector<std::uint8_t> sound = ReadBytes(path_);
  EXPECT_EQ(FirstFinding(), "sound");
  const std::pair<const char*, const char*> changes[] = {
      {"UPDATE landmarks SET covariance_nn_m2 = -1 WHERE id = 4",
       "map.db: landmarks: id 4: covariance is not positive"},
      {"UPDATE landmarks SET covariance_en_m2 = 9e9 WHERE id = 4", "id 4: covariance is not"},
      {"UPDATE landmarks SET covariance_uu_m2 = 1e300 WHERE id = 4", "id 4: covariance is above"},
      {"UPDATE landmarks SET covariance_uu_m2 = 9e999 WHERE id = 4",
       "id 4: covariance_uu_m2 is not finite"},
      {"UPDATE landmarks SET east_m = -9e999 WHERE id = 4", "id 4: east_m is not finite"},
      {"UPDATE landmarks SET east_m = 100001 WHERE id = 4", "id 4: position is more than 100 km"},
      {"UPDATE landmarks SET east_m = 1 WHERE id = 4", "id 4: is not where the landmark is"},
      {"UPDATE landmarks SET id = -5 WHERE id = 4", "landmarks: id 0: id is out of range"},
      {"UPDATE landmarks SET id = 5 WHERE id = 4", "landmark_places: id 5: is missing"},
      {"UPDATE landmarks SET id = 67108864 WHERE id = 4", "id 67108864: id is out of range"},
      {"UPDATE landmarks SET descriptors = 2 WHERE id = 4", "id 4: descriptors: the lists have"},
      {"DELETE FROM landmarks WHERE id = 4", "map: id 1: landmarks: says 40, there are 39"},
      {"DELETE FROM landmark_places WHERE id = 4", "landmark_places: id 4: is missing"},
      {"INSERT INTO landmark_places VALUES (9999, 0, 0, 0, 0, 0, 0)", "places of no landmark"},
      {"UPDATE landmark_places_node SET data = zeroblob(20)", "damaged"},
      {"DELETE FROM landmark_places_node", "damaged"},
      {"UPDATE images SET camera_from_enu_w = 3 WHERE id = 11", "images: id 11: attitude is not"},
      {"UPDATE images SET pose_known = 7 WHERE id = 11", "id 11: pose_known is out of range"},
      {"UPDATE images SET name = char(27) WHERE id = 11", "id 11: name is not plain"},
      {"UPDATE images SET name = CAST(x'ff41' AS TEXT) WHERE id = 11", "name is not plain"},
      {"DELETE FROM images WHERE id = 11", "images: says 6, there are 5"},
      {"DELETE FROM building_part_corners WHERE part_id = 4", "id 4: has fewer than three corners"},
      {"DELETE FROM building_part_corners WHERE corner > 1", "id 4: has fewer than three corners"},
      {"DELETE FROM building_part_corners WHERE corner = 1", "part_id 4: corner 2"},
      {"DELETE FROM building_parts WHERE id = 4", "part_id 4: corner 0"},
      {"UPDATE building_part_corners SET north_m = 9e999", "north_m is not finite"},
      {"UPDATE building_part_corners SET east_m = 2e5", "id 4: position is more than 100 km"},
      {"UPDATE building_part_corners SET east_m = -east_m", "id 4: footprint is not convex"},
      {"DELETE FROM building_part_corners WHERE corner = 0", "part_id 4: corner 1"},
      {"UPDATE building_parts SET base_m = top_m WHERE id = 9", "id 9: top is not above its base"},
      {"UPDATE building_parts SET base_m = -9e999 WHERE id = 9", "id 9: base_m is not finite"},
      {"UPDATE building_parts SET top_m = 1005 WHERE id = 9", "id 9: is taller than 1000 m"},
      {"UPDATE building_parts SET top_sigma_m = -1 WHERE id = 9", "id 9: top_sigma_m is out of"},
      {"UPDATE building_parts SET raised = 2 WHERE id = 9", "id 9: raised is out of range"},
      {"UPDATE building_parts SET building = char(27) WHERE id = 9", "id 9: building is not plain"},
      {"UPDATE map SET descriptor_kind = 3", "map: id 1: descriptor_kind is out of range"},
      {"UPDATE map SET descriptor_kind = 2", "descriptors of another kind"},
      {"UPDATE map SET origin_latitude_rad = 1.6", "latitude of the origin is out of range"},
      {"UPDATE map SET origin_height_m = 9e999", "origin_height_m is not finite"},
      {"UPDATE map SET epoch_year = 20240", "epoch is out of range"},
      {"UPDATE map SET id = 'abc'", "id is not 32 hexadecimal digits"},
      {"UPDATE map SET id = printf('%032d', 5)", "damaged or the index of another map"},
      {"UPDATE map SET landmarks = -1", "landmarks is out of range"},
      {"UPDATE map SET landmarks = 2000000000", "says 2000000000, there are 40"},
      {"UPDATE map SET descriptors = 1", "descriptors: says 1, there are 120"},
      {"UPDATE map SET provenance = zeroblob(0) || char(7)", "provenance is not plain"},
      {"UPDATE map SET provenance = printf('%.*c', 100001, 'x')", "provenance is too long"},
      {"DELETE FROM map", "map: has no row"},
      {"INSERT INTO map SELECT 2, id, 0, 0, 0, datum, 0, 1, '', 0, 0, 0, 0, 0, 0 FROM map",
       "map: has more than one row"},
      {"DELETE FROM descriptor_quantizer", "the look-up index is missing"},
      {"UPDATE descriptor_quantizer SET quantizer = zeroblob(9)", "damaged or the index of"},
      {"UPDATE descriptor_lists SET index_id = 5", "list 0 part 0: belongs to another index"},
      {"UPDATE descriptor_lists SET list_part = -7 WHERE list_part = 0", "says 120, there are 0"},
      {"UPDATE descriptor_lists SET list_part = 9999999999999", "is out of place"},
      {"UPDATE descriptor_lists SET descriptors = zeroblob(100)", "list 0 part 0: "},
      {"UPDATE descriptor_lists SET descriptors = substr(descriptors, 1, 99)", "list 0 part 0: "},
      {"DELETE FROM descriptor_lists", "descriptors: says 120, there are 0"},
      {"DELETE FROM image_lists WHERE image_id = 12", "image_lists: image_id 13: is not what"},
      {"UPDATE image_lists SET list_part = 4 WHERE image_id = 12", "image_lists: image_id 12: is"},
  };
  for (const auto& [change, finding] : changes) {
    WriteBytes(path_, sound);
    Change(path_, change);
    const std::string found = FirstFinding();
    EXPECT_THAT(found, HasSubstr(finding)) << change;
    EXPECT_THAT(found, HasSubstr("map.db: ")) << change;
    if (const auto map = FeatureMap::OpenBytes("fuzzed", ReadBytes(path_))) ExpectSound(**map);
  }
}

TEST_F(HostileMap, RefusesListsAndIndexOfAnotherMap) {
  const std::vector<std::uint8_t> sound = ReadBytes(path_);
  MapScene::Size size;
  size.kind = DescriptorKind::kOrb;
  ASSERT_TRUE(MapScene(33, size).Make(folder_.File("orb.db")).ok());
  ASSERT_TRUE(MapScene(34).Make(folder_.File("sift.db")).ok());
  const auto take = [&](const std::string& from, const std::string& table) {
    WriteBytes(path_, sound);
    Change(path_, "ATTACH '" + folder_.File(from) + "' AS other; DELETE FROM main." + table +
                      "; INSERT INTO main." + table + " SELECT * FROM other." + table);
    return FirstFinding();
  };
  EXPECT_THAT(take("orb.db", "descriptor_lists"), HasSubstr("belongs to another index"));
  EXPECT_THAT(take("sift.db", "descriptor_lists"), HasSubstr("belongs to another index"));
  EXPECT_THAT(take("orb.db", "descriptor_quantizer"), HasSubstr("the index of another map"));
  EXPECT_THAT(take("orb.db", "map"), HasSubstr("the index of another map"));

  // With the index's mark forged, the block itself tells.
  WriteBytes(path_, sound);
  Change(path_, "ATTACH '" + folder_.File("orb.db") +
                    "' AS other; UPDATE main.descriptor_lists SET descriptors = "
                    "(SELECT descriptors FROM other.descriptor_lists LIMIT 1)");
  EXPECT_THAT(FirstFinding(), HasSubstr("map.db: descriptor_lists: list 0 part 0: "));
}

// A chain of nodes of the R*Tree, each of whose 51 boxes leads to the next and covers everything: a
// walk through all 51^30 ways would take longer than the earth will last.
TEST_F(HostileMap, GivesUpATreeOfPlacesWithoutEnd) {
  const auto node = [](int depth, int child) {
    const auto hex = [](std::uint32_t value) {
      std::array<char, 9> digits{};
      std::snprintf(digits.data(), digits.size(), "%08x", value);
      return std::string(digits.data());
    };
    std::string bytes = hex((static_cast<std::uint32_t>(depth) << 16) | 51);
    for (int cell = 0; cell < 51; ++cell) {
      bytes += hex(0) + hex(static_cast<std::uint32_t>(child));
      for (int axis = 0; axis < 3; ++axis) bytes += hex(0xc7c35000) + hex(0x47c35000);  // 100 km
    }
    return "x'" + bytes + "'";
  };
  std::string chain = "DELETE FROM landmark_places_node;";
  for (int i = 1; i <= 31; ++i) {
    chain += "INSERT INTO landmark_places_node VALUES (" + std::to_string(i) + ", " +
             node(i == 1 ? 30 : 0, i + 1) + ");";
  }
  Change(path_, chain);
  const auto map = FeatureMap::Open(path_);
  ASSERT_TRUE(map.ok()) << map.error().message;
  const auto around = (*map)->LandmarksWithin({0, 0, 0}, 10.0);
  ASSERT_FALSE(around.ok());
  EXPECT_THAT(around.error().message, HasSubstr("map.db: is damaged"));
  EXPECT_THAT((*map)->Check(3), Not(IsEmpty()));
}

TEST_F(HostileMap, SaysWhenItIsCutShort) {
  const std::vector<std::uint8_t> whole = ReadBytes(path_);
  ASSERT_EQ(whole.size() % 65'536, 0U);
  std::set<std::size_t> lengths = {1, 15, 16, 17, 99, 100, 101, 511, 512, 4096, 65'535, 65'536};
  Random random(35);
  for (int i = 0; i < 40; ++i) lengths.insert(random.Index(whole.size()));
  for (std::size_t pages = 1; pages * 65'536 < whole.size(); ++pages) {
    lengths.insert({pages * 65'536 - 1, pages * 65'536, pages * 65'536 + 1});
  }
  for (const std::size_t length : lengths) {
    if (length >= whole.size()) continue;
    WriteBytes(path_, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)});
    // SQLite itself takes a file of one byte for an empty one.
    EXPECT_THAT(WhyNot(), HasSubstr(length == 1 ? "map.db: is empty" : "map.db: is cut short"))
        << length;
  }
}

class FlippedMap : public ::testing::TestWithParam<DescriptorKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, FlippedMap,
                         ::testing::Values(DescriptorKind::kRootSift, DescriptorKind::kOrb));

TEST_P(FlippedMap, IsRefusedOrSoundWhateverByteIsWrong) {
  const ScratchFolder folder;
  const std::vector<std::uint8_t> sound = SmallMap(folder, GetParam());
  ASSERT_LT(sound.size(), 40'000U);
  {
    const auto map = FeatureMap::OpenBytes("fuzzed", sound);
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_THAT((*map)->Check(9), IsEmpty());
  }
  Random random(36);
  int opened = 0;
  constexpr int kRounds = 3000;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::uint8_t> bytes = sound;
    const std::uint64_t changes = 1 + random.Index(round % 3 == 0 ? 20 : 2);
    for (std::uint64_t i = 0; i < changes; ++i) {
      std::uint8_t& byte = bytes[random.Index(round % 2 == 0 ? bytes.size() : 4096)];
      byte = static_cast<std::uint8_t>(random.Index(2) == 0 ? random.Index(256)
                                                            : byte ^ (1U << random.Index(8)));
    }
    const auto map = FeatureMap::OpenBytes("fuzzed", std::move(bytes));
    if (!map) {
      EXPECT_THAT(map.error().message, HasSubstr("fuzzed: "));
      continue;
    }
    ++opened;
    ExpectSound(**map);
  }
  EXPECT_GT(opened, kRounds / 10);
  EXPECT_LT(opened, kRounds);
}

// Also through the file system, mapped into memory, and by the writer.
TEST_P(FlippedMap, IsNoDangerOnTheDiskOrToTheWriter) {
  const ScratchFolder folder;
  const std::vector<std::uint8_t> sound = SmallMap(folder, GetParam());
  const std::string path = folder.File("fuzzed.db");
  Random random(37);
  int committed = 0;
  for (int round = 0; round < 150; ++round) {
    std::vector<std::uint8_t> bytes = sound;
    for (int i = 0; i < 3; ++i) {
      bytes[random.Index(bytes.size())] = static_cast<std::uint8_t>(random.Index(256));
    }
    WriteBytes(path, bytes);
    if (const auto map = FeatureMap::Open(path)) ExpectSound(**map);
    auto writer = FeatureMapWriter::Open(path);
    if (!writer) {
      EXPECT_THAT(writer.error().message, HasSubstr("fuzzed.db: "));
      continue;
    }
    static_cast<void>((*writer)->RemoveImage(10).ok());
    const std::vector<std::uint32_t> ids = {7};
    static_cast<void>((*writer)->RemoveLandmarks(ids).ok());
    static_cast<void>((*writer)->Reindex(3).ok());
    if ((*writer)->Commit()) ++committed;
  }
  EXPECT_GT(committed, 15);
}

}  // namespace
}  // namespace lodemark
