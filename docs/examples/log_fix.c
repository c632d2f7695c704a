/*
 * A fix from a recorded log, at each of its epochs.
 *
 *   log_fix gnss_log.txt navigation.rnx
 *
 * The log is what the GnssLogger app writes; the orbits are a RINEX navigation file of its day.
 */
#include <stdio.h>
#include <string.h>

#include "lodemark/lodemark.h"

static int fail(const char* step) {
  fprintf(stderr, "%s: %s\n", step, lodemark_last_error());
  return 1;
}

static int push_navigation(lodemark_session* session, const char* path) {
  static char text[8 << 20];
  size_t size;
  FILE* file = fopen(path, "rb");
  if (file == NULL) {
    fprintf(stderr, "cannot open %s\n", path);
    return 1;
  }
  size = fread(text, 1, sizeof text, file);
  fclose(file);
  if (lodemark_session_push_navigation(session, path, text, size, NULL) < 0) {
    return fail("navigation");
  }
  return 0;
}

static void print_estimate(const lodemark_estimate* estimate) {
  if ((estimate->present & LODEMARK_ESTIMATE_HAS_POSITION) == 0) {
    printf("no position: outcome %d\n", (int)estimate->outcome);
    return;
  }
  printf("%.10f %.10f %.4f within %.1f m, from %d satellites\n", estimate->latitude_deg,
         estimate->longitude_deg, estimate->height_m, estimate->accuracy_m,
         (int)estimate->satellites_used);
}

static int replay(lodemark_log* log, lodemark_session* session) {
  lodemark_status pushed;
  while ((pushed = lodemark_log_push_next(log, session)) != LODEMARK_END_OF_LOG) {
    lodemark_estimate estimate;
    if (pushed < 0) return fail("log");
    if (lodemark_session_process(session) < 0) return fail("process");
    memset(&estimate, 0, sizeof estimate);
    estimate.struct_size = sizeof estimate;
    if (lodemark_session_estimate(session, &estimate) < 0) return fail("estimate");
    print_estimate(&estimate);
  }
  return 0;
}

int main(int argc, char** argv) {
  lodemark_log* log = NULL;
  lodemark_session* session = NULL;
  int bad;

  if (argc != 3) {
    fprintf(stderr, "usage: log_fix GNSS_LOG NAVIGATION_FILE\n");
    return 1;
  }
  if (lodemark_log_open(argv[1], &log) < 0) return fail("open");
  if (lodemark_session_open(NULL, &session) < 0) return fail("session");
  bad = push_navigation(session, argv[2]) != 0 || replay(log, session) != 0;
  lodemark_session_close(session);
  lodemark_log_close(log);
  return bad;
}
