package io.lodemark;

/**
 * Where the fields of the structs of lodemark.h lie, in bytes from the beginning of the struct. The
 * layouts are promises of the C interface, the same for 32-bit and 64-bit processors; a test
 * compares every number here with what the compiler of the natives says.
 */
final class Layout {
  private Layout() {}

  /** lodemark_session_options. */
  static final class SessionOptions {
    private SessionOptions() {}

    static final int SIZE = 80;
    static final int TIME_BASE = 4;
    static final int SYSTEMS = 8;
    static final int FLAGS = 12;
    static final int IONOSPHERE = 16;
    static final int TROPOSPHERE = 20;
    static final int WEIGHT = 24;
    static final int QUEUE_CAPACITY = 28;
    static final int ELEVATION_MASK_DEG = 32;
    static final int SMALLEST_CN0_DBHZ = 40;
    static final int ELEVATION_A_M = 48;
    static final int ELEVATION_B_M = 56;
    static final int SEED = 64;
    static final int SCHEME = 72;
    static final int ESTIMATOR = 76;
  }

  /** lodemark_gnss_clock. */
  static final class GnssClock {
    private GnssClock() {}

    static final int SIZE = 80;
    static final int PRESENT = 4;
    static final int TIME_NS = 8;
    static final int FULL_BIAS_NS = 16;
    static final int ELAPSED_REALTIME_NS = 24;
    static final int BIAS_NS = 32;
    static final int BIAS_UNCERTAINTY_NS = 40;
    static final int DRIFT_NSPS = 48;
    static final int DRIFT_UNCERTAINTY_NSPS = 56;
    static final int TIME_UNCERTAINTY_NS = 64;
    static final int LEAP_SECOND = 72;
    static final int HARDWARE_CLOCK_DISCONTINUITY_COUNT = 76;
  }

  /** lodemark_gnss_measurement. */
  static final class GnssMeasurement {
    private GnssMeasurement() {}

    static final int SIZE = 160;
    static final int PRESENT = 4;
    static final int SVID = 8;
    static final int CONSTELLATION_TYPE = 12;
    static final int STATE = 16;
    static final int ACCUMULATED_DELTA_RANGE_STATE = 20;
    static final int MULTIPATH_INDICATOR = 24;
    static final int RECEIVED_SV_TIME_NS = 32;
    static final int RECEIVED_SV_TIME_UNCERTAINTY_NS = 40;
    static final int TIME_OFFSET_NS = 48;
    static final int CN0_DBHZ = 56;
    static final int BASEBAND_CN0_DBHZ = 64;
    static final int PSEUDORANGE_RATE_MPS = 72;
    static final int PSEUDORANGE_RATE_UNCERTAINTY_MPS = 80;
    static final int ACCUMULATED_DELTA_RANGE_M = 88;
    static final int ACCUMULATED_DELTA_RANGE_UNCERTAINTY_M = 96;
    static final int CARRIER_FREQUENCY_HZ = 104;
    static final int SNR_DB = 112;
    static final int AGC_DB = 120;
    static final int FULL_INTER_SIGNAL_BIAS_NS = 128;
    static final int SATELLITE_INTER_SIGNAL_BIAS_NS = 136;
    static final int GIVEN_PSEUDORANGE_M = 144;
    static final int CODE_TYPE = 152;
  }

  /** lodemark_read_report. */
  static final class ReadReport {
    private ReadReport() {}

    static final int SIZE = 288;
    static final int ROWS_READ = 8;
    static final int ROWS_SKIPPED = 16;
    static final int ROWS_UNKNOWN = 24;
    static final int FIRST_PROBLEM = 32;
  }

  /** lodemark_broadcast_message. */
  static final class BroadcastMessage {
    private BroadcastMessage() {}

    static final int SIZE = 24;
    static final int TYPE = 4;
    static final int SVID = 8;
    static final int MESSAGE_ID = 12;
    static final int SUBMESSAGE_ID = 16;
  }

  /** lodemark_frame. */
  static final class Frame {
    private Frame() {}

    static final int SIZE = 96;
    static final int PRESENT = 4;
    static final int TIME_NS = 8;
    static final int UP_IN_CAMERA = 16;
    static final int UP_SIGMA_DEG = 40;
    static final int HEADING_DEG = 48;
    static final int HEADING_SIGMA_DEG = 56;
    static final int CAMERA_FROM_DEVICE = 64;
  }

  /** lodemark_sensor_sample. */
  static final class SensorSample {
    private SensorSample() {}

    static final int SIZE = 40;
    static final int SENSOR = 4;
    static final int TIME_NS = 8;
    static final int VALUE = 16;
  }

  /** lodemark_lens. */
  static final class Lens {
    private Lens() {}

    static final int SIZE = 160;
    static final int MODEL = 4;
    static final int WIDTH_PX = 8;
    static final int HEIGHT_PX = 12;
    static final int FX_PX = 16;
    static final int FY_PX = 24;
    static final int CX_PX = 32;
    static final int CY_PX = 40;
    static final int COEFFICIENTS = 48;
  }

  /** lodemark_estimate. */
  static final class Estimate {
    private Estimate() {}

    static final int SIZE = 520;
    static final int PRESENT = 4;
    static final int OUTCOME = 8;
    static final int SOURCES = 12;
    static final int SATELLITES_USED = 16;
    static final int SATELLITES_SEEN = 20;
    static final int TIME_NS = 24;
    static final int TIME_GPS_NS = 32;
    static final int ECEF_M = 40;
    static final int LATITUDE_DEG = 64;
    static final int LONGITUDE_DEG = 72;
    static final int HEIGHT_M = 80;
    static final int COVARIANCE_ENU_M2 = 88;
    static final int ACCURACY_M = 160;
    static final int VERTICAL_ACCURACY_M = 168;
    static final int CLOCK_BIAS_M = 176;
    static final int PDOP = 184;
    static final int HDOP = 192;
    static final int VDOP = 200;
    static final int TDOP = 208;
    static final int VELOCITY_ENU_MPS = 216;
    static final int VELOCITY_COVARIANCE_ENU_M2PS2 = 240;
    static final int SPEED_ACCURACY_MPS = 312;
    static final int CLOCK_DRIFT_MPS = 320;
    static final int PROTECTION_LEVEL_M = 328;
    static final int VERTICAL_PROTECTION_LEVEL_M = 336;
    static final int CAMERA_FROM_ENU = 344;
    static final int PHOTO = 376;
    static final int LANDMARKS_USED = 380;
    static final int LANDMARKS_SEEN = 384;
    static final int SATELLITE_SIGMA_FACTOR = 392;
    static final int LANDMARK_SIGMA_FACTOR = 400;
    static final int DEVICE_FROM_ENU = 408;
    static final int ATTITUDE_COVARIANCE_ENU_DEG2 = 440;
    static final int HEADING_ACCURACY_DEG = 512;
  }

  /** lodemark_satellite. */
  static final class Satellite {
    private Satellite() {}

    static final int SIZE = 96;
    static final int PRESENT = 4;
    static final int SYSTEM = 8;
    static final int SATELLITE = 12;
    static final int VERDICT = 16;
    static final int SIGNAL = 24;
    static final int RESIDUAL_M = 32;
    static final int SIGMA_M = 40;
    static final int WEIGHT = 48;
    static final int ELEVATION_DEG = 56;
    static final int AZIMUTH_DEG = 64;
    static final int CN0_DBHZ = 72;
    static final int RANGE_RATE_RESIDUAL_MPS = 80;
    static final int SIGHT_PROBABILITY = 88;
  }

  /** lodemark_landmark. */
  static final class Landmark {
    private Landmark() {}

    static final int SIZE = 96;
    static final int PRESENT = 4;
    static final int LANDMARK_ID = 8;
    static final int VERDICT = 12;
    static final int PIXEL_PX = 16;
    static final int RESIDUAL_PX = 32;
    static final int WEIGHT = 48;
    static final int RANGE_M = 56;
    static final int RANGE_SIGMA_M = 64;
    static final int LANDMARK_IN_ECEF_M = 72;
  }

  /** lodemark_event. */
  static final class Event {
    private Event() {}

    static final int SIZE = 288;
    static final int KIND = 4;
    static final int TIME_NS = 8;
    static final int TIME_GPS_NS = 16;
    static final int VALUE = 24;
    static final int TEXT = 32;
  }

  /** lodemark_map_info. */
  static final class MapInfo {
    private MapInfo() {}

    static final int SIZE = 432;
    static final int DESCRIPTOR_KIND = 4;
    static final int LANDMARKS = 8;
    static final int DESCRIPTORS = 16;
    static final int IMAGES = 24;
    static final int BUILDING_PARTS = 32;
    static final int ORIGIN_GEODETIC = 40;
    static final int EPOCH_YEAR = 64;
    static final int ID = 72;
    static final int DATUM = 112;
    static final int PROVENANCE = 176;
  }

  /** lodemark_view_prior. */
  static final class ViewPrior {
    private ViewPrior() {}

    static final int SIZE = 200;
    static final int PRESENT = 4;
    static final int POSITION_IN_ECEF_M = 8;
    static final int POSITION_COVARIANCE_ENU_M2 = 32;
    static final int UP_IN_CAMERA = 104;
    static final int UP_SIGMA_DEG = 128;
    static final int HEADING_DEG = 136;
    static final int HEADING_SIGMA_DEG = 144;
    static final int CAMERA_FROM_ENU = 152;
    static final int SEARCH_RADIUS_PX = 184;
    static final int FARTHEST_M = 192;
  }

  /** lodemark_query_options. */
  static final class QueryOptions {
    private QueryOptions() {}

    static final int SIZE = 24;
    static final int MOST_FEATURES = 4;
    static final int LONGEST_SIDE_PX = 8;
    static final int LISTS_TO_VISIT = 12;
    static final int LARGEST_RATIO = 16;
  }

  /** lodemark_sight. */
  static final class Sight {
    private Sight() {}

    static final int SIZE = 144;
    static final int PRESENT = 4;
    static final int LANDMARK_ID = 8;
    static final int PIXEL_PX = 16;
    static final int SIGMA_PX = 32;
    static final int LANDMARK_IN_ECEF_M = 40;
    static final int LANDMARK_COVARIANCE_ENU_M2 = 64;
    static final int QUALITY = 136;
  }

  /** lodemark_sight_residual. */
  static final class SightResidual {
    private SightResidual() {}

    static final int SIZE = 40;
    static final int USED = 4;
    static final int RESIDUAL_PX = 8;
    static final int RANGE_M = 24;
    static final int RANGE_SIGMA_M = 32;
  }

  /** lodemark_pose. */
  static final class Pose {
    private Pose() {}

    static final int SIZE = 496;
    static final int VERDICT = 4;
    static final int INLIERS = 8;
    static final int SAMPLES = 12;
    static final int ECEF_M = 16;
    static final int LATITUDE_DEG = 40;
    static final int LONGITUDE_DEG = 48;
    static final int HEIGHT_M = 56;
    static final int CAMERA_FROM_ENU = 64;
    static final int HEADING_DEG = 96;
    static final int PITCH_DEG = 104;
    static final int ROLL_DEG = 112;
    static final int COVARIANCE = 120;
    static final int ACCURACY_M = 408;
    static final int VERTICAL_ACCURACY_M = 416;
    static final int NOISE_PX = 424;
    static final int LOG10_CHANCE = 432;
    static final int ALTERNATIVE_ECEF_M = 440;
    static final int ALTERNATIVE_CAMERA_FROM_ENU = 464;
  }

  /** lodemark_range. */
  static final class Range {
    private Range() {}

    static final int SIZE = 48;
    static final int CLOCK_GROUP = 4;
    static final int POINT_IN_ECEF_M = 8;
    static final int RANGE_M = 32;
    static final int SIGMA_M = 40;
  }

  /** lodemark_solve_options. */
  static final class SolveOptions {
    private SolveOptions() {}

    static final int SIZE = 32;
    static final int PRESENT = 4;
    static final int START_IN_ECEF_M = 8;
  }

  /** lodemark_solution. */
  static final class Solution {
    private Solution() {}

    static final int SIZE = 440;
    static final int OUTCOME = 4;
    static final int RANGES_USED = 8;
    static final int CLOCKS_PRESENT = 12;
    static final int ECEF_M = 16;
    static final int LATITUDE_DEG = 40;
    static final int LONGITUDE_DEG = 48;
    static final int HEIGHT_M = 56;
    static final int COVARIANCE_ENU_M2 = 64;
    static final int ACCURACY_M = 136;
    static final int VERTICAL_ACCURACY_M = 144;
    static final int PDOP = 152;
    static final int HDOP = 160;
    static final int VDOP = 168;
    static final int TDOP = 176;
    static final int CLOCK_M = 184;
    static final int CLOCK_SIGMA_M = 312;
  }

  /** lodemark_range_residual. */
  static final class RangeResidual {
    private RangeResidual() {}

    static final int SIZE = 24;
    static final int USED = 4;
    static final int RESIDUAL_M = 8;
    static final int WEIGHT = 16;
  }

  /** lodemark_resect_options. */
  static final class ResectOptions {
    private ResectOptions() {}

    static final int SIZE = 2624;
    static final int PRESENT = 4;
    static final int INLIER_THRESHOLD_PX = 8;
    static final int SEED = 16;
    static final int MOST_SAMPLES = 24;
    static final int INTRINSICS_COVARIANCE = 32;
  }
}
