/*
 * Where a photograph was taken.
 *
 *   photo_position scene.map wall.pgm
 *
 * The photograph is straightened, looked up in the map, and resected from what was found. One call,
 * lodemark_map_locate, does the last two, and better: this shows the steps.
 */
#include <stdio.h>
#include <string.h>

#include "lodemark/lodemark.h"

#define WIDTH 640
#define HEIGHT 480
#define MOST_SIGHTS 4000

static uint8_t photo[WIDTH * HEIGHT];
static uint8_t straight[WIDTH * HEIGHT];
static lodemark_sight sights[MOST_SIGHTS];

static int fail(const char* step) {
  fprintf(stderr, "%s: %s\n", step, lodemark_last_error());
  return 1;
}

/* Grey, binary, of the camera's size, and without comments. */
static int read_pgm(const char* path) {
  int width = 0, height = 0, white = 0;
  size_t size = 0;
  FILE* file = fopen(path, "rb");
  if (file == NULL) {
    fprintf(stderr, "cannot open %s\n", path);
    return 1;
  }
  if (fscanf(file, "P5 %d %d %d", &width, &height, &white) == 3 && width == WIDTH &&
      height == HEIGHT && white == 255 && fgetc(file) != EOF) {
    size = fread(photo, 1, sizeof photo, file);
  }
  fclose(file);
  if (size == sizeof photo) return 0;
  fprintf(stderr, "%s is no grey picture of %d x %d pixels\n", path, WIDTH, HEIGHT);
  return 1;
}

/* As lodemark calibrate measured it. */
static lodemark_lens camera(void) {
  lodemark_lens lens;
  memset(&lens, 0, sizeof lens);
  lens.struct_size = sizeof lens;
  lens.model = LODEMARK_LENS_BROWN;
  lens.width_px = WIDTH;
  lens.height_px = HEIGHT;
  lens.fx_px = lens.fy_px = 520.0;
  lens.cx_px = 319.5;
  lens.cy_px = 239.5;
  lens.coefficients[0] = 0.08;  /* k1 */
  lens.coefficients[1] = -0.05; /* k2 */
  return lens;
}

/* Fills straight, and lens with one that takes such photographs. */
static int straighten(lodemark_lens* lens) {
  const lodemark_lens bent = camera();
  lodemark_undistortion* undistortion = NULL;
  int bad = 0;
  memset(lens, 0, sizeof *lens);
  lens->struct_size = sizeof *lens;
  if (lodemark_undistortion_open(&bent, NULL, lens, &undistortion) < 0) return fail("lens");
  if (lodemark_undistortion_apply(undistortion, photo, WIDTH, straight, WIDTH) < 0) {
    bad = fail("photograph");
  }
  lodemark_undistortion_close(undistortion);
  return bad;
}

static int locate(lodemark_map* map, const lodemark_lens* lens) {
  lodemark_pose pose;
  lodemark_status status;
  int32_t count = 0;

  memset(sights, 0, sizeof sights);
  sights[0].struct_size = sizeof sights[0];
  if (lodemark_map_query(map, lens, straight, WIDTH, NULL, NULL, sights, MOST_SIGHTS, &count) < 0) {
    return fail("query");
  }
  if (count > MOST_SIGHTS) count = MOST_SIGHTS;
  memset(&pose, 0, sizeof pose);
  pose.struct_size = sizeof pose;
  status = lodemark_pose_resect(lens, sights, count, NULL, NULL, &pose, NULL, NULL);
  if (status < 0) return fail("resect");
  if (status == LODEMARK_NO_POSITION) {
    printf("no position: verdict %d\n", (int)pose.verdict);
    return 1;
  }
  printf("latitude %.5f longitude %.5f height %.1f m\n", pose.latitude_deg, pose.longitude_deg,
         pose.height_m);
  printf("within %.3f m, height within %.3f m (68 %%), from %d of %d sights\n", pose.accuracy_m,
         pose.vertical_accuracy_m, (int)pose.inliers, (int)count);
  return 0;
}

int main(int argc, char** argv) {
  lodemark_map* map = NULL;
  lodemark_lens lens;
  int bad;

  if (argc != 3) {
    fprintf(stderr, "usage: photo_position MAP PHOTOGRAPH\n");
    return 1;
  }
  if (read_pgm(argv[2]) != 0) return 1;
  if (lodemark_map_open(argv[1], &map) < 0) return fail("map");
  bad = straighten(&lens) != 0 || locate(map, &lens) != 0;
  lodemark_map_close(map);
  return bad;
}
