#include "core/map/sqlite_statement.h"

#include <sqlite3.h>

namespace lodemark {

SqliteStatement::SqliteStatement(SqliteConnection* connection, const char* sql)
    : connection_(connection) {
  Keep(sqlite3_prepare_v3(connection->handle(), sql, -1, SQLITE_PREPARE_PERSISTENT, &statement_,
                          nullptr));
}

SqliteStatement::~SqliteStatement() { sqlite3_finalize(statement_); }

void SqliteStatement::Keep(int code) {
  if (code_ == SQLITE_OK) code_ = code;
}

void SqliteStatement::Bind(int parameter, std::int64_t value) {
  Keep(sqlite3_bind_int64(statement_, parameter, value));
}

void SqliteStatement::Bind(int parameter, double value) {
  Keep(sqlite3_bind_double(statement_, parameter, value));
}

void SqliteStatement::Bind(int parameter, std::string_view text) {
  // A null pointer would bind NULL.
  Keep(sqlite3_bind_text64(statement_, parameter, text.empty() ? "" : text.data(), text.size(),
                           SQLITE_STATIC, SQLITE_UTF8));
}

void SqliteStatement::Bind(int parameter, std::span<const std::uint8_t> blob) {
  if (blob.empty()) {
    Keep(sqlite3_bind_zeroblob(statement_, parameter, 0));
  } else {
    Keep(sqlite3_bind_blob64(statement_, parameter, blob.data(), blob.size(), SQLITE_STATIC));
  }
}

bool SqliteStatement::Step() {
  if (code_ != SQLITE_OK) return false;
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) code_ = code;
  return false;
}

Status SqliteStatement::status() const {
  if (code_ == SQLITE_OK) return {};
  return connection_->Explain(code_);
}

void SqliteStatement::Reset() {
  if (statement_ == nullptr) return;
  sqlite3_reset(statement_);
  code_ = SQLITE_OK;
}

Status SqliteStatement::Run() {
  while (Step()) {
  }
  Status result = status();
  Reset();
  return result;
}

std::optional<std::int64_t> SqliteStatement::Integer(int column) const {
  if (sqlite3_column_type(statement_, column) != SQLITE_INTEGER) return std::nullopt;
  return sqlite3_column_int64(statement_, column);
}

std::optional<double> SqliteStatement::Real(int column) const {
  if (sqlite3_column_type(statement_, column) != SQLITE_FLOAT) return std::nullopt;
  return sqlite3_column_double(statement_, column);
}

std::optional<std::string_view> SqliteStatement::Text(int column) const {
  if (sqlite3_column_type(statement_, column) != SQLITE_TEXT) return std::nullopt;
  const unsigned char* text = sqlite3_column_text(statement_, column);
  if (text == nullptr) return std::nullopt;
  return std::string_view(reinterpret_cast<const char*>(text),
                          static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
}

std::optional<std::span<const std::uint8_t>> SqliteStatement::Blob(int column) const {
  if (sqlite3_column_type(statement_, column) != SQLITE_BLOB) return std::nullopt;
  const void* blob = sqlite3_column_blob(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  if (blob == nullptr) return std::span<const std::uint8_t>();
  return std::span(static_cast<const std::uint8_t*>(blob), static_cast<std::size_t>(size));
}

}  // namespace lodemark
