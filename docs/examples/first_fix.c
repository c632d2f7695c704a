/*
 * A fix from one epoch of raw GNSS measurements.
 *
 *   first_fix first_fix.rnx
 *
 * The orbits come from a RINEX navigation file. The measurements, which an app would copy from a
 * GnssMeasurementsEvent, are simulated here: no atmosphere, no noise.
 */
#include <stdio.h>
#include <string.h>

#include "lodemark/lodemark.h"

/* What android.location.GnssMeasurement said about each GPS satellite. */
struct received {
  int32_t svid;
  int64_t received_sv_time_ns;
  double time_offset_ns;
  double pseudorange_rate_mps;
};
static const struct received kReceived[] = {
    {2, 302999920235427, 0.499, -400.373}, {3, 302999921679493, 0.454, 658.096},
    {6, 302999931899385, 0.621, -164.564}, {9, 302999923248862, 0.769, -538.227},
    {10, 302999926202563, 0.971, 478.888}, {13, 302999931960432, 0.807, -78.684},
    {17, 302999921365961, 0.539, 102.413},
};
#define COUNT ((int32_t)(sizeof kReceived / sizeof kReceived[0]))

static int fail(const char* step) {
  fprintf(stderr, "%s: %s\n", step, lodemark_last_error());
  return 1;
}

static int push_navigation(lodemark_session* session, const char* path) {
  static char text[65536];
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

static int push_epoch(lodemark_session* session) {
  lodemark_gnss_clock clock;
  lodemark_gnss_measurement measurements[COUNT];
  int32_t i;

  memset(&clock, 0, sizeof clock);
  clock.struct_size = sizeof clock;
  clock.time_ns = 605000000000;
  clock.full_bias_ns = -1402228795000000000;
  clock.present = LODEMARK_CLOCK_HAS_FULL_BIAS | LODEMARK_CLOCK_HAS_BIAS;

  memset(measurements, 0, sizeof measurements);
  for (i = 0; i < COUNT; ++i) {
    lodemark_gnss_measurement* m = &measurements[i];
    m->struct_size = sizeof *m;
    m->svid = kReceived[i].svid;
    m->constellation_type = 1; /* GnssStatus.CONSTELLATION_GPS */
    m->state = 1 | 2 | 4 | 8;  /* code lock ... time of week decoded */
    m->received_sv_time_ns = kReceived[i].received_sv_time_ns;
    m->received_sv_time_uncertainty_ns = 10;
    m->time_offset_ns = kReceived[i].time_offset_ns;
    m->pseudorange_rate_mps = kReceived[i].pseudorange_rate_mps;
    m->pseudorange_rate_uncertainty_mps = 0.05;
    m->cn0_dbhz = 45.0;
    m->present = LODEMARK_MEASUREMENT_HAS_RECEIVED_TIME_UNCERTAINTY |
                 LODEMARK_MEASUREMENT_HAS_RANGE_RATE |
                 LODEMARK_MEASUREMENT_HAS_RANGE_RATE_UNCERTAINTY | LODEMARK_MEASUREMENT_HAS_CN0;
  }
  /* The session counts in GPS time, which the clock tells: the second argument is not needed. */
  if (lodemark_session_push_gnss(session, 0, &clock, measurements, COUNT) < 0) {
    return fail("epoch");
  }
  return 0;
}

static int print_estimate(lodemark_session* session) {
  lodemark_estimate estimate;
  lodemark_satellite satellites[32];
  int32_t count = 0;
  int32_t i;

  memset(&estimate, 0, sizeof estimate);
  estimate.struct_size = sizeof estimate;
  if (lodemark_session_estimate(session, &estimate) != LODEMARK_OK) {
    printf("no position: outcome %d\n", (int)estimate.outcome);
    return 1;
  }
  printf("latitude %.5f longitude %.5f height %.0f m\n", estimate.latitude_deg,
         estimate.longitude_deg, estimate.height_m);
  printf("within %.1f m (68 %%), from %d satellites\n", estimate.accuracy_m,
         (int)estimate.satellites_used);

  memset(satellites, 0, sizeof satellites);
  satellites[0].struct_size = sizeof satellites[0];
  if (lodemark_session_satellites(session, satellites, 32, &count) < 0) return fail("satellites");
  for (i = 0; i < count && i < 32; ++i) {
    printf("G%02d elevation %2.0f residual %+.2f m\n", (int)satellites[i].satellite,
           satellites[i].elevation_deg, satellites[i].residual_m);
  }
  return 0;
}

int main(int argc, char** argv) {
  lodemark_session_options options;
  lodemark_session* session = NULL;
  int bad = 1;

  if (argc != 2) {
    fprintf(stderr, "usage: first_fix NAVIGATION_FILE\n");
    return 1;
  }
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.ionosphere = LODEMARK_IONOSPHERE_NONE; /* the simulation has no atmosphere */
  options.troposphere = LODEMARK_TROPOSPHERE_NONE;
  if (lodemark_session_open(&options, &session) < 0) return fail("open");

  if (push_navigation(session, argv[1]) == 0 && push_epoch(session) == 0) {
    const lodemark_status status = lodemark_session_process(session);
    bad = status < 0 ? fail("process") : print_estimate(session);
  }
  lodemark_session_close(session);
  return bad;
}
