// That lodemark.h is C++98 on its own.
#include "lodemark/lodemark.h"

extern "C" int header_in_cxx(void);
extern "C" int header_in_cxx(void) {
  lodemark_gnss_clock clock = lodemark_gnss_clock();
  clock.present = LODEMARK_CLOCK_HAS_BIAS | LODEMARK_CLOCK_HAS_FULL_BIAS;
  const lodemark_status status = LODEMARK_ERROR_INTERNAL;
  return clock.present == 0xcu && status < LODEMARK_OK;
}
