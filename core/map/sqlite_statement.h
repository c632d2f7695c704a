// One prepared statement of SQLite, with its parameters and its rows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/result.h"
#include "core/map/sqlite_connection.h"

struct sqlite3_stmt;

namespace lodemark {

// A statement that could not be prepared behaves like one whose first step failed, so that one look
// at status() after the rows is enough. Does not outlive its connection.
class SqliteStatement {
 public:
  SqliteStatement(SqliteConnection* connection, const char* sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  // Parameters count from one. Text and blobs must live until the statement is reset.
  void Bind(int parameter, std::int64_t value);
  void Bind(int parameter, double value);
  void Bind(int parameter, std::string_view text);
  void Bind(int parameter, std::span<const std::uint8_t> blob);

  // True: a row is there. False: no more, or failed; status() says which.
  bool Step();
  Status status() const;
  int code() const { return code_; }

  // Ready for other parameters; gives the file's lock back.
  void Reset();

  // All steps of a statement that gives no rows, then Reset.
  Status Run();

  // Columns count from zero. Empty if the value is of another type. Text and blobs are valid until
  // the next step.
  std::optional<std::int64_t> Integer(int column) const;
  std::optional<double> Real(int column) const;
  std::optional<std::string_view> Text(int column) const;
  std::optional<std::span<const std::uint8_t>> Blob(int column) const;

 private:
  void Keep(int code);

  SqliteConnection* connection_;
  sqlite3_stmt* statement_ = nullptr;
  int code_ = 0;
};

}  // namespace lodemark
