#include "core/map/sqlite_connection.h"

#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace lodemark {
namespace {

constexpr int kBusyTimeout_ms = 5'000;
constexpr int kStepsBetweenCalls = 10'000;
constexpr std::int64_t kStepsForAnyFile = 20'000'000;
constexpr int kLargestValue_bytes = 64 << 20;  // the largest are quantisers

// What may be in SQLite's hands, far above what our own statements need.
constexpr std::pair<int, int> kLimits[] = {
    {SQLITE_LIMIT_LENGTH, kLargestValue_bytes},
    {SQLITE_LIMIT_SQL_LENGTH, 10'000},
    {SQLITE_LIMIT_COLUMN, 64},
    {SQLITE_LIMIT_EXPR_DEPTH, 30},
    {SQLITE_LIMIT_COMPOUND_SELECT, 4},
    {SQLITE_LIMIT_VDBE_OP, 25'000},
    {SQLITE_LIMIT_FUNCTION_ARG, 8},
    {SQLITE_LIMIT_ATTACHED, 0},
    {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 50},
    {SQLITE_LIMIT_VARIABLE_NUMBER, 32},
    {SQLITE_LIMIT_TRIGGER_DEPTH, 1},
    {SQLITE_LIMIT_WORKER_THREADS, 0},
};

int StopWhenSpent(void* steps_left) {
  std::int64_t& left = *static_cast<std::int64_t*>(steps_left);
  left -= kStepsBetweenCalls;
  return left < 0 ? 1 : 0;
}

// SQLite on Debian takes names that begin with "file:" or ":" for more than names.
std::string PlainPath(const std::string& path) { return path.front() == '/' ? path : "./" + path; }

// Why the path is no file to hand to SQLite.
std::optional<Error> NoFile(const std::string& path) {
  if (path.empty()) return Error{ErrorCode::kInvalidArgument, "the map's path is empty"};
  if (path.find('\0') != std::string::npos) {
    return Error{ErrorCode::kInvalidArgument, "the map's path has a zero byte in it"};
  }
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  switch (status.type()) {
    case std::filesystem::file_type::regular:
      return std::nullopt;
    case std::filesystem::file_type::not_found:
      return Error{ErrorCode::kIo, path + ": no such file"};
    case std::filesystem::file_type::directory:
      return Error{ErrorCode::kIo, path + ": is a folder; a feature map is one file"};
    case std::filesystem::file_type::none:
      return Error{ErrorCode::kIo, path + ": cannot be looked at: " + failure.message()};
    default:
      return Error{ErrorCode::kIo, path + ": is a device or a pipe; a feature map is a file"};
  }
}

}  // namespace

SqliteConnection::SqliteConnection(std::string name, Mode mode)
    : name_(std::move(name)), mode_(mode) {
  AllowWork(0);
}

SqliteConnection::~SqliteConnection() { sqlite3_close_v2(handle_); }

Result<std::unique_ptr<SqliteConnection>> SqliteConnection::Open(const std::string& path,
                                                                 Mode mode) {
  if (std::optional<Error> none = NoFile(path)) return *std::move(none);
  std::unique_ptr<SqliteConnection> connection(new SqliteConnection(path, mode));
  const int flags = (mode == Mode::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE) |
                    SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  const int code = sqlite3_open_v2(PlainPath(path).c_str(), &connection->handle_, flags, nullptr);
  if (code != SQLITE_OK) return connection->Explain(code);
  if (mode == Mode::kWrite && sqlite3_db_readonly(connection->handle_, "main") != 0) {
    return connection->MakeError(ErrorCode::kIo, "cannot be written; check its permissions");
  }
  if (Status status = connection->Harden(); !status) return status.error();
  return connection;
}

Result<std::unique_ptr<SqliteConnection>> SqliteConnection::OpenBytes(
    std::string name, std::vector<std::uint8_t> bytes) {
  std::unique_ptr<SqliteConnection> connection(new SqliteConnection(std::move(name), Mode::kRead));
  if (bytes.empty()) return connection->MakeError(ErrorCode::kBadData, "is empty");
  connection->bytes_ = std::move(bytes);
  int code = sqlite3_open_v2(
      ":memory:", &connection->handle_,
      SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
      nullptr);
  if (code == SQLITE_OK) {
    const auto size = static_cast<sqlite3_int64>(connection->bytes_.size());
    code = sqlite3_deserialize(connection->handle_, "main", connection->bytes_.data(), size, size,
                               SQLITE_DESERIALIZE_READONLY);
  }
  if (code != SQLITE_OK) return connection->Explain(code);
  if (Status status = connection->Harden(); !status) return status.error();
  return connection;
}

Status SqliteConnection::Harden() {
  const std::pair<int, int> switches[] = {
      {SQLITE_DBCONFIG_DEFENSIVE, 1},      {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
      {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0}, {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
      {SQLITE_DBCONFIG_DQS_DML, 0},        {SQLITE_DBCONFIG_DQS_DDL, 0},
      {SQLITE_DBCONFIG_ENABLE_FKEY, 0},    {SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
  };
  for (const auto& [what, on] : switches) {
    const int code = sqlite3_db_config(handle_, what, on, nullptr);
    if (code != SQLITE_OK) return Explain(code);
  }
  for (const auto& [what, most] : kLimits) sqlite3_limit(handle_, what, most);
  WaitForOthers(true);
  if (mode_ == Mode::kWrite) return Execute("PRAGMA cell_size_check = ON");
  sqlite3_progress_handler(handle_, kStepsBetweenCalls, StopWhenSpent, &steps_left_);
  // SQLite maps what the file has, at most 2^31 - 2^16 bytes; the rest it reads page by page.
  return Execute(
      "PRAGMA cell_size_check = ON; PRAGMA query_only = ON; PRAGMA mmap_size = 2147418112");
}

Status SqliteConnection::Execute(const char* sql) {
  const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return Explain(code);
  return {};
}

void SqliteConnection::WaitForOthers(bool wait) {
  sqlite3_busy_timeout(handle_, wait ? kBusyTimeout_ms : 0);
}

bool SqliteConnection::InTransaction() const { return sqlite3_get_autocommit(handle_) == 0; }

sqlite3_file* SqliteConnection::File() const {
  sqlite3_file* file = nullptr;
  sqlite3_file_control(handle_, "main", SQLITE_FCNTL_FILE_POINTER, &file);
  return file != nullptr && file->pMethods != nullptr ? file : nullptr;
}

SqliteConnection::RawFile SqliteConnection::ReadRaw(std::span<std::uint8_t> start) const {
  RawFile raw;
  std::fill(start.begin(), start.end(), std::uint8_t{0});
  sqlite3_file* file = File();
  if (file == nullptr) return raw;
  sqlite3_int64 size = 0;
  if (file->pMethods->xFileSize(file, &size) != SQLITE_OK) return raw;
  raw.size_bytes = size;
  const auto wanted = static_cast<int>(std::min(size, static_cast<sqlite3_int64>(start.size())));
  raw.read = file->pMethods->xRead(file, start.data(), wanted, 0) == SQLITE_OK;
  return raw;
}

void SqliteConnection::AllowWork(std::int64_t file_size_bytes) {
  steps_left_ = kStepsForAnyFile + 4 * file_size_bytes;
}

// SQLite calls a file damaged, too, that the device refuses to read.
int SqliteConnection::ReadError() const {
  int system = 0;
  if (handle_ == nullptr) return 0;
  sqlite3_file_control(handle_, "main", SQLITE_FCNTL_LAST_ERRNO, &system);
  return system == EIO || system == ENXIO ? system : 0;
}

Error SqliteConnection::MakeError(ErrorCode code, std::string_view sentence) const {
  std::string message = name_;
  message.append(": ").append(sentence);
  return Error{code, std::move(message)};
}

Error SqliteConnection::Explain(int code) const {
  switch (code) {
    case SQLITE_READONLY_ROLLBACK:
    case SQLITE_READONLY_RECOVERY:
      return MakeError(ErrorCode::kIo,
                       "a change of it was cut short; open it once for writing to undo that");
    default:
      break;
  }
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return MakeError(ErrorCode::kBadData, "is not a feature map: not an SQLite file");
    case SQLITE_CORRUPT:
      if (const int system = ReadError(); system != 0) {
        return MakeError(ErrorCode::kIo,
                         "cannot be read: " + std::generic_category().message(system));
      }
      [[fallthrough]];
    case SQLITE_FORMAT:
      return MakeError(ErrorCode::kBadData, "is damaged; get it again from where it was made");
    case SQLITE_INTERRUPT:
      return MakeError(ErrorCode::kBadData, "is damaged: reading it would not end");
    case SQLITE_TOOBIG:
      return MakeError(ErrorCode::kBadData, "is damaged: a value is larger than any in a map");
    case SQLITE_FULL:
      return MakeError(ErrorCode::kIo, "the disk is full; the map is as it was before");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return MakeError(ErrorCode::kIo, "is in use by another; try again when that is done");
    case SQLITE_NOMEM:
      return MakeError(ErrorCode::kOutOfMemory, "there is not enough memory to use it");
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH: {
      const int system = handle_ == nullptr ? 0 : sqlite3_system_errno(handle_);
      return MakeError(
          ErrorCode::kIo,
          "cannot be opened" +
              (system == 0 ? std::string() : ": " + std::generic_category().message(system)));
    }
    case SQLITE_READONLY:
      return MakeError(ErrorCode::kIo, "cannot be written; check its permissions");
    case SQLITE_IOERR:
      return MakeError(ErrorCode::kIo, std::string("cannot be read or written: ") +
                                           (handle_ == nullptr ? "input or output error"
                                                               : sqlite3_errmsg(handle_)));
    default:
      return MakeError(mode_ == Mode::kRead ? ErrorCode::kBadData : ErrorCode::kInternal,
                       std::string("cannot be used: ") +
                           (handle_ == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(handle_)));
  }
}

}  // namespace lodemark
