// A connection to one SQLite file whose content nobody vouches for.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

struct sqlite3;
struct sqlite3_file;

namespace lodemark {

// One thread at a time. SQLite runs with everything off that a file could misuse: triggers, views,
// functions in the schema, extensions, long statements, endless b-trees.
class SqliteConnection {
 public:
  enum class Mode : std::uint8_t {
    kRead,
    kWrite,  // an existing file, which may be empty
  };

  static Result<std::unique_ptr<SqliteConnection>> Open(const std::string& path, Mode mode);

  // Reads a file that lies in memory; errors call it by the name.
  static Result<std::unique_ptr<SqliteConnection>> OpenBytes(std::string name,
                                                             std::vector<std::uint8_t> bytes);

  ~SqliteConnection();
  SqliteConnection(const SqliteConnection&) = delete;
  SqliteConnection& operator=(const SqliteConnection&) = delete;

  const std::string& name() const { return name_; }
  sqlite3* handle() const { return handle_; }

  // Statements without parameters and without answers.
  Status Execute(const char* sql);

  // Whether a lock that is taken is worth waiting for, a few seconds at most. It is at first.
  void WaitForOthers(bool wait);

  bool InTransaction() const;

  // The file's length, and its first bytes up to the length of the buffer (zero beyond its end),
  // past SQLite's own reading. Only under a lock are they of one moment.
  struct RawFile {
    std::int64_t size_bytes = 0;
    bool read = false;
  };
  RawFile ReadRaw(std::span<std::uint8_t> start) const;

  // A file crafted so that reading it would not end is given up after steps in proportion to its
  // size; this starts the count again.
  void AllowWork(std::int64_t file_size_bytes);

  // What a code SQLite gave means for who reads it. Uses SQLite's last message.
  Error Explain(int code) const;
  Error MakeError(ErrorCode code, std::string_view sentence) const;

 private:
  SqliteConnection(std::string name, Mode mode);
  Status Harden();
  int ReadError() const;  // errno, 0 if there was none
  sqlite3_file* File() const;

  std::string name_;
  Mode mode_;
  std::vector<std::uint8_t> bytes_;
  sqlite3* handle_ = nullptr;
  std::int64_t steps_left_ = 0;
};

}  // namespace lodemark
