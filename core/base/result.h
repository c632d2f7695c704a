// Success with a value, or an error that names the thing that failed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace lodemark {

// Whose move it is. The C interface passes these on as its negative statuses.
enum class ErrorCode : std::uint8_t {
  kInvalidArgument,  // the caller's: a value or a call that makes no sense
  kUnsupported,      // the caller's: a sound request this version cannot serve
  kOutOfOrder,       // the caller's: called too early, or time ran backwards
  kQueueFull,        // the caller's: call process before pushing more
  kIo,               // the system's: a file that cannot be opened, read or written
  kBadData,          // the file's: malformed content
  kOutOfMemory,      // the system's
  kInternal,         // ours
};

struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;  // names the file, record and field, and what to do
};

// A value of type T, or the Error that kept it from being made.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT: implicit on purpose
  Result(Error error) : content_(std::move(error)) {}  // NOLINT: implicit on purpose

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  // Only if ok().
  const T& value() const& { return *std::get_if<T>(&content_); }
  T& value() & { return *std::get_if<T>(&content_); }
  T&& value() && { return std::move(*std::get_if<T>(&content_)); }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T* operator->() const { return std::get_if<T>(&content_); }
  T* operator->() { return std::get_if<T>(&content_); }

  // Only if not ok().
  const Error& error() const { return *std::get_if<Error>(&content_); }

 private:
  std::variant<T, Error> content_;
};

// Success without a value.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT: implicit on purpose

  bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

using Status = Result<void>;

}  // namespace lodemark
