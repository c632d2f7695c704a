/* That lodemark.h is C99 on its own: this file includes nothing before it. */
#include "lodemark/lodemark.h"

/* Every initialiser that the header's documentation suggests is legal C99. */
int header_in_c(void);
int header_in_c(void) {
  lodemark_session_options options = {.struct_size = sizeof(lodemark_session_options)};
  const uint32_t bits = LODEMARK_CLOCK_HAS_BIAS | LODEMARK_CLOCK_HAS_FULL_BIAS;
  const lodemark_status status = LODEMARK_ERROR_INTERNAL;
  options.systems = UINT32_C(1) << LODEMARK_SYSTEM_GALILEO;
  return options.systems == 4 && bits == 0xcu && status < LODEMARK_OK;
}
