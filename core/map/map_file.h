// The file of a feature map as reader and writer find it: opened, recognised, its one-row tables
// read.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/map/descriptor_index.h"
#include "core/map/map_rows.h"
#include "core/map/map_schema.h"
#include "core/map/sqlite_connection.h"

namespace lodemark {

struct MapFile {
  std::unique_ptr<SqliteConnection> connection;
  std::int64_t size_bytes = 0;
  std::int64_t version = kMapVersion;
  MapRow map;
  std::optional<DescriptorQuantizer> quantizer;  // there once this is loaded
  std::uint32_t landmark_id_limit = 0;
};

// Takes no time that grows with the map. Leaves the transaction open in which it read.
Result<MapFile> LoadMapFile(std::unique_ptr<SqliteConnection> connection, MapAccess access);

}  // namespace lodemark
