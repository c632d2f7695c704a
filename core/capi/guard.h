// The last net: no exception leaves the library.
#pragma once

#include <exception>
#include <new>

#include "core/capi/last_error.h"

namespace lodemark {

// The status that call returns, or the one that tells what it threw.
template <typename Call>
lodemark_status Guard(const Call& call) noexcept {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return Fail(LODEMARK_ERROR_OUT_OF_MEMORY, "memory ran out");
  } catch (const std::exception& exception) {
    return Fail(LODEMARK_ERROR_INTERNAL, "a bug in Lodemark: %s", exception.what());
  } catch (...) {
    return Fail(LODEMARK_ERROR_INTERNAL, "a bug in Lodemark: an exception of unknown type");
  }
}

}  // namespace lodemark
