#include "lodemark/lodemark.h"

namespace {

#define LODEMARK_QUOTED_(value) #value
#define LODEMARK_QUOTED(value) LODEMARK_QUOTED_(value)
constexpr char kVersion[] = LODEMARK_QUOTED(LODEMARK_VERSION_MAJOR) "." LODEMARK_QUOTED(
    LODEMARK_VERSION_MINOR) "." LODEMARK_QUOTED(LODEMARK_VERSION_PATCH);

}  // namespace

const char* lodemark_version(void) { return kVersion; }

const char* lodemark_status_name(lodemark_status status) {
  switch (status) {
    case LODEMARK_OK:
      return "OK";
    case LODEMARK_NOTHING_QUEUED:
      return "NOTHING_QUEUED";
    case LODEMARK_NO_POSITION:
      return "NO_POSITION";
    case LODEMARK_END_OF_LOG:
      return "END_OF_LOG";
    case LODEMARK_ERROR_INVALID_ARGUMENT:
      return "INVALID_ARGUMENT";
    case LODEMARK_ERROR_UNSUPPORTED:
      return "UNSUPPORTED";
    case LODEMARK_ERROR_OUT_OF_ORDER:
      return "OUT_OF_ORDER";
    case LODEMARK_ERROR_QUEUE_FULL:
      return "QUEUE_FULL";
    case LODEMARK_ERROR_IO:
      return "IO";
    case LODEMARK_ERROR_BAD_DATA:
      return "BAD_DATA";
    case LODEMARK_ERROR_OUT_OF_MEMORY:
      return "OUT_OF_MEMORY";
    case LODEMARK_ERROR_INTERNAL:
      return "INTERNAL";
    default:
      return "UNKNOWN";
  }
}
