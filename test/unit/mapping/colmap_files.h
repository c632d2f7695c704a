// Writes a COLMAP database as COLMAP 3 and 4 do, for tests.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lodemark::test {

class ColmapDatabaseWriter {
 public:
  explicit ColmapDatabaseWriter(const std::string& path) {
    sqlite3_open(path.c_str(), &database_);
    Run("CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT, camera_id INTEGER)");
    for (const char* const table : {"keypoints", "descriptors"}) {
      Run("CREATE TABLE " + std::string(table) +
          " (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB)");
    }
    Run("BEGIN");
  }
  ~ColmapDatabaseWriter() {
    Run("COMMIT");
    sqlite3_close(database_);
  }
  ColmapDatabaseWriter(const ColmapDatabaseWriter&) = delete;
  ColmapDatabaseWriter& operator=(const ColmapDatabaseWriter&) = delete;

  void Run(const std::string& sql) {
    sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr);
  }

  void AddImage(int id, const std::string& name) {
    Run("INSERT INTO images VALUES (" + std::to_string(id) + ", '" + name + "', 1)");
  }

  // Rows of so many columns; for keypoints floats, for descriptors bytes.
  template <typename Value>
  void AddBlock(const char* table, int image_id, int columns, const std::vector<Value>& values) {
    sqlite3_stmt* statement = nullptr;
    const std::string sql = "INSERT INTO " + std::string(table) + " VALUES (?, ?, ?, ?)";
    sqlite3_prepare_v2(database_, sql.c_str(), -1, &statement, nullptr);
    sqlite3_bind_int(statement, 1, image_id);
    sqlite3_bind_int(statement, 2, static_cast<int>(values.size()) / columns);
    sqlite3_bind_int(statement, 3, columns);
    sqlite3_bind_blob(statement, 4, values.data(), static_cast<int>(values.size() * sizeof(Value)),
                      SQLITE_TRANSIENT);
    sqlite3_step(statement);
    sqlite3_finalize(statement);
  }

 private:
  sqlite3* database_ = nullptr;
};

}  // namespace lodemark::test
