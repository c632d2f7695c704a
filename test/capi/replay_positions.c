/*
 * The positions of a log in full precision, for comparing processors: one line an epoch with the
 * outcome and, where there is a position, x, y, z (ECEF) and the horizontal accuracy in metres.
 *
 *   replay_positions gnss_log.txt navigation.rnx
 *
 * The log is replayed three times: each epoch for itself, filtered, and smoothed.
 */
#include <stdio.h>
#include <string.h>

#include "lodemark/lodemark.h"

#define MOST_EPOCHS 4096

static char navigation[8 << 20];
static lodemark_estimate smoothed[MOST_EPOCHS];

static int Fail(const char* step) {
  fprintf(stderr, "%s: %s\n", step, lodemark_last_error());
  return 1;
}

static void Print(const char* estimator, const lodemark_estimate* estimate) {
  printf("%s %d", estimator, (int)estimate->outcome);
  if ((estimate->present & LODEMARK_ESTIMATE_HAS_POSITION) != 0) {
    printf(" %.9f %.9f %.9f %.9f", estimate->ecef_m[0], estimate->ecef_m[1], estimate->ecef_m[2],
           estimate->accuracy_m);
  }
  printf("\n");
}

static int Replay(const char* path, size_t size, int32_t estimator) {
  lodemark_session_options options;
  lodemark_session* session = NULL;
  lodemark_log* log = NULL;
  lodemark_status pushed;
  lodemark_estimate estimate;
  int32_t count = 0;
  int32_t i;
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.estimator = estimator;
  if (lodemark_session_open(&options, &session) != LODEMARK_OK) return Fail("session");
  if (lodemark_session_push_navigation(session, "navigation", navigation, size, NULL) < 0) {
    return Fail("navigation");
  }
  if (lodemark_log_open(path, &log) != LODEMARK_OK) return Fail("log");
  while ((pushed = lodemark_log_push_next(log, session)) == LODEMARK_OK) {
    memset(&estimate, 0, sizeof estimate);
    estimate.struct_size = sizeof estimate;
    if (lodemark_session_process(session) < 0) return Fail("process");
    if (lodemark_session_estimate(session, &estimate) < 0) return Fail("estimate");
    Print(estimator == LODEMARK_ESTIMATOR_EPOCH ? "epoch" : "filter", &estimate);
  }
  if (pushed != LODEMARK_END_OF_LOG) return Fail("push");
  smoothed[0].struct_size = sizeof smoothed[0];
  if (lodemark_session_smoothed(session, smoothed, MOST_EPOCHS, &count) < 0) return Fail("smooth");
  for (i = 0; i < count && i < MOST_EPOCHS; ++i) Print("smoothed", &smoothed[i]);
  lodemark_log_close(log);
  lodemark_session_close(session);
  return 0;
}

int main(int argc, char** argv) {
  FILE* file;
  size_t size;
  if (argc != 3) return 2;
  file = fopen(argv[2], "rb");
  if (file == NULL) return 1;
  size = fread(navigation, 1, sizeof navigation, file);
  fclose(file);
  if (Replay(argv[1], size, LODEMARK_ESTIMATOR_EPOCH) != 0) return 1;
  return Replay(argv[1], size, LODEMARK_ESTIMATOR_SMOOTHER);
}
