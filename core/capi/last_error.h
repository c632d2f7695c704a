// Statuses of the C interface and the sentence that goes with the latest error of a thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/result.h"
#include "lodemark/lodemark.h"

namespace lodemark {

// An argument, or an element of an array argument.
struct Where {
  const char* name = "";
  std::int32_t index = -1;  // below 0: not an element
};

// Keeps the sentence, formatted as printf does, cut at 511 bytes, and returns status. Allocates
// nothing.
[[gnu::format(printf, 2, 3)]] lodemark_status Fail(lodemark_status status, const char* format, ...);

// "measurements[3].cn0_dbhz is not finite"; field may be "" for the element as a whole.
lodemark_status FailAt(lodemark_status status, Where where, const char* field, const char* reason);

// Keeps the error's message and returns its status.
lodemark_status Fail(const Error& error);

// LODEMARK_OK, or what Fail makes of the error.
lodemark_status StatusOf(const Status& done);

// Copies text into a zero-terminated field of capacity bytes, cut between two UTF-8 characters.
void CopyText(const char* text, std::size_t length, char* out, std::size_t capacity);

}  // namespace lodemark
