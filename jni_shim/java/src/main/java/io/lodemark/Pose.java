package io.lodemark;

import java.nio.ByteBuffer;

/** Where a camera was and where it looked. Numbers are 0 where there is no pose. */
public final class Pose {
  private final PoseVerdict verdict;
  private final int inliers;
  private final double[] ecefMeters;
  private final double latitudeDegrees;
  private final double longitudeDegrees;
  private final double heightMeters;
  private final double[] cameraFromEnu;
  private final double headingDegrees;
  private final double pitchDegrees;
  private final double rollDegrees;
  private final double[] covariance;
  private final double accuracyMeters;
  private final double verticalAccuracyMeters;
  private final double noisePixels;

  Pose(ByteBuffer struct, int at) {
    verdict = Enums.at(PoseVerdict.values(), struct.getInt(at + Layout.Pose.VERDICT));
    inliers = struct.getInt(at + Layout.Pose.INLIERS);
    ecefMeters = Struct.doubles(struct, at + Layout.Pose.ECEF_M, 3);
    latitudeDegrees = struct.getDouble(at + Layout.Pose.LATITUDE_DEG);
    longitudeDegrees = struct.getDouble(at + Layout.Pose.LONGITUDE_DEG);
    heightMeters = struct.getDouble(at + Layout.Pose.HEIGHT_M);
    cameraFromEnu = Struct.doubles(struct, at + Layout.Pose.CAMERA_FROM_ENU, 4);
    headingDegrees = struct.getDouble(at + Layout.Pose.HEADING_DEG);
    pitchDegrees = struct.getDouble(at + Layout.Pose.PITCH_DEG);
    rollDegrees = struct.getDouble(at + Layout.Pose.ROLL_DEG);
    covariance = Struct.doubles(struct, at + Layout.Pose.COVARIANCE, 36);
    accuracyMeters = struct.getDouble(at + Layout.Pose.ACCURACY_M);
    verticalAccuracyMeters = struct.getDouble(at + Layout.Pose.VERTICAL_ACCURACY_M);
    noisePixels = struct.getDouble(at + Layout.Pose.NOISE_PX);
  }

  /**
   * What became of the resection.
   *
   * @return the verdict
   */
  public PoseVerdict getVerdict() {
    return verdict;
  }

  /**
   * Sights that agree with it.
   *
   * @return their number
   */
  public int getInliers() {
    return inliers;
  }

  /**
   * Its place, earth-centred and earth-fixed.
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
   * Height above the ellipsoid.
   *
   * @return metres
   */
  public double getHeightMeters() {
    return heightMeters;
  }

  /**
   * Orientation: east, north, up at its place to camera axes.
   *
   * @return a quaternion w, x, y, z
   */
  public double[] getCameraFromEnu() {
    return cameraFromEnu.clone();
  }

  /**
   * Of the optical axis, clockwise from north.
   *
   * @return degrees
   */
  public double getHeadingDegrees() {
    return headingDegrees;
  }

  /**
   * Of the optical axis, above the horizon.
   *
   * @return degrees
   */
  public double getPitchDegrees() {
    return pitchDegrees;
  }

  /**
   * About the optical axis, clockwise as seen from behind.
   *
   * @return degrees
   */
  public double getRollDegrees() {
    return rollDegrees;
  }

  /**
   * Covariance by rows: east, north, up in square metres, then rotations of the camera about them
   * in square degrees.
   *
   * @return 36 values
   */
  public double[] getCovariance() {
    return covariance.clone();
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
   * Standard deviation of a sight, estimated.
   *
   * @return pixels
   */
  public double getNoisePixels() {
    return noisePixels;
  }

  /**
   * Whether there is a pose to use.
   *
   * @return true of {@link PoseVerdict#GOOD} and {@link PoseVerdict#WEAK}
   */
  public boolean hasPosition() {
    return verdict == PoseVerdict.GOOD || verdict == PoseVerdict.WEAK;
  }
}
