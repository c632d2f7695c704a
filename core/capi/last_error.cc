#include "core/capi/last_error.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace lodemark {
namespace {

// A fixed buffer: an error must be sayable when memory has run out.
constexpr std::size_t kLongestError = 512;
thread_local char last_error[kLongestError] = "";

lodemark_status StatusOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return LODEMARK_ERROR_INVALID_ARGUMENT;
    case ErrorCode::kUnsupported:
      return LODEMARK_ERROR_UNSUPPORTED;
    case ErrorCode::kOutOfOrder:
      return LODEMARK_ERROR_OUT_OF_ORDER;
    case ErrorCode::kQueueFull:
      return LODEMARK_ERROR_QUEUE_FULL;
    case ErrorCode::kIo:
      return LODEMARK_ERROR_IO;
    case ErrorCode::kBadData:
      return LODEMARK_ERROR_BAD_DATA;
    case ErrorCode::kOutOfMemory:
      return LODEMARK_ERROR_OUT_OF_MEMORY;
    default:
      return LODEMARK_ERROR_INTERNAL;
  }
}

}  // namespace

lodemark_status Fail(lodemark_status status, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  char text[kLongestError] = "";  // an argument may be the latest error itself
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  CopyText(text, std::strlen(text), last_error, sizeof last_error);
  return status;
}

lodemark_status FailAt(lodemark_status status, Where where, const char* field, const char* reason) {
  const char* dot = *field == '\0' ? "" : ".";
  if (where.index < 0) return Fail(status, "%s%s%s %s", where.name, dot, field, reason);
  return Fail(status, "%s[%d]%s%s %s", where.name, static_cast<int>(where.index), dot, field,
              reason);
}

lodemark_status Fail(const Error& error) {
  CopyText(error.message.data(), error.message.size(), last_error, sizeof last_error);
  return StatusOf(error.code);
}

lodemark_status StatusOf(const Status& done) { return done ? LODEMARK_OK : Fail(done.error()); }

void CopyText(const char* text, std::size_t length, char* out, std::size_t capacity) {
  std::size_t kept = std::min(length, capacity - 1);
  if (kept < length) {
    const auto continues = [&](std::size_t i) {
      return (static_cast<unsigned char>(text[i]) & 0xc0u) == 0x80u;
    };
    while (kept > 0 && continues(kept)) --kept;
  }
  std::memcpy(out, text, kept);
  std::memset(out + kept, 0, capacity - kept);
}

}  // namespace lodemark

const char* lodemark_last_error(void) { return lodemark::last_error; }
