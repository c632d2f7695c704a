package io.lodemark;

/**
 * Constants of lodemark.h that are no enum in Java: statuses, bits of present and flags words,
 * limits. A test compares them with the header's.
 */
final class Values {
  private Values() {}

  static final int OK = 0;
  static final int NOTHING_QUEUED = 1;
  static final int NO_POSITION = 2;
  static final int END_OF_LOG = 3;
  static final int ERROR_INVALID_ARGUMENT = -1;
  static final int ERROR_UNSUPPORTED = -2;
  static final int ERROR_OUT_OF_ORDER = -3;
  static final int ERROR_QUEUE_FULL = -4;
  static final int ERROR_IO = -5;
  static final int ERROR_BAD_DATA = -6;
  static final int ERROR_OUT_OF_MEMORY = -7;
  static final int ERROR_INTERNAL = -8;
  static final int CLOCK_GROUP_NONE = 0;
  static final int CLOCK_GROUPS = 16;
  static final int LARGEST_COUNT = 4096;
  static final int SOLVE_HAS_START = 0x1;
  static final int LENS_COEFFICIENTS = 14;
  static final int SIGHT_HAS_COVARIANCE = 0x1;
  static final int SIGHT_HAS_LANDMARK_ID = 0x2;
  static final int VIEW_HAS_POSITION = 0x1;
  static final int VIEW_HAS_GRAVITY = 0x2;
  static final int VIEW_HAS_HEADING = 0x4;
  static final int VIEW_HAS_ORIENTATION = 0x8;
  static final int SESSION_VARIANCE_COMPONENTS = 0x1;
  static final int SESSION_ZENITH_DELAY = 0x2;
  static final int SESSION_HEIGHT_MEMORY = 0x4;
  static final int SESSION_FIXED_BIASES = 0x8;
  static final int SESSION_ACCEPT_UNHEALTHY = 0x10;
  static final int CLOCK_HAS_LEAP_SECOND = 0x1;
  static final int CLOCK_HAS_TIME_UNCERTAINTY = 0x2;
  static final int CLOCK_HAS_FULL_BIAS = 0x4;
  static final int CLOCK_HAS_BIAS = 0x8;
  static final int CLOCK_HAS_BIAS_UNCERTAINTY = 0x10;
  static final int CLOCK_HAS_DRIFT = 0x20;
  static final int CLOCK_HAS_DRIFT_UNCERTAINTY = 0x40;
  static final int CLOCK_HAS_ELAPSED_REALTIME = 0x80;
  static final int MEASUREMENT_HAS_CARRIER_FREQUENCY = 0x1;
  static final int MEASUREMENT_HAS_ACCUMULATED_DELTA_RANGE = 0x2;
  static final int MEASUREMENT_HAS_SNR = 0x4;
  static final int MEASUREMENT_HAS_AGC = 0x8;
  static final int MEASUREMENT_HAS_BASEBAND_CN0 = 0x10;
  static final int MEASUREMENT_HAS_FULL_INTER_SIGNAL_BIAS = 0x20;
  static final int MEASUREMENT_HAS_SATELLITE_INTER_SIGNAL_BIAS = 0x40;
  static final int MEASUREMENT_HAS_CODE_TYPE = 0x80;
  static final int MEASUREMENT_HAS_RECEIVED_TIME_UNCERTAINTY = 0x100;
  static final int MEASUREMENT_HAS_RANGE_RATE = 0x200;
  static final int MEASUREMENT_HAS_RANGE_RATE_UNCERTAINTY = 0x400;
  static final int MEASUREMENT_HAS_CN0 = 0x800;
  static final int MEASUREMENT_HAS_GIVEN_PSEUDORANGE = 0x1000;
  static final int FRAME_HAS_GRAVITY = 0x1;
  static final int FRAME_HAS_HEADING = 0x2;
  static final int FRAME_HAS_CAMERA_FROM_DEVICE = 0x4;
  static final int SENSOR_ACCELEROMETER = 1;
  static final int SENSOR_GYROSCOPE = 2;
  static final int SENSOR_BAROMETER = 3;
  static final int SENSOR_VEHICLE = 4;
  static final int ESTIMATE_HAS_POSITION = 0x1;
  static final int ESTIMATE_HAS_VELOCITY = 0x2;
  static final int ESTIMATE_HAS_GPS_TIME = 0x4;
  static final int ESTIMATE_HAS_PROTECTION_LEVEL = 0x8;
  static final int ESTIMATE_HAS_VERTICAL_PROTECTION_LEVEL = 0x10;
  static final int ESTIMATE_HAS_ORIENTATION = 0x20;
  static final int ESTIMATE_HAS_SATELLITE_SIGMA_FACTOR = 0x40;
  static final int ESTIMATE_HAS_LANDMARK_SIGMA_FACTOR = 0x80;
  static final int ESTIMATE_HAS_ATTITUDE = 0x100;
  static final int SOURCE_GNSS = 0x1;
  static final int SOURCE_VISION = 0x2;
  static final int SOURCE_INERTIAL = 0x4;
  static final int SATELLITE_HAS_RESIDUAL = 0x1;
  static final int SATELLITE_HAS_DIRECTION = 0x2;
  static final int SATELLITE_HAS_RANGE_RATE_RESIDUAL = 0x4;
  static final int SATELLITE_HAS_CN0 = 0x8;
  static final int SATELLITE_HAS_SIGHT = 0x10;
  static final int LANDMARK_HAS_RESIDUAL = 0x1;
}
