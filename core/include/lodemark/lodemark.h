/*
 * Lodemark: where a phone is, from satellites and, in one adjustment with them, known landmarks.
 *
 * Conventions
 *
 * Coordinates  WGS 84, heights above the ellipsoid. "ecef" is earth-centred earth-fixed x, y, z;
 *              "enu" is east, north, up; "geodetic" is latitude, longitude in degrees and height in
 *              metres, in that order.
 * Units        A name ends in its unit: _deg, _m, _mps (metres per second), _ns, _hz, _dbhz.
 * Accuracy     _sigma_m is one standard deviation. _accuracy_m is the distance that holds the
 *              truth 68 % of the time. A covariance is a full 3 x 3 matrix by rows.
 * Time         int64_t nanoseconds. GPS time counts from 1980-01-06 00:00:00 GPS without leap
 *              seconds. A session has one time base of its own, see lodemark_session_options.
 * Status       Each function that can fail returns a lodemark_status: 0 is good, a positive value
 *              is good news without an answer, a negative value is an error whose name says whose
 *              move it is. After an error nothing was changed, unless the function says otherwise,
 *              and lodemark_last_error() says what was wrong.
 * Structs      Each begins with struct_size: set it to sizeof the struct, in inputs and outputs
 *              alike, and zero the rest. Zero means the default, or nothing known. A shorter struct
 *              from an older header is accepted and its missing fields are zero; a longer one from
 *              a newer header is accepted while the part this library does not know is zero,
 *              otherwise the call gives LODEMARK_ERROR_UNSUPPORTED. Of an output, the part this
 *              library does not know is zeroed. Fields named reserved must be zero.
 * Arrays       All elements of an array have the same struct_size. Of an output array only the
 *              first element's must be set.
 * Lists        A list is fetched as (out, capacity, count): at most capacity elements are written
 *              to out, and *count is how many there are. With capacity 0, out may be NULL.
 * Presence     A field that has a bit in the struct's present word counts only if the bit is set.
 *              There is no NaN: a number that counts and is not finite gives
 *              LODEMARK_ERROR_INVALID_ARGUMENT, and so do NULL and nonsense.
 * Memory       The caller owns everything it passes in, and everything is copied. Handles are
 *              closed with their _close function, which ignores NULL.
 * Threads      A handle is used by one thread at a time; different handles, and the functions
 *              without a handle, by any number of threads. Nothing here starts a thread, reads a
 *              clock or calls back.
 * Stability    Names, values and layouts do not change within liblodemark.so.1. The layouts are
 *              the same for 32-bit and 64-bit programs.
 */
#ifndef LODEMARK_LODEMARK_H_
#define LODEMARK_LODEMARK_H_

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define LODEMARK_API __attribute__((visibility("default")))
#else
#define LODEMARK_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Version, status, error. */

#define LODEMARK_VERSION_MAJOR 0
#define LODEMARK_VERSION_MINOR 1
#define LODEMARK_VERSION_PATCH 0

/* "0.1.0" of the library that runs, which may be newer than this header. */
LODEMARK_API const char* lodemark_version(void);

typedef int32_t lodemark_status;

#define LODEMARK_OK 0
/* Good news without an answer. */
#define LODEMARK_NOTHING_QUEUED 1 /* process: no epoch is waiting */
#define LODEMARK_NO_POSITION 2    /* done, but what was given determines no trustworthy position */
#define LODEMARK_END_OF_LOG 3     /* nothing was pushed: there is no more */
/* The caller's move. */
#define LODEMARK_ERROR_INVALID_ARGUMENT (-1) /* a value or a call that makes no sense */
#define LODEMARK_ERROR_UNSUPPORTED (-2)      /* sound, but this version cannot serve it */
#define LODEMARK_ERROR_OUT_OF_ORDER (-3)     /* called too early, or time ran backwards */
#define LODEMARK_ERROR_QUEUE_FULL (-4)       /* process before pushing more */
/* The system's, the data's, ours. */
#define LODEMARK_ERROR_IO (-5)
#define LODEMARK_ERROR_BAD_DATA (-6) /* malformed content of a file or message */
#define LODEMARK_ERROR_OUT_OF_MEMORY (-7)
#define LODEMARK_ERROR_INTERNAL (-8) /* a bug in this library */

/* "INVALID_ARGUMENT", ... A static string; "UNKNOWN" for a value that is no status. */
LODEMARK_API const char* lodemark_status_name(lodemark_status status);

/*
 * One sentence on the latest error of this thread, naming the field, file or record; "" before the
 * first. The text stays until the next error on this thread.
 */
LODEMARK_API const char* lodemark_last_error(void);

/* Steps: usable alone, no session needed. */

/*
 * Geodetic coordinates to earth-centred earth-fixed ones, and back. Latitude within -90 .. 90,
 * longitude within -360 .. 360 (it comes back within -180 .. 180), lengths up to 1e9 m. Input and
 * output may be the same array.
 */
LODEMARK_API lodemark_status lodemark_ecef_from_geodetic(const double geodetic[3],
                                                         double ecef_m[3]);
LODEMARK_API lodemark_status lodemark_geodetic_from_ecef(const double ecef_m[3],
                                                         double geodetic[3]);

/*
 * A point in the local frame that has its origin at origin_geodetic and its axes east, north, up
 * there, and back. Input and output may be the same array.
 */
LODEMARK_API lodemark_status lodemark_enu_from_ecef(const double origin_geodetic[3],
                                                    const double ecef_m[3], double enu_m[3]);
LODEMARK_API lodemark_status lodemark_ecef_from_enu(const double origin_geodetic[3],
                                                    const double enu_m[3], double ecef_m[3]);

/*
 * UTC as Unix time (nanoseconds since 1970-01-01, days of 86,400 s) of a GPS time, and back, by the
 * table of leap seconds that were announced (18 s since 2017). Years 1980 to 2099. A time inside a
 * leap second counts with the seconds before it.
 */
LODEMARK_API lodemark_status lodemark_unix_from_gps(int64_t time_gps_ns, int64_t* time_unix_ns);
LODEMARK_API lodemark_status lodemark_gps_from_unix(int64_t time_unix_ns, int64_t* time_gps_ns);

/* Ranges that share a receiver clock error have the same group: 1 .. LODEMARK_CLOCK_GROUPS. */
#define LODEMARK_CLOCK_GROUP_NONE 0 /* measured without a clock: a landmark */
#define LODEMARK_CLOCK_GROUPS 16

/* Most elements that an array handed to this library may have. */
#define LODEMARK_LARGEST_COUNT 4096

/* The measured distance to a known point: a satellite or a landmark. */
typedef struct lodemark_range {
  uint32_t struct_size;
  int32_t clock_group;
  double point_in_ecef_m[3]; /* of a satellite: at transmission, in the axes of reception time */
  double range_m;            /* corrected for all but the receiver clock of its group */
  double sigma_m;            /* positive */
} lodemark_range;

/* Bits of lodemark_solve_options.present. */
#define LODEMARK_SOLVE_HAS_START 0x1u

/* All zero is a good choice. */
typedef struct lodemark_solve_options {
  uint32_t struct_size;
  uint32_t present;
  double start_in_ecef_m[3]; /* HAS_START: where to begin */
} lodemark_solve_options;

/* Why there is a position, or why not. */
#define LODEMARK_OUTCOME_NO_DATA 0 /* nothing was processed yet */
#define LODEMARK_OUTCOME_FIX 1
#define LODEMARK_OUTCOME_TOO_FEW 2      /* fewer usable measurements than unknowns */
#define LODEMARK_OUTCOME_NO_EPHEMERIS 3 /* measurements, but no orbit for enough of them */
#define LODEMARK_OUTCOME_NOT_CONVERGED 4
#define LODEMARK_OUTCOME_INCONSISTENT 5 /* no subset that is large enough agrees */
#define LODEMARK_OUTCOME_AMBIGUOUS 6    /* two places fit alike: a start would decide */

/* A position, valid if outcome is LODEMARK_OUTCOME_FIX; otherwise all other numbers are zero. */
typedef struct lodemark_solution {
  uint32_t struct_size;
  int32_t outcome;
  int32_t ranges_used;
  uint32_t clocks_present; /* bit g - 1: clock_m of group g was determined */
  double ecef_m[3];
  double latitude_deg;
  double longitude_deg;
  double height_m;
  double covariance_enu_m2[9];
  double accuracy_m;          /* horizontal */
  double vertical_accuracy_m; /* half-width */
  double pdop;                /* the dilutions weigh every range that was used alike */
  double hdop;
  double vdop;
  double tdop;                           /* of the first group determined; 0 if none */
  double clock_m[LODEMARK_CLOCK_GROUPS]; /* of group g in [g - 1], times the speed of light */
  double clock_sigma_m[LODEMARK_CLOCK_GROUPS];
} lodemark_solution;

/* How one range fared. */
typedef struct lodemark_range_residual {
  uint32_t struct_size;
  int32_t used;      /* 1 or 0 */
  double residual_m; /* measured minus computed */
  double weight;     /* share of its full weight that it kept, 0 .. 1 */
} lodemark_range_residual;

/*
 * Position from count ranges to known points, a clock per group included: three unknowns and one
 * more for each group. A group with a single range says nothing about the position, and that range
 * is not used. Ranges that contradict the others are found and not used either. Without a start,
 * landmarks are taken to be near and satellites to be seen from near the ground. options may be
 * NULL. residuals, unless NULL, has room for count elements, in the order of the ranges.
 *
 * LODEMARK_NO_POSITION if the ranges determine none; solution->outcome says why.
 */
LODEMARK_API lodemark_status lodemark_position_solve(const lodemark_range* ranges, int32_t count,
                                                     const lodemark_solve_options* options,
                                                     lodemark_solution* solution,
                                                     lodemark_range_residual* residuals);

/*
 * Camera axes: x to the right, y down, z forward. Pixel (0, 0) is the centre of the upper left
 * pixel; x counts to the right, y down.
 */

#define LODEMARK_LENS_PINHOLE 0            /* no coefficients */
#define LODEMARK_LENS_BROWN 1              /* k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y */
#define LODEMARK_LENS_FISHEYE 2            /* k1 k2 k3 k4, Kannala-Brandt */
#define LODEMARK_LENS_THIN_PRISM_FISHEYE 3 /* k1 k2 p1 p2 k3 k4 sx1 sy1 */

#define LODEMARK_LENS_COEFFICIENTS 14
#define LODEMARK_LENS_INTRINSICS 18 /* fx fy cx cy, then the coefficients */

/* A lens. Coefficients in the order of OpenCV; those the model lacks must be zero. */
typedef struct lodemark_lens {
  uint32_t struct_size;
  int32_t model;
  int32_t width_px; /* of the photographs it takes */
  int32_t height_px;
  double fx_px;
  double fy_px;
  double cx_px;
  double cy_px;
  double coefficients[LODEMARK_LENS_COEFFICIENTS];
} lodemark_lens;

/* Most points that one call on a lens takes. */
#define LODEMARK_LARGEST_POINT_COUNT 16777216

/*
 * The unit directions in camera axes (x, y, z of each) that count pixels (x, y of each) look to.
 * valid, with room for count bytes, tells which were found: 0 where the lens model images no single
 * direction there, and then the direction is zero.
 */
LODEMARK_API lodemark_status lodemark_lens_unproject(const lodemark_lens* lens,
                                                     const double* pixels_px, int32_t count,
                                                     double* directions, uint8_t* valid);

/* The pixels at which count points in camera axes (any length) appear; valid as above. */
LODEMARK_API lodemark_status lodemark_lens_project(const lodemark_lens* lens, const double* points,
                                                   int32_t count, double* pixels_px,
                                                   uint8_t* valid);

/*
 * Where the pixels would be had the lens no distortion: fx, fy, cx, cy stay, the coefficients are
 * gone. Input and output may be the same array. valid as above; 0 too for what is not in front.
 */
LODEMARK_API lodemark_status lodemark_lens_undistort_points(const lodemark_lens* lens,
                                                            const double* pixels_px, int32_t count,
                                                            double* undistorted_px, uint8_t* valid);

/* Straightens photographs of one lens; what that takes is worked out once, when it is opened. */
typedef struct lodemark_undistortion lodemark_undistortion;

/*
 * target is a pinhole lens, or NULL for the one that shows as much as it can, of the same size,
 * without black corners. used_target, unless NULL, receives the lens of the straightened images.
 */
LODEMARK_API lodemark_status lodemark_undistortion_open(const lodemark_lens* lens,
                                                        const lodemark_lens* target,
                                                        lodemark_lens* used_target,
                                                        lodemark_undistortion** undistortion);

LODEMARK_API void lodemark_undistortion_close(lodemark_undistortion* undistortion);

/*
 * Grey, 8 bits a pixel; row y of an image begins y * stride bytes after the first. The photograph
 * has the size of the lens, the output the size of the target lens. They must not overlap.
 */
LODEMARK_API lodemark_status lodemark_undistortion_apply(const lodemark_undistortion* undistortion,
                                                         const uint8_t* pixels,
                                                         int64_t stride_bytes, uint8_t* out,
                                                         int64_t out_stride_bytes);

/* Bits of lodemark_sight.present. */
#define LODEMARK_SIGHT_HAS_COVARIANCE 0x1u
#define LODEMARK_SIGHT_HAS_LANDMARK_ID 0x2u

/* A landmark and where a photograph shows it. */
typedef struct lodemark_sight {
  uint32_t struct_size;
  uint32_t present;
  uint32_t landmark_id; /* HAS_LANDMARK_ID: in its map */
  int32_t reserved;
  double pixel_px[2];
  double sigma_px; /* relative to the other sights, the common scale is estimated; 0: 1 */
  double landmark_in_ecef_m[3];
  double landmark_covariance_enu_m2[9]; /* HAS_COVARIANCE: else the landmark is exact */
  double quality;                       /* larger is surer; only the order matters */
} lodemark_sight;

/* Bits of lodemark_view_prior.present. */
#define LODEMARK_VIEW_HAS_POSITION 0x1u
#define LODEMARK_VIEW_HAS_GRAVITY 0x2u
#define LODEMARK_VIEW_HAS_HEADING 0x4u
#define LODEMARK_VIEW_HAS_ORIENTATION 0x8u

/* What is known of a camera before its photograph is looked at. All of it optional. */
typedef struct lodemark_view_prior {
  uint32_t struct_size;
  uint32_t present;
  double position_in_ecef_m[3]; /* HAS_POSITION, with its covariance, as from satellites */
  double position_covariance_enu_m2[9];
  double up_in_camera[3]; /* HAS_GRAVITY: what an accelerometer at rest measures, any length */
  double up_sigma_deg;
  double
      heading_deg; /* HAS_HEADING: of the optical axis, clockwise from north; needs HAS_POSITION */
  double heading_sigma_deg;
  double camera_from_enu[4]; /* HAS_ORIENTATION: quaternion w x y z; needs HAS_POSITION */
  double search_radius_px;   /* around where the landmarks must then appear; 0: 20 px */
  double farthest_m;         /* landmarks beyond are not asked; 0: 1000 m */
} lodemark_view_prior;

/* Bits of lodemark_resect_options.present. */
#define LODEMARK_RESECT_HAS_INTRINSICS_COVARIANCE 0x1u

#define LODEMARK_FOCAL_KNOWN 0   /* the lens's */
#define LODEMARK_FOCAL_UNKNOWN 1 /* found with the pose; the rest of the lens is kept */

/* All zero is a good choice. */
typedef struct lodemark_resect_options {
  uint32_t struct_size;
  uint32_t present;
  double inlier_threshold_px; /* times a sight's sigma; 0: 5 */
  uint64_t seed;              /* 0: 1 */
  int32_t most_samples;       /* 0: 100,000 */
  int32_t reserved;
  /* HAS_INTRINSICS_COVARIANCE: by rows, in the order of LODEMARK_LENS_INTRINSICS. */
  double intrinsics_covariance[LODEMARK_LENS_INTRINSICS * LODEMARK_LENS_INTRINSICS];
  int32_t focal; /* LODEMARK_FOCAL_... */
  int32_t reserved_2;
} lodemark_resect_options;

/* What became of a resection. The first two have a pose to use. */
#define LODEMARK_POSE_GOOD 0
#define LODEMARK_POSE_WEAK 1       /* the geometry holds it badly: see the covariance */
#define LODEMARK_POSE_AMBIGUOUS 2  /* a second pose explains the sights as well */
#define LODEMARK_POSE_TOO_FEW 3    /* fewer sights than a pose needs */
#define LODEMARK_POSE_DEGENERATE 4 /* the landmarks determine none: all on one line */
#define LODEMARK_POSE_NOT_HERE 5   /* no more sights agree than chance explains */

/* Where a camera was and where it looked. Numbers are zero where there is no pose. */
typedef struct lodemark_pose {
  uint32_t struct_size;
  int32_t verdict;
  int32_t inliers;
  int32_t samples; /* minimal sets tried */
  double ecef_m[3];
  double latitude_deg;
  double longitude_deg;
  double height_m;
  double camera_from_enu[4]; /* quaternion w x y z; east, north, up at the camera's place */
  double heading_deg;        /* of the optical axis, clockwise from north */
  double pitch_deg;          /* of the optical axis, above the horizon */
  double roll_deg;           /* about the optical axis, clockwise as seen from behind the camera */
  /* By rows: east, north, up in m2; then rotations of the camera about east, north, up in deg2. */
  double covariance[36];
  double accuracy_m;          /* horizontal */
  double vertical_accuracy_m; /* half-width */
  double noise_px;            /* of a sight with sigma 1, estimated */
  double log10_chance;        /* how often random sights would agree so well: -3 is once in 1000 */
  double alternative_ecef_m[3]; /* of POSE_AMBIGUOUS */
  double alternative_camera_from_enu[4];
  double focal_px;       /* fx of the lens, or the one found; fy is in the ratio of the lens */
  double focal_sigma_px; /* of the one found */
} lodemark_pose;

/* How one sight fared, and how far its landmark is. */
typedef struct lodemark_sight_residual {
  uint32_t struct_size;
  int32_t used;          /* 1 or 0 */
  double residual_px[2]; /* seen minus predicted; zero if the landmark could not be seen */
  double range_m;        /* the visual range, of sights used */
  double range_sigma_m;
} lodemark_sight_residual;

/*
 * The camera's pose from count sights, many of which may be mistaken. prior and options may be
 * NULL; of a prior, position and gravity are used. residuals, unless NULL, has room for count
 * elements; range_covariance_m2, unless NULL, for count * count: the covariance between the visual
 * ranges by rows, zero where a sight was not used. With LODEMARK_FOCAL_UNKNOWN of options the focal
 * length is found too, from five sights or more that do not all lie on a plane seen straight on;
 * the lens then gives the size of the image, the principal point, the distortion, and a guess.
 *
 * LODEMARK_NO_POSITION if there is no pose to use; pose->verdict says why.
 */
LODEMARK_API lodemark_status lodemark_pose_resect(
    const lodemark_lens* lens, const lodemark_sight* sights, int32_t count,
    const lodemark_view_prior* prior, const lodemark_resect_options* options, lodemark_pose* pose,
    lodemark_sight_residual* residuals, double* range_covariance_m2);

/* Map: surveyed landmarks and what they look like, in one file. */

#define LODEMARK_DESCRIPTOR_ROOT_SIFT 1
#define LODEMARK_DESCRIPTOR_ORB 2

/* Read-only. One thread at a time; several sessions of one thread may share it. */
typedef struct lodemark_map lodemark_map;

/*
 * Opens a map file, UTF-8 path, into *map; after an error *map is NULL. Takes no time that grows
 * with the map. Any file is safe to open: what is damaged gives LODEMARK_ERROR_BAD_DATA, here or
 * when it is met.
 */
LODEMARK_API lodemark_status lodemark_map_open(const char* path, lodemark_map** map);

LODEMARK_API void lodemark_map_close(lodemark_map* map);

typedef struct lodemark_map_info {
  uint32_t struct_size;
  int32_t descriptor_kind;
  int64_t landmarks;
  int64_t descriptors;
  int64_t images;
  int64_t building_parts;
  double origin_geodetic[3]; /* of the frame its landmarks lie in */
  double epoch_year;         /* of the coordinates, as 2024.5; 0: unknown */
  char id[40]; /* 32 hexadecimal digits; texts are zero-terminated, UTF-8, cut to fit */
  char datum[64];
  char provenance[256];
} lodemark_map_info;

LODEMARK_API lodemark_status lodemark_map_read_info(const lodemark_map* map,
                                                    lodemark_map_info* info);

/* All zero is a good choice. */
typedef struct lodemark_query_options {
  uint32_t struct_size;
  int32_t most_features;   /* detected in the photograph; 0: 4000 */
  int32_t longest_side_px; /* larger photographs are scaled down to this first; 0: 1600; negative:
                              never, but that SIFT takes 12.5 Mpx at most */
  int32_t lists_to_visit;  /* of the map's index, for each feature; 0: as the index advises */
  double largest_ratio;    /* nearest to second nearest landmark; 0: 0.8 */
} lodemark_query_options;

/*
 * What of the map a photograph shows: each feature that is taken for a landmark, the surest first.
 * The image is grey, 8 bits a pixel, of the lens's size, row y at pixels + y * stride_bytes. prior
 * and options may be NULL; with a prior only what can be in view is asked, with HAS_ORIENTATION
 * only where each landmark must appear. At most LODEMARK_LARGEST_COUNT sights; asking with capacity
 * 0 does the whole work, so rather give room at once.
 */
LODEMARK_API lodemark_status lodemark_map_query(lodemark_map* map, const lodemark_lens* lens,
                                                const uint8_t* pixels, int64_t stride_bytes,
                                                const lodemark_view_prior* prior,
                                                const lodemark_query_options* options,
                                                lodemark_sight* out, int32_t capacity,
                                                int32_t* count);

/*
 * Query and resect in one, and once more around the pose found: where the photograph was taken.
 * out, capacity, count: the sights of the last round; out may be NULL with capacity 0 and residuals
 * NULL; otherwise both have room for capacity elements. The other arguments as in
 * lodemark_map_query and lodemark_pose_resect, but that LODEMARK_FOCAL_UNKNOWN gives
 * LODEMARK_ERROR_UNSUPPORTED: query, and resect with it.
 */
LODEMARK_API lodemark_status lodemark_map_locate(
    lodemark_map* map, const lodemark_lens* lens, const uint8_t* pixels, int64_t stride_bytes,
    const lodemark_view_prior* prior, const lodemark_query_options* query_options,
    const lodemark_resect_options* resect_options, lodemark_pose* pose, lodemark_sight* out,
    lodemark_sight_residual* residuals, int32_t capacity, int32_t* count);

/* Session: a stream of measurements in, a position at each epoch and photograph out. */

/* Satellites are numbered as RINEX does: GLONASS by slot, QZSS by PRN - 192, SBAS by PRN - 100. */
#define LODEMARK_SYSTEM_GPS 0
#define LODEMARK_SYSTEM_GLONASS 1
#define LODEMARK_SYSTEM_GALILEO 2
#define LODEMARK_SYSTEM_BEIDOU 3
#define LODEMARK_SYSTEM_QZSS 4
#define LODEMARK_SYSTEM_NAVIC 5
#define LODEMARK_SYSTEM_SBAS 6

#define LODEMARK_TIME_BASE_GPS 0  /* recordings: epochs carry GPS time */
#define LODEMARK_TIME_BASE_BOOT 1 /* phones: SystemClock.elapsedRealtimeNanos() */

#define LODEMARK_IONOSPHERE_BEST 0 /* by the coefficients received, else climatology */
#define LODEMARK_IONOSPHERE_NONE 1
#define LODEMARK_IONOSPHERE_KLOBUCHAR 2
#define LODEMARK_IONOSPHERE_BDGIM 3
#define LODEMARK_IONOSPHERE_NTCM_G 4
#define LODEMARK_IONOSPHERE_CLIMATOLOGY 5

#define LODEMARK_TROPOSPHERE_SAASTAMOINEN 0
#define LODEMARK_TROPOSPHERE_HOPFIELD 1
#define LODEMARK_TROPOSPHERE_NONE 2

/* What a position is made of where the session has photographs of its map. */
#define LODEMARK_SCHEME_JOINT 0          /* landmarks' bearings and satellites' ranges together */
#define LODEMARK_SCHEME_TIGHT 1          /* visual ranges beside those of satellites */
#define LODEMARK_SCHEME_TIGHT_DIAGONAL 2 /* as if visual ranges were independent, as published */
#define LODEMARK_SCHEME_VISION 3         /* photographs alone */
#define LODEMARK_SCHEME_GNSS 4           /* satellites alone */

/* What the position of one moment takes from the moments before. */
#define LODEMARK_ESTIMATOR_EPOCH 0    /* nothing but biases between signals */
#define LODEMARK_ESTIMATOR_FILTER 1   /* place and velocity, by Doppler and carrier phase */
#define LODEMARK_ESTIMATOR_SMOOTHER 2 /* the same, and remembered for lodemark_session_smoothed */

#define LODEMARK_WEIGHT_SIGNAL 0    /* C/N0, elevation and reported uncertainty */
#define LODEMARK_WEIGHT_ELEVATION 1 /* variance a^2 + b^2 / sin^2(elevation) */

/* Bits of lodemark_session_options.flags. */
#define LODEMARK_SESSION_VARIANCE_COMPONENTS 0x1u /* from residuals: a and b, factors of groups */
#define LODEMARK_SESSION_ZENITH_DELAY 0x2u        /* estimate a tropospheric zenith delay */
#define LODEMARK_SESSION_HEIGHT_MEMORY 0x4u       /* a weak memory of the height */
#define LODEMARK_SESSION_FIXED_BIASES 0x8u        /* learn no biases from past epochs */
#define LODEMARK_SESSION_ACCEPT_UNHEALTHY 0x10u   /* use satellites that say they are unhealthy */

/* All zero is a good choice. */
typedef struct lodemark_session_options {
  uint32_t struct_size;
  int32_t time_base;
  uint32_t systems; /* bit 1 << LODEMARK_SYSTEM_...; 0: all */
  uint32_t flags;
  int32_t ionosphere;
  int32_t troposphere;
  int32_t weight;
  int32_t queue_capacity;    /* epochs that may wait for process; 0: 64, at most 4096 */
  double elevation_mask_deg; /* 0: 5 degrees; -90: no mask */
  double smallest_cn0_dbhz;  /* 0: 10 dB-Hz; negative: no limit */
  double elevation_a_m;      /* of WEIGHT_ELEVATION; 0: 1 m */
  double elevation_b_m;      /* of WEIGHT_ELEVATION; 0: 1 m */
  uint64_t seed;             /* of every random choice; 0: 1 */
  int32_t scheme;
  int32_t estimator;
} lodemark_session_options;

typedef struct lodemark_session lodemark_session;

/* Opens a session into *session; after an error *session is NULL. options may be NULL. */
LODEMARK_API lodemark_status lodemark_session_open(const lodemark_session_options* options,
                                                   lodemark_session** session);

LODEMARK_API void lodemark_session_close(lodemark_session* session);

/* Forgets positions, clocks, queued epochs, events and learned biases; keeps the orbits. */
LODEMARK_API lodemark_status lodemark_session_reset(lodemark_session* session);

/* Bits of lodemark_gnss_clock.present. */
#define LODEMARK_CLOCK_HAS_LEAP_SECOND 0x1u
#define LODEMARK_CLOCK_HAS_TIME_UNCERTAINTY 0x2u
#define LODEMARK_CLOCK_HAS_FULL_BIAS 0x4u
#define LODEMARK_CLOCK_HAS_BIAS 0x8u
#define LODEMARK_CLOCK_HAS_BIAS_UNCERTAINTY 0x10u
#define LODEMARK_CLOCK_HAS_DRIFT 0x20u
#define LODEMARK_CLOCK_HAS_DRIFT_UNCERTAINTY 0x40u
#define LODEMARK_CLOCK_HAS_ELAPSED_REALTIME 0x80u

/* android.location.GnssClock, value by value. Fields without a bit above always count. */
typedef struct lodemark_gnss_clock {
  uint32_t struct_size;
  uint32_t present;
  int64_t time_ns;
  int64_t full_bias_ns;
  int64_t elapsed_realtime_ns;
  double bias_ns;
  double bias_uncertainty_ns;
  double drift_nsps;
  double drift_uncertainty_nsps;
  double time_uncertainty_ns;
  int32_t leap_second;
  int32_t hardware_clock_discontinuity_count;
} lodemark_gnss_clock;

/* Bits of lodemark_gnss_measurement.present. */
#define LODEMARK_MEASUREMENT_HAS_CARRIER_FREQUENCY 0x1u
#define LODEMARK_MEASUREMENT_HAS_ACCUMULATED_DELTA_RANGE 0x2u
#define LODEMARK_MEASUREMENT_HAS_SNR 0x4u
#define LODEMARK_MEASUREMENT_HAS_AGC 0x8u
#define LODEMARK_MEASUREMENT_HAS_BASEBAND_CN0 0x10u
#define LODEMARK_MEASUREMENT_HAS_FULL_INTER_SIGNAL_BIAS 0x20u
#define LODEMARK_MEASUREMENT_HAS_SATELLITE_INTER_SIGNAL_BIAS 0x40u
#define LODEMARK_MEASUREMENT_HAS_CODE_TYPE 0x80u
#define LODEMARK_MEASUREMENT_HAS_RECEIVED_TIME_UNCERTAINTY 0x100u
#define LODEMARK_MEASUREMENT_HAS_RANGE_RATE 0x200u
#define LODEMARK_MEASUREMENT_HAS_RANGE_RATE_UNCERTAINTY 0x400u
#define LODEMARK_MEASUREMENT_HAS_CN0 0x800u
#define LODEMARK_MEASUREMENT_HAS_GIVEN_PSEUDORANGE 0x1000u

/* android.location.GnssMeasurement, value by value. Fields without a bit above always count. */
typedef struct lodemark_gnss_measurement {
  uint32_t struct_size;
  uint32_t present;
  int32_t svid;
  int32_t constellation_type; /* GnssStatus.CONSTELLATION_... */
  int32_t state;              /* GnssMeasurement.STATE_... bits */
  int32_t accumulated_delta_range_state;
  int32_t multipath_indicator;
  int32_t reserved;
  int64_t received_sv_time_ns;
  int64_t received_sv_time_uncertainty_ns;
  double time_offset_ns;
  double cn0_dbhz;
  double baseband_cn0_dbhz;
  double pseudorange_rate_mps;
  double pseudorange_rate_uncertainty_mps;
  double accumulated_delta_range_m;
  double accumulated_delta_range_uncertainty_m;
  double carrier_frequency_hz;
  double snr_db;
  double agc_db;
  double full_inter_signal_bias_ns;
  double satellite_inter_signal_bias_ns;
  double given_pseudorange_m; /* computed elsewhere; for logs whose time stamps lost their digits */
  char code_type[8];          /* "C", "Q", ...; zero-terminated */
} lodemark_gnss_measurement;

/*
 * Queues one GnssMeasurementsEvent. time_ns is its time in the session's base; a session based on
 * GPS time takes the time from the clock and ignores it. LODEMARK_ERROR_QUEUE_FULL if too many
 * epochs wait.
 */
LODEMARK_API lodemark_status lodemark_session_push_gnss(
    lodemark_session* session, int64_t time_ns, const lodemark_gnss_clock* clock,
    const lodemark_gnss_measurement* measurements, int32_t count);

/* Bits of lodemark_observation_epoch.flags. */
#define LODEMARK_EPOCH_CLOCK_DISCONTINUITY 0x1u /* reset or steered since the epoch before */

/* One instant of a receiver that gives pseudoranges, as RINEX observation files hold them. */
typedef struct lodemark_observation_epoch {
  uint32_t struct_size;
  uint32_t flags;
  int64_t time_gps_ns;     /* the receiver's reading, which the pseudoranges refer to */
  double time_fraction_ns; /* to be added to time_gps_ns */
} lodemark_observation_epoch;

/* Bits of lodemark_observation.present. */
#define LODEMARK_OBSERVATION_HAS_PSEUDORANGE 0x1u
#define LODEMARK_OBSERVATION_HAS_CARRIER_PHASE 0x2u
#define LODEMARK_OBSERVATION_HAS_DOPPLER 0x4u
#define LODEMARK_OBSERVATION_HAS_CN0 0x8u
#define LODEMARK_OBSERVATION_HAS_PSEUDORANGE_SIGMA 0x10u
#define LODEMARK_OBSERVATION_HAS_CARRIER_PHASE_SIGMA 0x20u
#define LODEMARK_OBSERVATION_HAS_RANGE_RATE_SIGMA 0x40u
#define LODEMARK_OBSERVATION_HAS_GLONASS_CHANNEL 0x80u

/* Bits of lodemark_observation.flags. */
#define LODEMARK_OBSERVATION_LOSS_OF_LOCK 0x1u         /* the phase may have slipped */
#define LODEMARK_OBSERVATION_HALF_CYCLE_AMBIGUOUS 0x2u /* or be off by half a cycle */
#define LODEMARK_OBSERVATION_MULTIPATH_DETECTED 0x4u

/* One signal of one satellite. */
typedef struct lodemark_observation {
  uint32_t struct_size;
  uint32_t present;
  uint32_t flags;
  int32_t system;
  int32_t satellite;       /* from 1 */
  int32_t glonass_channel; /* -7 .. 6 */
  char signal[8];          /* band and attribute of RINEX 3 and 4: "1C", "5Q", "2" */
  double frequency_hz;     /* of the carrier; 0: what the signal (and GLONASS channel) has */
  double pseudorange_m;
  double carrier_phase_cycles; /* grows with the range */
  double doppler_hz;           /* positive when the satellite approaches */
  double cn0_dbhz;
  double pseudorange_sigma_m;
  double carrier_phase_sigma_m;
  double range_rate_sigma_mps;
} lodemark_observation;

/* Queues one epoch of observables. The rest is as with lodemark_session_push_gnss. */
LODEMARK_API lodemark_status lodemark_session_push_observations(
    lodemark_session* session, int64_t time_ns, const lodemark_observation_epoch* epoch,
    const lodemark_observation* observations, int32_t count);

/* What a text held. */
typedef struct lodemark_read_report {
  uint32_t struct_size;
  uint32_t reserved;
  int64_t rows_read;       /* rows or records that were taken */
  int64_t rows_skipped;    /* malformed ones */
  int64_t rows_unknown;    /* of a kind this version does not know */
  char first_problem[256]; /* "name:line:column: why", "" if there was none */
} lodemark_read_report;

/*
 * Takes the content of a file: RINEX navigation of any version, SP3 orbits and clocks; plain or
 * gzip. name stands for the file in messages and may be NULL, and so may report. Malformed rows are
 * counted and skipped; LODEMARK_ERROR_BAD_DATA if it is no such file at all.
 */
LODEMARK_API lodemark_status lodemark_session_push_navigation(lodemark_session* session,
                                                              const char* name, const void* bytes,
                                                              size_t byte_count,
                                                              lodemark_read_report* report);
LODEMARK_API lodemark_status lodemark_session_push_precise_orbits(lodemark_session* session,
                                                                  const char* name,
                                                                  const void* bytes,
                                                                  size_t byte_count,
                                                                  lodemark_read_report* report);

/* android.location.GnssNavigationMessage but for its data. */
typedef struct lodemark_broadcast_message {
  uint32_t struct_size;
  int32_t type; /* GnssNavigationMessage.TYPE_... */
  int32_t svid;
  int32_t message_id;
  int32_t submessage_id;
  int32_t reserved;
} lodemark_broadcast_message;

/*
 * Takes a message as it was broadcast. An orbit takes effect when its last part has arrived.
 * LODEMARK_ERROR_OUT_OF_ORDER before the first epoch gave a GPS time, LODEMARK_ERROR_UNSUPPORTED
 * for a type this version does not decode, LODEMARK_ERROR_BAD_DATA if the data are damaged.
 */
LODEMARK_API lodemark_status lodemark_session_push_broadcast(
    lodemark_session* session, const lodemark_broadcast_message* message, const uint8_t* bytes,
    size_t byte_count);

/*
 * The map that photographs are looked up in; NULL for none. Where it has buildings, satellites
 * behind them are trusted less, and landmarks behind them are looked for only if the others give
 * no pose, or around the pose they give. It must stay open while the session uses it, and be used
 * by the same thread. LODEMARK_ERROR_BAD_DATA if its buildings are damaged; the session then has
 * no map.
 */
LODEMARK_API lodemark_status lodemark_session_use_map(lodemark_session* session, lodemark_map* map);

/* Bits of lodemark_frame.present. */
#define LODEMARK_FRAME_HAS_GRAVITY 0x1u
#define LODEMARK_FRAME_HAS_HEADING 0x2u
#define LODEMARK_FRAME_HAS_CAMERA_FROM_DEVICE 0x4u

/* How a photograph was taken, as far as it is known. */
typedef struct lodemark_frame {
  uint32_t struct_size;
  uint32_t present;
  int64_t time_ns;        /* of the middle of the exposure, in the session's base */
  double up_in_camera[3]; /* HAS_GRAVITY: what an accelerometer at rest measures, any length */
  double up_sigma_deg;
  double heading_deg; /* HAS_HEADING: of the optical axis, clockwise from north */
  double heading_sigma_deg;
  /* HAS_CAMERA_FROM_DEVICE: turns axes of the accelerometer into those of the camera, quaternion
   * w x y z. Without HAS_GRAVITY, samples pushed around the exposure then tell what is up; where
   * inertial sensors carry a filter, they tell the heading, too, without HAS_HEADING. Of a phone's
   * back camera: 0, cos(a / 2), -sin(a / 2), 0 with a Android's SENSOR_ORIENTATION. */
  double camera_from_device[4];
} lodemark_frame;

/*
 * Queues a photograph: grey, 8 bits a pixel, of the lens's size, row y at pixels + y *
 * stride_bytes; it is copied. What it shows is looked up when it is processed, around the last
 * position where there is one. LODEMARK_ERROR_OUT_OF_ORDER before a map is used,
 * LODEMARK_ERROR_QUEUE_FULL if four photographs wait.
 *
 * It may come up to 3 s late, after younger epochs and photographs were processed: with
 * LODEMARK_ESTIMATOR_FILTER and LODEMARK_ESTIMATOR_SMOOTHER it is heard at its time and what came
 * after it once more, so that later estimates are what they would be had it come in time; one that
 * comes later still is dropped with an event. Without a filter it is used with the latest epoch
 * where they are within 1.5 s.
 */
LODEMARK_API lodemark_status lodemark_session_push_image(lodemark_session* session,
                                                         const lodemark_frame* frame,
                                                         const lodemark_lens* lens,
                                                         const uint8_t* pixels,
                                                         int64_t stride_bytes);

#define LODEMARK_SENSOR_ACCELEROMETER 1 /* specific force, m/s2: at rest 9.8 upwards */
#define LODEMARK_SENSOR_GYROSCOPE 2     /* turn rate, rad/s, right-handed about the same axes */
#define LODEMARK_SENSOR_BAROMETER 3     /* value[0]: pressure, hPa */
#define LODEMARK_SENSOR_VEHICLE 4 /* value[0]: forward speed, m/s; [1]: yaw rate, rad/s, left + */

/* What a sensor measured at one moment. */
typedef struct lodemark_sensor_sample {
  uint32_t struct_size;
  int32_t sensor;  /* LODEMARK_SENSOR_... */
  int64_t time_ns; /* in the session's base */
  double value[3]; /* those that the sensor does not have are zero */
} lodemark_sensor_sample;

/*
 * Takes samples of any sensors, those of one sensor in the order of their times; at once, they need
 * no process. A sample not later than the one before of its sensor is dropped, and an event tells
 * of the first; where such samples go on for over a second, the sensor's clock was set back, and it
 * begins anew. Push what was measured before an epoch, and the first samples after it, before the
 * epoch is processed: later it is not heard. A session remembers the last 8192 samples of either
 * inertial sensor, 2048 of the barometer and 4096 of the vehicle.
 *
 * LODEMARK_ESTIMATOR_FILTER and LODEMARK_ESTIMATOR_SMOOTHER use them, and photographs are levelled
 * by them; LODEMARK_ERROR_INVALID_ARGUMENT for numbers that no sensor gives, naming the sample.
 */
LODEMARK_API lodemark_status lodemark_session_push_sensors(lodemark_session* session,
                                                           const lodemark_sensor_sample* samples,
                                                           int32_t count);

/*
 * Turns the oldest of what waits, epoch or photograph, into an estimate at its time: an epoch with
 * the latest photograph, a photograph with the latest epoch, where they are within 1.5 s. What the
 * receiver may have moved in between is allowed for. LODEMARK_NOTHING_QUEUED if nothing waits,
 * LODEMARK_NO_POSITION if it was processed and gave no position; the estimate then says why.
 */
LODEMARK_API lodemark_status lodemark_session_process(lodemark_session* session);

/* How many epochs and photographs wait for process. */
LODEMARK_API lodemark_status lodemark_session_queued(const lodemark_session* session,
                                                     int32_t* count);

/* Bits of lodemark_estimate.present. */
#define LODEMARK_ESTIMATE_HAS_POSITION 0x1u
#define LODEMARK_ESTIMATE_HAS_VELOCITY 0x2u
#define LODEMARK_ESTIMATE_HAS_GPS_TIME 0x4u
#define LODEMARK_ESTIMATE_HAS_PROTECTION_LEVEL 0x8u
#define LODEMARK_ESTIMATE_HAS_VERTICAL_PROTECTION_LEVEL 0x10u
#define LODEMARK_ESTIMATE_HAS_ORIENTATION 0x20u
#define LODEMARK_ESTIMATE_HAS_SATELLITE_SIGMA_FACTOR 0x40u
#define LODEMARK_ESTIMATE_HAS_LANDMARK_SIGMA_FACTOR 0x80u
#define LODEMARK_ESTIMATE_HAS_ATTITUDE 0x100u

/* Bits of lodemark_estimate.sources. */
#define LODEMARK_SOURCE_GNSS 0x1u
#define LODEMARK_SOURCE_VISION 0x2u
#define LODEMARK_SOURCE_INERTIAL 0x4u /* of a filter carried by inertial sensors */

/* What the latest photograph gave the estimate. */
#define LODEMARK_PHOTO_NONE 0 /* there was none, or none near in time */
#define LODEMARK_PHOTO_USED 1
#define LODEMARK_PHOTO_NOT_RECOGNISED 2 /* it shows too little of the map */
#define LODEMARK_PHOTO_DISAGREEING 3    /* its landmarks fit no one place */
#define LODEMARK_PHOTO_CONTRADICTED 4   /* satellites prove it to be of another place */

/* Where the phone was at the epoch or photograph processed last. */
typedef struct lodemark_estimate {
  uint32_t struct_size;
  uint32_t present;
  int32_t outcome;
  uint32_t sources;        /* what the position rests on */
  int32_t satellites_used; /* distinct satellites, however many signals */
  int32_t satellites_seen;
  int64_t time_ns;     /* in the session's base */
  int64_t time_gps_ns; /* HAS_GPS_TIME */
  /* HAS_POSITION, down to tdop: */
  double ecef_m[3];
  double latitude_deg;
  double longitude_deg;
  double height_m;
  double covariance_enu_m2[9];
  double accuracy_m;          /* horizontal */
  double vertical_accuracy_m; /* half-width */
  double clock_bias_m;        /* receiver clock minus GPS time, times the speed of light */
  double pdop;
  double hdop;
  double vdop;
  double tdop;
  /* HAS_VELOCITY, down to clock_drift_mps: */
  double velocity_enu_mps[3];
  double velocity_covariance_enu_m2ps2[9];
  double speed_accuracy_mps;
  double clock_drift_mps;
  /* HAS_PROTECTION_LEVEL and HAS_VERTICAL_PROTECTION_LEVEL: absent where nothing is redundant, so
   * that the fault of a single range could go unseen. */
  double protection_level_m; /* horizontal */
  double vertical_protection_level_m;
  /* HAS_ORIENTATION: of the camera when its photograph was taken: quaternion w x y z. */
  double camera_from_enu[4];
  int32_t photo;          /* LODEMARK_PHOTO_... */
  int32_t landmarks_used; /* of the photograph */
  int32_t landmarks_seen;
  int32_t reserved;
  /* Variance components, where they were asked for and satellites and landmarks tell them: how many
   * times larger than stated their errors were taken for. */
  double satellite_sigma_factor; /* HAS_SATELLITE_SIGMA_FACTOR */
  double landmark_sigma_factor;  /* HAS_LANDMARK_SIGMA_FACTOR */
  /* HAS_ATTITUDE: how the phone is turned, where its inertial sensors carry the filter. Turns east,
   * north, up into the axes of the accelerometer: quaternion w x y z. */
  double device_from_enu[4];
  double attitude_covariance_enu_deg2[9]; /* of small turns about east, north and up */
  double heading_accuracy_deg;            /* half-width: of the turn about up */
} lodemark_estimate;

/*
 * The estimate of the epoch processed last. LODEMARK_NO_POSITION if it has no position;
 * estimate->outcome says why.
 */
LODEMARK_API lodemark_status lodemark_session_estimate(const lodemark_session* session,
                                                       lodemark_estimate* estimate);

/*
 * Every estimate since the session was opened or reset, in the order they were given, each with
 * what came after it: for a recording, not for live use. Needs LODEMARK_ESTIMATOR_SMOOTHER, with
 * which a session remembers some 3 kB for each; there are none otherwise. out, capacity, count: as
 * for lodemark_session_satellites. Takes longer the more there are.
 */
LODEMARK_API lodemark_status lodemark_session_smoothed(const lodemark_session* session,
                                                       lodemark_estimate* out, int32_t capacity,
                                                       int32_t* count);

/* Why a signal was used, or why not. */
#define LODEMARK_VERDICT_USED 0
#define LODEMARK_VERDICT_DOWN_WEIGHTED 1
#define LODEMARK_VERDICT_NO_EPHEMERIS 2
#define LODEMARK_VERDICT_EPHEMERIS_TOO_OLD 3
#define LODEMARK_VERDICT_UNHEALTHY 4
#define LODEMARK_VERDICT_LOW_ELEVATION 5
#define LODEMARK_VERDICT_WEAK_SIGNAL 6
#define LODEMARK_VERDICT_NOT_TRACKING 7
#define LODEMARK_VERDICT_TIME_AMBIGUOUS 8
#define LODEMARK_VERDICT_IMPLAUSIBLE 9
#define LODEMARK_VERDICT_OUTLIER 10
#define LODEMARK_VERDICT_SYSTEM_OFF 11
#define LODEMARK_VERDICT_UNKNOWN_SIGNAL 12
#define LODEMARK_VERDICT_UNOBSERVABLE 13   /* the only one of its clock group */
#define LODEMARK_VERDICT_PHOTO_NOT_USED 14 /* a landmark whose photograph was not used */

/* Bits of lodemark_satellite.present. */
#define LODEMARK_SATELLITE_HAS_RESIDUAL 0x1u            /* residual_m, sigma_m */
#define LODEMARK_SATELLITE_HAS_DIRECTION 0x2u           /* elevation_deg, azimuth_deg */
#define LODEMARK_SATELLITE_HAS_RANGE_RATE_RESIDUAL 0x4u /* range_rate_residual_mps */
#define LODEMARK_SATELLITE_HAS_CN0 0x8u                 /* cn0_dbhz */
#define LODEMARK_SATELLITE_HAS_SIGHT 0x10u

/* One signal of the epoch processed last. */
typedef struct lodemark_satellite {
  uint32_t struct_size;
  uint32_t present;
  int32_t system;
  int32_t satellite;
  int32_t verdict;
  int32_t reserved;
  char signal[8];    /* "1C", zero-terminated */
  double residual_m; /* observed minus computed code range after the adjustment */
  double sigma_m;    /* stated for the code range */
  double weight;     /* share of its full weight that it kept, 0 .. 1 */
  double elevation_deg;
  double azimuth_deg; /* clockwise from north, 0 .. 360 */
  double cn0_dbhz;
  double range_rate_residual_mps;
  double sight_probability; /* HAS_SIGHT: 0 .. 1, that no building of the map stands in the way */
} lodemark_satellite;

/* The signals of the epoch processed last; none if it was a photograph. */
LODEMARK_API lodemark_status lodemark_session_satellites(const lodemark_session* session,
                                                         lodemark_satellite* out, int32_t capacity,
                                                         int32_t* count);

/* Bits of lodemark_landmark.present. */
#define LODEMARK_LANDMARK_HAS_RESIDUAL 0x1u /* residual_px, range_m, range_sigma_m */

/* One landmark in the photograph that the estimate looked at. */
typedef struct lodemark_landmark {
  uint32_t struct_size;
  uint32_t present;
  uint32_t landmark_id; /* in its map */
  int32_t verdict;      /* USED, DOWN_WEIGHTED, OUTLIER or PHOTO_NOT_USED of LODEMARK_VERDICT_... */
  double pixel_px[2];
  double residual_px[2]; /* seen minus predicted from the estimate */
  double weight;         /* share of its full weight that it kept, 0 .. 1 */
  double range_m;        /* from the estimate */
  double range_sigma_m;
  double landmark_in_ecef_m[3];
} lodemark_landmark;

/* The landmarks that the estimate looked at, used or not; none where no photograph was near. */
LODEMARK_API lodemark_status lodemark_session_landmarks(const lodemark_session* session,
                                                        lodemark_landmark* out, int32_t capacity,
                                                        int32_t* count);

#define LODEMARK_EVENT_CLOCK_DISCONTINUITY 0 /* the receiver said so, or its bias was held anew */
#define LODEMARK_EVENT_MILLISECOND_JUMP 1    /* found and repaired; value: milliseconds */
#define LODEMARK_EVENT_TIME_BACKWARDS 2      /* an epoch older than the last one: dropped */
#define LODEMARK_EVENT_DUPLICATE_EPOCH 3     /* the same time twice: the second dropped */
#define LODEMARK_EVENT_FIRST_FIX 4
#define LODEMARK_EVENT_FIX_LOST 5
#define LODEMARK_EVENT_EPHEMERIS_MISSING 6  /* first time that a satellite had no orbit */
#define LODEMARK_EVENT_PHOTO_CONTRADICTED 7 /* by satellites: it is of another place */
#define LODEMARK_EVENT_PHOTO_FAILED 8       /* it could not be looked up; the text says why */
#define LODEMARK_EVENT_MAP_DATUM 9          /* the map was moved to where satellites put it */
#define LODEMARK_EVENT_SENSOR_DROPPED 10    /* samples that came late; value: LODEMARK_SENSOR_... */
#define LODEMARK_EVENT_FILTER_RESTARTED 11  /* the filter's place was proven wrong: begun anew */
#define LODEMARK_EVENT_INERTIAL_ALIGNED 12  /* inertial sensors carry the filter from here */
#define LODEMARK_EVENT_INERTIAL_LOST 13     /* they do not any more */
#define LODEMARK_EVENT_PHOTO_TOO_LATE 14    /* dropped; value: by so many seconds it came late */

/* Something that happened in between. */
typedef struct lodemark_event {
  uint32_t struct_size;
  int32_t kind;
  int64_t time_ns;     /* in the session's base */
  int64_t time_gps_ns; /* 0 if unknown */
  double value;        /* what the kind says */
  char text[256];      /* one sentence, UTF-8, zero-terminated */
} lodemark_event;

/* The events since the last clear, oldest first. Of more than 256 the oldest are lost. */
LODEMARK_API lodemark_status lodemark_session_events(const lodemark_session* session,
                                                     lodemark_event* out, int32_t capacity,
                                                     int32_t* count);

LODEMARK_API lodemark_status lodemark_session_clear_events(lodemark_session* session);

/* Log: what a phone or a receiver recorded, pushed as if it came from there. */

/*
 * A GnssLogger text of any version, or a file of a u-blox receiver (UBX-RXM-RAWX and -SFRBX), plain
 * or gzip, read as far as it was pushed.
 */
typedef struct lodemark_log lodemark_log;

/* Opens a log file, UTF-8 path, into *log; after an error *log is NULL. Any file is safe. */
LODEMARK_API lodemark_status lodemark_log_open(const char* path, lodemark_log** log);

LODEMARK_API void lodemark_log_close(lodemark_log* log);

/*
 * Pushes the next epoch of the log, and first the broadcast messages before it and what a phone's
 * accelerometer, gyroscope and barometer measured until 60 ms after it, so process each epoch
 * before the next. A session based on time since boot takes the time from the clock's elapsed
 * realtime, or where the log lacks it from the receiver's hardware clock (u-blox: its GPS time);
 * samples have a time where an epoch tells both it and GPS time. LODEMARK_END_OF_LOG after the last
 * epoch. After LODEMARK_ERROR_QUEUE_FULL the same epoch comes again, after any other refusal the
 * next one. LODEMARK_ERROR_BAD_DATA at the end of a file that held no epoch, or that is cut short.
 */
LODEMARK_API lodemark_status lodemark_log_push_next(lodemark_log* log, lodemark_session* session);

#ifdef __cplusplus
}
#endif

#endif /* LODEMARK_LODEMARK_H_ */
