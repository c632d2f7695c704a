#include "core/map/map_file.h"

#include <utility>

#include "core/map/sqlite_statement.h"

namespace lodemark {
namespace {

Status LoadMapRow(MapFile& file) {
  SqliteStatement row(file.connection.get(), kSelectMap);
  if (!row.Step()) {
    if (Status status = row.status(); !status) return status;
    return file.connection->MakeError(ErrorCode::kBadData,
                                      "map: has no row; get the map again from where it was made");
  }
  Result<MapRow> map = ReadMapRow(*file.connection, row);
  if (!map) return map.error();
  file.map = *std::move(map);
  if (row.Step()) {
    return file.connection->MakeError(ErrorCode::kBadData, "map: has more than one row");
  }
  return row.status();
}

Status LoadQuantizer(MapFile& file) {
  const auto bad = [&](const std::string& sentence) {
    return file.connection->MakeError(ErrorCode::kBadData, "descriptor_quantizer: " + sentence);
  };
  SqliteStatement row(file.connection.get(),
                      "SELECT quantizer FROM descriptor_quantizer WHERE one = 1");
  if (!row.Step()) {
    if (Status status = row.status(); !status) return status;
    return bad("has no row; the look-up index is missing: make it again");
  }
  const std::optional<std::span<const std::uint8_t>> bytes = row.Blob(0);
  if (!bytes) return bad("quantizer is not a blob");
  if (IndexId(file.map.info.id, *bytes) != file.map.index_id) {
    return bad("is damaged or the index of another map; get the map again from where it was made");
  }
  Result<DescriptorQuantizer> quantizer = DescriptorQuantizer::Parse(*bytes);
  if (!quantizer) return bad(quantizer.error().message);
  if (quantizer->kind() != file.map.info.descriptor_kind) {
    return bad("is for descriptors of another kind than the map's");
  }
  file.quantizer.emplace(*std::move(quantizer));
  return {};
}

Status LoadLandmarkIdLimit(MapFile& file) {
  SqliteStatement row(file.connection.get(), "SELECT id FROM landmarks ORDER BY id DESC LIMIT 1");
  if (!row.Step()) return row.status();
  const std::int64_t largest = row.Integer(0).value_or(-1);
  if (largest < 0 || largest > kLargestLandmarkId) {
    return file.connection->MakeError(
        ErrorCode::kBadData, "landmarks: id " + std::to_string(largest) + ": id is out of range");
  }
  file.landmark_id_limit = static_cast<std::uint32_t>(largest) + 1;
  return {};
}

}  // namespace

Result<MapFile> LoadMapFile(std::unique_ptr<SqliteConnection> connection, MapAccess access) {
  MapFile file;
  file.connection = std::move(connection);
  const Result<RecognisedMap> recognised = BeginOnUnknownFile(*file.connection, access);
  if (!recognised) return recognised.error();
  file.size_bytes = recognised->size_bytes;
  file.version = recognised->version;
  for (Status (*load)(MapFile&) : {LoadMapRow, LoadQuantizer, LoadLandmarkIdLimit}) {
    if (Status status = load(file); !status) return status.error();
  }
  return file;
}

}  // namespace lodemark
