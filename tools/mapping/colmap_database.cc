#include "tools/mapping/colmap_database.h"

#include <sqlite3.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <utility>

namespace lodemark {
namespace {

constexpr std::int64_t kDescriptorColumns = 128;
constexpr std::int64_t kMostFeatures = 10'000'000;
constexpr int kLongestValue_bytes = 2'000'000'000;

struct StatementEnd {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, StatementEnd>;

// What a table's row says it holds, and the bytes. Valid until the statement moves on.
struct Block {
  std::int64_t rows = 0;
  std::int64_t columns = 0;
  const unsigned char* bytes = nullptr;
  std::size_t size = 0;
};

}  // namespace

struct ColmapDatabase::Connection {
  ~Connection() { sqlite3_close_v2(database); }

  Error Fault(const std::string& what) const { return {ErrorCode::kBadData, path + ": " + what}; }

  Result<Statement> Prepare(const char* sql) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database, sql, -1, &statement, nullptr) != SQLITE_OK) {
      return Fault(std::string("is no database of COLMAP's: ") + sqlite3_errmsg(database));
    }
    return Statement(statement);
  }

  // The row of an image in the table of the statement.
  Result<Block> BlockOf(sqlite3_stmt* statement, std::int64_t image_id,
                        const std::string& what) const {
    sqlite3_reset(statement);
    sqlite3_bind_int64(statement, 1, image_id);
    const int step = sqlite3_step(statement);
    if (step == SQLITE_DONE) return Block{};
    if (step != SQLITE_ROW) return Fault(what + ": " + sqlite3_errmsg(database));
    Block block;
    block.rows = sqlite3_column_int64(statement, 0);
    block.columns = sqlite3_column_int64(statement, 1);
    block.bytes = static_cast<const unsigned char*>(sqlite3_column_blob(statement, 2));
    block.size = static_cast<std::size_t>(sqlite3_column_bytes(statement, 2));
    if (block.rows < 0 || block.rows > kMostFeatures || block.columns < 0 || block.columns > 1024) {
      return Fault(what + ": has an absurd size");
    }
    return block;
  }

  std::string path;
  sqlite3* database = nullptr;
  Statement image_by_name;
  Statement keypoints;
  Statement descriptors;
};

ColmapDatabase::ColmapDatabase(std::unique_ptr<Connection> connection)
    : connection_(std::move(connection)) {}
ColmapDatabase::~ColmapDatabase() = default;

Result<std::unique_ptr<ColmapDatabase>> ColmapDatabase::Open(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return Error{ErrorCode::kIo, path + ": is a folder, a file is needed"};
  }
  auto connection = std::make_unique<Connection>();
  connection->path = path;
  if (sqlite3_open_v2(path.c_str(), &connection->database, SQLITE_OPEN_READONLY, nullptr) !=
      SQLITE_OK) {
    return Error{ErrorCode::kIo,
                 path + ": cannot be read: " + sqlite3_errmsg(connection->database)};
  }
  // The file may be anybody's: its schema gets no say in what is run.
  sqlite3_db_config(connection->database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(connection->database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_limit(connection->database, SQLITE_LIMIT_LENGTH, kLongestValue_bytes);
  for (const auto& [sql, statement] :
       {std::pair("SELECT image_id FROM images WHERE name = ?1", &connection->image_by_name),
        std::pair("SELECT rows, cols, data FROM keypoints WHERE image_id = ?1",
                  &connection->keypoints),
        std::pair("SELECT rows, cols, data FROM descriptors WHERE image_id = ?1",
                  &connection->descriptors)}) {
    Result<Statement> prepared = connection->Prepare(sql);
    if (!prepared) return prepared.error();
    *statement = std::move(prepared).value();
  }
  return std::unique_ptr<ColmapDatabase>(new ColmapDatabase(std::move(connection)));
}

Result<ColmapImageFeatures> ColmapDatabase::Features(const ColmapImage& image) {
  sqlite3_stmt* const by_name = connection_->image_by_name.get();
  sqlite3_reset(by_name);
  sqlite3_bind_text(by_name, 1, image.name.data(), static_cast<int>(image.name.size()),
                    SQLITE_STATIC);
  const int step = sqlite3_step(by_name);
  const std::int64_t image_id = step == SQLITE_ROW ? sqlite3_column_int64(by_name, 0) : 0;
  sqlite3_reset(by_name);
  sqlite3_clear_bindings(by_name);
  if (step == SQLITE_DONE) {
    return connection_->Fault("has no image '" + image.name + "', which the model has");
  }
  if (step != SQLITE_ROW) return connection_->Fault(sqlite3_errmsg(connection_->database));

  const std::string where = "descriptors of " + image.name;
  const Result<Block> found = connection_->BlockOf(connection_->descriptors.get(), image_id, where);
  if (!found) return found.error();
  const auto count = static_cast<std::size_t>(found->rows);
  if (found->rows > 0 && found->columns != kDescriptorColumns) {
    return Error{ErrorCode::kUnsupported, connection_->path + ": " + where + ": have " +
                                              std::to_string(found->columns) +
                                              " bytes each, not SIFT's 128"};
  }
  if (found->size != count * static_cast<std::size_t>(found->columns)) {
    return connection_->Fault(where + ": hold " + std::to_string(found->size) +
                              " bytes instead of " + std::to_string(count * 128));
  }
  if (count != image.features.size()) {
    return connection_->Fault(
        where + ": are " + std::to_string(count) + ", but the model's image has " +
        std::to_string(image.features.size()) + " features: a database of another model?");
  }
  ColmapImageFeatures features;
  features.count = count;
  if (count > 0) features.descriptors.assign(found->bytes, found->bytes + found->size);

  // Rows of x y, x y scale orientation, or x y and a 2 x 2 affine shape (COLMAP,
  // feature/keypoint.h).
  const Result<Block> keypoints =
      connection_->BlockOf(connection_->keypoints.get(), image_id, "keypoints of " + image.name);
  if (!keypoints) return keypoints.error();
  const auto columns = static_cast<std::size_t>(keypoints->columns);
  const bool has_scale = columns == 4 || columns == 6;
  if (!has_scale || static_cast<std::size_t>(keypoints->rows) != count ||
      keypoints->size != count * columns * sizeof(float)) {
    return features;
  }
  features.scale_px.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    float row[6] = {};
    std::memcpy(row, keypoints->bytes + i * columns * sizeof(float), columns * sizeof(float));
    const double scale = columns == 4 ? static_cast<double>(row[2])
                                      : std::sqrt(std::abs(static_cast<double>(row[2]) * row[5] -
                                                           static_cast<double>(row[3]) * row[4]));
    features.scale_px[i] = scale > 0.0 && scale < 1e5 ? static_cast<float>(scale) : 1.0F;
  }
  return features;
}

}  // namespace lodemark
