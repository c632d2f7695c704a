// The tables of a feature map's file, and whether a file has these and no others.
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/map/sqlite_connection.h"

namespace lodemark {

// The newest version. Version 1 is read too: its buildings had no form of use.
constexpr std::int64_t kMapVersion = 2;

// A part of a list fills one page, so that a read touches no other.
constexpr int kMapPage_bytes = 65'536;
constexpr std::int64_t kLargestListPart_bytes = 65'400;

// A list's parts have keys that follow one another.
constexpr int kPartBits = 32;
constexpr std::int64_t ListPartKey(std::int64_t list, std::int64_t part) {
  return (list << kPartBits) + part;
}
constexpr std::int64_t ListOfKey(std::int64_t key) { return key >> kPartBits; }
constexpr std::int64_t PartOfKey(std::int64_t key) {
  return key & ((std::int64_t{1} << kPartBits) - 1);
}

// Makes the tables in an empty file, within the transaction that is begun here.
Status CreateMapTables(SqliteConnection& connection);

// Begins a transaction that only reads, or one that will write and lets no other writer in.
enum class MapAccess : std::uint8_t { kRead, kWrite };
Status Begin(SqliteConnection& connection, MapAccess access);

// Begins a file's first transaction, in which it turns out whether the file is a feature map of
// this version, whole, and has exactly the tables of one. Takes no time that grows with the map.
struct RecognisedMap {
  std::int64_t size_bytes = 0;
  std::int64_t version = 0;
};
Result<RecognisedMap> BeginOnUnknownFile(SqliteConnection& connection, MapAccess access);

}  // namespace lodemark
