#include "core/map/map_schema.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/map/sqlite_statement.h"

namespace lodemark {
namespace {

constexpr std::uint32_t kApplicationId = 0x4c6f6465;  // "Lode"
// The tables of the first version's buildings, which nothing was ever written to.
constexpr const char* kBuildingTablesOfVersion1 = R"(
CREATE TABLE building_part_corners (
  part_id INTEGER NOT NULL,
  corner INTEGER NOT NULL,
  east_m REAL NOT NULL,
  north_m REAL NOT NULL,
  up_m REAL NOT NULL,
  PRIMARY KEY (part_id, corner)
) STRICT, WITHOUT ROWID;
CREATE TABLE building_parts (id INTEGER PRIMARY KEY) STRICT;
)";

constexpr const char* kBuildingTables = R"(
CREATE TABLE building_part_corners (
  part_id INTEGER NOT NULL,
  corner INTEGER NOT NULL,
  east_m REAL NOT NULL,
  north_m REAL NOT NULL,
  PRIMARY KEY (part_id, corner)
) STRICT, WITHOUT ROWID;
CREATE TABLE building_parts (
  id INTEGER PRIMARY KEY,
  building TEXT NOT NULL,
  base_m REAL NOT NULL,
  top_m REAL NOT NULL,
  top_sigma_m REAL NOT NULL,
  raised INTEGER NOT NULL
) STRICT;
)";

// Those of both versions. By name they come after the buildings.
constexpr const char* kCommonTables = R"(
CREATE TABLE descriptor_lists (
  list_part INTEGER PRIMARY KEY,
  index_id INTEGER NOT NULL,
  descriptors BLOB NOT NULL
) STRICT;
CREATE TABLE descriptor_quantizer (
  one INTEGER PRIMARY KEY,
  quantizer BLOB NOT NULL
) STRICT;
CREATE TABLE image_lists (
  image_id INTEGER NOT NULL,
  list_part INTEGER NOT NULL,
  PRIMARY KEY (image_id, list_part)
) STRICT, WITHOUT ROWID;
CREATE TABLE images (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  pose_known INTEGER NOT NULL,
  east_m REAL NOT NULL,
  north_m REAL NOT NULL,
  up_m REAL NOT NULL,
  camera_from_enu_w REAL NOT NULL,
  camera_from_enu_x REAL NOT NULL,
  camera_from_enu_y REAL NOT NULL,
  camera_from_enu_z REAL NOT NULL
) STRICT;
CREATE VIRTUAL TABLE landmark_places USING rtree(
  id, least_east_m, greatest_east_m, least_north_m, greatest_north_m, least_up_m, greatest_up_m);
CREATE TABLE landmarks (
  id INTEGER PRIMARY KEY,
  east_m REAL NOT NULL,
  north_m REAL NOT NULL,
  up_m REAL NOT NULL,
  covariance_ee_m2 REAL NOT NULL,
  covariance_en_m2 REAL NOT NULL,
  covariance_nn_m2 REAL NOT NULL,
  covariance_eu_m2 REAL NOT NULL,
  covariance_nu_m2 REAL NOT NULL,
  covariance_uu_m2 REAL NOT NULL,
  descriptors INTEGER NOT NULL
) STRICT;
CREATE TABLE map (
  one INTEGER PRIMARY KEY,
  id TEXT NOT NULL,
  origin_latitude_rad REAL NOT NULL,
  origin_longitude_rad REAL NOT NULL,
  origin_height_m REAL NOT NULL,
  datum TEXT NOT NULL,
  epoch_year REAL NOT NULL,
  descriptor_kind INTEGER NOT NULL,
  provenance TEXT NOT NULL,
  landmarks INTEGER NOT NULL,
  descriptors INTEGER NOT NULL,
  images INTEGER NOT NULL,
  building_parts INTEGER NOT NULL,
  index_id INTEGER NOT NULL,
  indexed_descriptors INTEGER NOT NULL
) STRICT;
)";

// What the R*Tree makes for itself, by its version with or without a type.
constexpr std::string_view kPlaceTables[] = {
    "CREATETABLElandmark_places_node(nodenoINTEGERPRIMARYKEY,data)",
    "CREATETABLElandmark_places_parent(nodenoINTEGERPRIMARYKEY,parentnode)",
    "CREATETABLElandmark_places_rowid(rowidINTEGERPRIMARYKEY,nodeno)",
};

// A statement without blanks, quotation marks and the type of the R*Tree's nodes.
std::string Squeezed(std::string_view sql) {
  std::string squeezed;
  for (const char c : sql) {
    if (c != ' ' && c != '\n' && c != '"') squeezed.push_back(c);
  }
  if (const std::size_t blob = squeezed.find("dataBLOB)"); blob != std::string::npos) {
    squeezed.erase(blob + 4, 4);
  }
  return squeezed;
}

// The statements that make a map's tables, squeezed, in the order of their names.
std::vector<std::string> ExpectedStatements(std::int64_t version) {
  std::vector<std::string> statements;
  for (std::string_view rest :
       {version == 1 ? kBuildingTablesOfVersion1 : kBuildingTables, kCommonTables}) {
    for (std::size_t end = rest.find(';'); end != std::string_view::npos; end = rest.find(';')) {
      const std::string statement = Squeezed(rest.substr(0, end));
      rest.remove_prefix(end + 1);
      statements.push_back(statement);
      if (statement.find("VIRTUAL") == std::string::npos) continue;
      for (const std::string_view table : kPlaceTables) statements.emplace_back(table);
    }
  }
  return statements;
}

Status CheckTables(SqliteConnection& connection, std::int64_t version) {
  const std::vector<std::string> expected = ExpectedStatements(version);
  SqliteStatement entries(&connection, "SELECT type, name, sql FROM sqlite_schema ORDER BY name");
  std::size_t count = 0;
  while (entries.Step()) {
    const std::string_view type = entries.Text(0).value_or("?");
    const std::string name(entries.Text(1).value_or("?").substr(0, 60));
    if (type != "table") {
      return connection.MakeError(ErrorCode::kBadData,
                                  "is not to be trusted: it holds something other than tables; get "
                                  "the map again from where it was made");
    }
    const std::string statement = Squeezed(entries.Text(2).value_or(""));
    if (count == expected.size() || statement != expected[count]) {
      return connection.MakeError(ErrorCode::kBadData,
                                  "is not to be trusted: its tables are not those of a feature "
                                  "map of version " +
                                      std::to_string(version) +
                                      "; get the map again from where it was made");
    }
    ++count;
  }
  if (Status status = entries.status(); !status) return status;
  if (count != expected.size()) {
    return connection.MakeError(ErrorCode::kBadData,
                                "is damaged: a table is missing; get it again from where it was "
                                "made");
  }
  return {};
}

// https://www.sqlite.org/fileformat.html section 1.3: numbers are big-endian.
struct Header {
  std::array<std::uint8_t, 100> bytes;

  std::uint32_t Number(std::size_t offset) const {
    return (std::uint32_t{bytes[offset]} << 24) | (std::uint32_t{bytes[offset + 1]} << 16) |
           (std::uint32_t{bytes[offset + 2]} << 8) | bytes[offset + 3];
  }
  // As far as a file of this length can say.
  bool IsSqlite(std::int64_t size_bytes) const {
    constexpr std::string_view kMagic("SQLite format 3\0", 16);
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()), kMagic.size());
    const auto length = static_cast<std::size_t>(std::clamp<std::int64_t>(size_bytes, 0, 16));
    return start.substr(0, length) == kMagic.substr(0, length);
  }
  bool IsWhole(std::int64_t size_bytes) const {
    return IsSqlite(size_bytes) && size_bytes >= static_cast<std::int64_t>(bytes.size());
  }
  std::int64_t page_bytes() const {
    const int size = bytes[16] * 256 + bytes[17];
    return size == 1 ? 65'536 : size;
  }
  bool WritesAhead() const { return bytes[18] != 1 || bytes[19] != 1; }
  std::int64_t pages() const { return Number(28); }
  std::uint32_t text_encoding() const { return Number(56); }
  std::uint32_t user_version() const { return Number(60); }
  std::uint32_t application_id() const { return Number(68); }
};

}  // namespace

Status CreateMapTables(SqliteConnection& connection) {
  // The size of the pages counts only before the first of them is written.
  const std::string settings = "PRAGMA page_size = " + std::to_string(kMapPage_bytes) +
                               "; PRAGMA auto_vacuum = NONE; PRAGMA encoding = 'UTF-8'";
  if (Status status = connection.Execute(settings.c_str()); !status) return status;
  if (Status status = Begin(connection, MapAccess::kWrite); !status) return status;
  const std::string versions = "PRAGMA application_id = " + std::to_string(kApplicationId) +
                               "; PRAGMA user_version = " + std::to_string(kMapVersion);
  if (Status status = connection.Execute(versions.c_str()); !status) return status;
  if (Status status = connection.Execute(kBuildingTables); !status) return status;
  return connection.Execute(kCommonTables);
}

Status Begin(SqliteConnection& connection, MapAccess access) {
  // Of a reader before, whose end found no memory.
  if (access == MapAccess::kRead && connection.InTransaction()) {
    if (Status status = connection.Execute("ROLLBACK"); !status) return status;
  }
  // Another writer may take long, so do not wait for it; readers at Commit do not.
  if (access == MapAccess::kWrite) {
    connection.WaitForOthers(false);
    Status status = connection.Execute("BEGIN IMMEDIATE");
    connection.WaitForOthers(true);
    return status;
  }
  // The statement after BEGIN is what takes the lock; this one does so without looking at tables.
  return connection.Execute("BEGIN; PRAGMA application_id");
}

Result<RecognisedMap> BeginOnUnknownFile(SqliteConnection& connection, MapAccess access) {
  const auto bad = [&](std::string_view sentence) {
    return connection.MakeError(ErrorCode::kBadData, sentence);
  };
  Header header{};
  // Before anything else, because SQLite would read and make files beside such a one.
  const SqliteConnection::RawFile before = connection.ReadRaw(header.bytes);
  if (before.read && header.IsWhole(before.size_bytes) && header.WritesAhead()) {
    return bad(header.application_id() == kApplicationId
                   ? "is not to be trusted: its journal is of another kind than a feature map's"
                   : "is not a feature map: an SQLite file of another kind");
  }
  const Status begin = Begin(connection, access);
  const SqliteConnection::RawFile raw = connection.ReadRaw(header.bytes);
  if (!begin && begin.error().code != ErrorCode::kBadData) return begin.error();
  if (!raw.read) return connection.MakeError(ErrorCode::kIo, "cannot be read");
  if (raw.size_bytes == 0) return bad("is empty");
  if (!header.IsSqlite(raw.size_bytes)) return bad("is not a feature map: not an SQLite file");
  if (!header.IsWhole(raw.size_bytes)) return bad("is cut short; get it again");
  if (header.application_id() != kApplicationId) {
    return bad("is not a feature map: an SQLite file of another kind");
  }
  if (header.user_version() > kMapVersion) {
    return Error{ErrorCode::kUnsupported,
                 connection.name() + ": is a feature map of version " +
                     std::to_string(header.user_version()) + ", newer than this program, which " +
                     "knows version " + std::to_string(kMapVersion) + "; update the program"};
  }
  if (header.user_version() < 1) {
    return bad("is damaged: there is no feature map of version " +
               std::to_string(header.user_version()));
  }
  const std::int64_t whole_bytes = header.pages() * header.page_bytes();
  if (raw.size_bytes < whole_bytes) {
    return bad("is cut short: " + std::to_string(raw.size_bytes) + " of " +
               std::to_string(whole_bytes) + " bytes; get it again");
  }
  if (!begin) return begin.error();
  if (header.text_encoding() != 1) {
    return bad("is not to be trusted: its text is of another encoding than a feature map's");
  }
  connection.AllowWork(raw.size_bytes);
  const std::int64_t version = header.user_version();
  if (Status status = CheckTables(connection, version); !status) return status.error();
  return RecognisedMap{raw.size_bytes, version};
}

}  // namespace lodemark
