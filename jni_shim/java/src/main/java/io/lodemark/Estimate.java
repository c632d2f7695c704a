package io.lodemark;

import java.nio.ByteBuffer;
import java.util.Locale;

/** Where the phone was at the epoch or photograph that was processed last. */
public final class Estimate {
  private final Outcome outcome;
  private final boolean hasPosition;
  private final boolean hasVelocity;
  private final boolean hasGpsTime;
  private final boolean hasProtectionLevel;
  private final boolean hasVerticalProtectionLevel;
  private final boolean hasSatelliteSigmaFactor;
  private final boolean hasLandmarkSigmaFactor;
  private final boolean hasOrientation;
  private final boolean hasAttitude;
  private final boolean fromSatellites;
  private final boolean fromLandmarks;
  private final boolean fromInertialSensors;
  private final int satellitesUsed;
  private final int satellitesSeen;
  private final long timeNanos;
  private final long timeGpsNanos;
  private final double[] ecefMeters;
  private final double latitudeDegrees;
  private final double longitudeDegrees;
  private final double heightMeters;
  private final double[] covarianceEnu;
  private final double accuracyMeters;
  private final double verticalAccuracyMeters;
  private final double clockBiasMeters;
  private final double pdop;
  private final double hdop;
  private final double vdop;
  private final double tdop;
  private final double[] velocityEnu;
  private final double[] velocityCovarianceEnu;
  private final double speedAccuracyMetersPerSecond;
  private final double clockDriftMetersPerSecond;
  private final double protectionLevelMeters;
  private final double verticalProtectionLevelMeters;
  private final double satelliteSigmaFactor;
  private final double landmarkSigmaFactor;
  private final double[] cameraFromEnu;
  private final double[] deviceFromEnu;
  private final double[] attitudeCovarianceEnu;
  private final double headingAccuracyDegrees;
  private final PhotoOutcome photo;
  private final int landmarksUsed;
  private final int landmarksSeen;

  Estimate(ByteBuffer struct, int at) {
    outcome = Enums.at(Outcome.values(), struct.getInt(at + Layout.Estimate.OUTCOME));
    hasPosition = Struct.hasBit(struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_POSITION);
    hasVelocity = Struct.hasBit(struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_VELOCITY);
    hasGpsTime = Struct.hasBit(struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_GPS_TIME);
    hasProtectionLevel =
        Struct.hasBit(struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_PROTECTION_LEVEL);
    hasVerticalProtectionLevel = Struct.hasBit(
        struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_VERTICAL_PROTECTION_LEVEL);
    hasSatelliteSigmaFactor = Struct.hasBit(
        struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_SATELLITE_SIGMA_FACTOR);
    hasLandmarkSigmaFactor = Struct.hasBit(
        struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_LANDMARK_SIGMA_FACTOR);
    hasOrientation =
        Struct.hasBit(struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_ORIENTATION);
    hasAttitude = Struct.hasBit(struct, at + Layout.Estimate.PRESENT, Values.ESTIMATE_HAS_ATTITUDE);
    fromSatellites = Struct.hasBit(struct, at + Layout.Estimate.SOURCES, Values.SOURCE_GNSS);
    fromLandmarks = Struct.hasBit(struct, at + Layout.Estimate.SOURCES, Values.SOURCE_VISION);
    fromInertialSensors =
        Struct.hasBit(struct, at + Layout.Estimate.SOURCES, Values.SOURCE_INERTIAL);
    satellitesUsed = struct.getInt(at + Layout.Estimate.SATELLITES_USED);
    satellitesSeen = struct.getInt(at + Layout.Estimate.SATELLITES_SEEN);
    timeNanos = struct.getLong(at + Layout.Estimate.TIME_NS);
    timeGpsNanos = struct.getLong(at + Layout.Estimate.TIME_GPS_NS);
    ecefMeters = Struct.doubles(struct, at + Layout.Estimate.ECEF_M, 3);
    latitudeDegrees = struct.getDouble(at + Layout.Estimate.LATITUDE_DEG);
    longitudeDegrees = struct.getDouble(at + Layout.Estimate.LONGITUDE_DEG);
    heightMeters = struct.getDouble(at + Layout.Estimate.HEIGHT_M);
    covarianceEnu = Struct.doubles(struct, at + Layout.Estimate.COVARIANCE_ENU_M2, 9);
    accuracyMeters = struct.getDouble(at + Layout.Estimate.ACCURACY_M);
    verticalAccuracyMeters = struct.getDouble(at + Layout.Estimate.VERTICAL_ACCURACY_M);
    clockBiasMeters = struct.getDouble(at + Layout.Estimate.CLOCK_BIAS_M);
    pdop = struct.getDouble(at + Layout.Estimate.PDOP);
    hdop = struct.getDouble(at + Layout.Estimate.HDOP);
    vdop = struct.getDouble(at + Layout.Estimate.VDOP);
    tdop = struct.getDouble(at + Layout.Estimate.TDOP);
    velocityEnu = Struct.doubles(struct, at + Layout.Estimate.VELOCITY_ENU_MPS, 3);
    velocityCovarianceEnu =
        Struct.doubles(struct, at + Layout.Estimate.VELOCITY_COVARIANCE_ENU_M2PS2, 9);
    speedAccuracyMetersPerSecond = struct.getDouble(at + Layout.Estimate.SPEED_ACCURACY_MPS);
    clockDriftMetersPerSecond = struct.getDouble(at + Layout.Estimate.CLOCK_DRIFT_MPS);
    protectionLevelMeters = struct.getDouble(at + Layout.Estimate.PROTECTION_LEVEL_M);
    verticalProtectionLevelMeters =
        struct.getDouble(at + Layout.Estimate.VERTICAL_PROTECTION_LEVEL_M);
    satelliteSigmaFactor = struct.getDouble(at + Layout.Estimate.SATELLITE_SIGMA_FACTOR);
    landmarkSigmaFactor = struct.getDouble(at + Layout.Estimate.LANDMARK_SIGMA_FACTOR);
    cameraFromEnu = Struct.doubles(struct, at + Layout.Estimate.CAMERA_FROM_ENU, 4);
    deviceFromEnu = Struct.doubles(struct, at + Layout.Estimate.DEVICE_FROM_ENU, 4);
    attitudeCovarianceEnu =
        Struct.doubles(struct, at + Layout.Estimate.ATTITUDE_COVARIANCE_ENU_DEG2, 9);
    headingAccuracyDegrees = struct.getDouble(at + Layout.Estimate.HEADING_ACCURACY_DEG);
    photo = Enums.at(PhotoOutcome.values(), struct.getInt(at + Layout.Estimate.PHOTO));
    landmarksUsed = struct.getInt(at + Layout.Estimate.LANDMARKS_USED);
    landmarksSeen = struct.getInt(at + Layout.Estimate.LANDMARKS_SEEN);
  }

  /**
   * Why there is a position, or why not.
   *
   * @return the outcome
   */
  public Outcome getOutcome() {
    return outcome;
  }

  /**
   * Whether place, covariance, accuracies, clock bias and dilutions count; they are 0 otherwise.
   *
   * @return true if there is a position
   */
  public boolean hasPosition() {
    return hasPosition;
  }

  /**
   * Whether the velocity counts; it is 0 otherwise.
   *
   * @return true if there is a velocity
   */
  public boolean hasVelocity() {
    return hasVelocity;
  }

  /**
   * Whether the GPS time is known.
   *
   * @return true if it is known
   */
  public boolean hasGpsTime() {
    return hasGpsTime;
  }

  /**
   * Whether the horizontal protection level counts: not where nothing is redundant.
   *
   * @return true if it counts
   */
  public boolean hasProtectionLevel() {
    return hasProtectionLevel;
  }

  /**
   * Whether the vertical protection level counts.
   *
   * @return true if it counts
   */
  public boolean hasVerticalProtectionLevel() {
    return hasVerticalProtectionLevel;
  }

  /**
   * Whether the factor of satellites counts: where variance components were asked for.
   *
   * @return true if it counts
   */
  public boolean hasSatelliteSigmaFactor() {
    return hasSatelliteSigmaFactor;
  }

  /**
   * Whether the factor of landmarks counts.
   *
   * @return true if it counts
   */
  public boolean hasLandmarkSigmaFactor() {
    return hasLandmarkSigmaFactor;
  }

  /**
   * Whether the orientation of the camera counts.
   *
   * @return true if it counts
   */
  public boolean hasOrientation() {
    return hasOrientation;
  }

  /**
   * Whether the attitude of the phone counts: where its inertial sensors carry the filter.
   *
   * @return true if it counts
   */
  public boolean hasAttitude() {
    return hasAttitude;
  }

  /**
   * Whether the position rests on satellites.
   *
   * @return true if it does
   */
  public boolean isFromSatellites() {
    return fromSatellites;
  }

  /**
   * Whether the position rests on landmarks.
   *
   * @return true if it does
   */
  public boolean isFromLandmarks() {
    return fromLandmarks;
  }

  /**
   * Whether inertial sensors carried the filter here.
   *
   * @return true if they did
   */
  public boolean isFromInertialSensors() {
    return fromInertialSensors;
  }

  /**
   * Distinct satellites used, however many signals.
   *
   * @return their number
   */
  public int getSatellitesUsed() {
    return satellitesUsed;
  }

  /**
   * Distinct satellites of the epoch.
   *
   * @return their number
   */
  public int getSatellitesSeen() {
    return satellitesSeen;
  }

  /**
   * The time of the estimate in the session's base.
   *
   * @return nanoseconds
   */
  public long getTimeNanos() {
    return timeNanos;
  }

  /**
   * GPS time since 1980-01-06 without leap seconds.
   *
   * @return nanoseconds
   */
  public long getTimeGpsNanos() {
    return timeGpsNanos;
  }

  /**
   * The place, earth-centred and earth-fixed.
   *
   * @return x, y, z
   */
  public double[] getEcefMeters() {
    return ecefMeters.clone();
  }

  /**
   * WGS 84 latitude.
   *
   * @return degrees
   */
  public double getLatitudeDegrees() {
    return latitudeDegrees;
  }

  /**
   * WGS 84 longitude.
   *
   * @return degrees
   */
  public double getLongitudeDegrees() {
    return longitudeDegrees;
  }

  /**
   * Height above the ellipsoid, not above the sea.
   *
   * @return metres
   */
  public double getHeightMeters() {
    return heightMeters;
  }

  /**
   * Covariance of the place in east, north, up, by rows.
   *
   * @return nine values in square metres
   */
  public double[] getCovarianceEnu() {
    return covarianceEnu.clone();
  }

  /**
   * The horizontal distance that holds the truth 68 % of the time.
   *
   * @return metres
   */
  public double getAccuracyMeters() {
    return accuracyMeters;
  }

  /**
   * The half-width of heights that holds the truth 68 % of the time.
   *
   * @return metres
   */
  public double getVerticalAccuracyMeters() {
    return verticalAccuracyMeters;
  }

  /**
   * Receiver clock minus GPS time, times the speed of light.
   *
   * @return metres
   */
  public double getClockBiasMeters() {
    return clockBiasMeters;
  }

  /**
   * Dilution of precision of the position.
   *
   * @return the factor
   */
  public double getPdop() {
    return pdop;
  }

  /**
   * Dilution of precision of the horizontal position.
   *
   * @return the factor
   */
  public double getHdop() {
    return hdop;
  }

  /**
   * Dilution of precision of the height.
   *
   * @return the factor
   */
  public double getVdop() {
    return vdop;
  }

  /**
   * Dilution of precision of the time.
   *
   * @return the factor
   */
  public double getTdop() {
    return tdop;
  }

  /**
   * Velocity to the east, north and up.
   *
   * @return metres per second
   */
  public double[] getVelocityEnu() {
    return velocityEnu.clone();
  }

  /**
   * Its covariance, by rows.
   *
   * @return nine values
   */
  public double[] getVelocityCovarianceEnu() {
    return velocityCovarianceEnu.clone();
  }

  /**
   * The accuracy of the horizontal velocity.
   *
   * @return metres per second
   */
  public double getSpeedAccuracyMetersPerSecond() {
    return speedAccuracyMetersPerSecond;
  }

  /**
   * How fast the clock bias grows.
   *
   * @return metres per second
   */
  public double getClockDriftMetersPerSecond() {
    return clockDriftMetersPerSecond;
  }

  /**
   * The horizontal protection level.
   *
   * @return metres
   */
  public double getProtectionLevelMeters() {
    return protectionLevelMeters;
  }

  /**
   * The vertical protection level.
   *
   * @return metres
   */
  public double getVerticalProtectionLevelMeters() {
    return verticalProtectionLevelMeters;
  }

  /**
   * How many times larger than stated the errors of satellites were taken for.
   *
   * @return the factor
   */
  public double getSatelliteSigmaFactor() {
    return satelliteSigmaFactor;
  }

  /**
   * How many times larger than stated the errors of landmarks were taken for.
   *
   * @return the factor
   */
  public double getLandmarkSigmaFactor() {
    return landmarkSigmaFactor;
  }

  /**
   * Orientation of the camera when its photograph was taken.
   *
   * @return a quaternion w, x, y, z
   */
  public double[] getCameraFromEnu() {
    return cameraFromEnu.clone();
  }

  /**
   * How the phone is turned: from east, north, up into the axes of its accelerometer.
   *
   * @return a quaternion w, x, y, z
   */
  public double[] getDeviceFromEnu() {
    return deviceFromEnu.clone();
  }

  /**
   * Covariance of small turns of the phone about east, north and up, by rows.
   *
   * @return nine values in square degrees
   */
  public double[] getAttitudeCovarianceEnu() {
    return attitudeCovarianceEnu.clone();
  }

  /**
   * The half-width about up that holds the true turn 68 % of the time.
   *
   * @return degrees
   */
  public double getHeadingAccuracyDegrees() {
    return headingAccuracyDegrees;
  }

  /**
   * What the latest photograph gave.
   *
   * @return the outcome
   */
  public PhotoOutcome getPhoto() {
    return photo;
  }

  /**
   * Landmarks of the photograph that were used.
   *
   * @return their number
   */
  public int getLandmarksUsed() {
    return landmarksUsed;
  }

  /**
   * Landmarks that the photograph seemed to show.
   *
   * @return their number
   */
  public int getLandmarksSeen() {
    return landmarksSeen;
  }

  /**
   * For people: such as "48.2000000, 16.3700000, 180.0 m, within 3.1 m".
   *
   * @return a line; its form may change
   */
  @Override
  public String toString() {
    if (!hasPosition)
      return "no position: " + outcome;
    return String.format(Locale.ROOT, "%.7f, %.7f, %.1f m, within %.1f m", latitudeDegrees,
        longitudeDegrees, heightMeters, accuracyMeters);
  }
}
