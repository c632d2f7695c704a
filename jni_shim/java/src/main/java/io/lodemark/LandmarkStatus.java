package io.lodemark;

import java.nio.ByteBuffer;

/** One landmark in the photograph that the estimate looked at. */
public final class LandmarkStatus {
  private final long landmarkId;
  private final Verdict verdict;
  private final double[] pixel;
  private final boolean hasResidual;
  private final double[] residualPixels;
  private final double weight;
  private final double rangeMeters;
  private final double rangeSigmaMeters;
  private final double[] ecefMeters;

  LandmarkStatus(ByteBuffer struct, int at) {
    landmarkId = Integer.toUnsignedLong(struct.getInt(at + Layout.Landmark.LANDMARK_ID));
    verdict = Enums.at(Verdict.values(), struct.getInt(at + Layout.Landmark.VERDICT));
    pixel = Struct.doubles(struct, at + Layout.Landmark.PIXEL_PX, 2);
    hasResidual = Struct.hasBit(struct, at + Layout.Landmark.PRESENT, Values.LANDMARK_HAS_RESIDUAL);
    residualPixels = Struct.doubles(struct, at + Layout.Landmark.RESIDUAL_PX, 2);
    weight = struct.getDouble(at + Layout.Landmark.WEIGHT);
    rangeMeters = struct.getDouble(at + Layout.Landmark.RANGE_M);
    rangeSigmaMeters = struct.getDouble(at + Layout.Landmark.RANGE_SIGMA_M);
    ecefMeters = Struct.doubles(struct, at + Layout.Landmark.LANDMARK_IN_ECEF_M, 3);
  }

  /**
   * Its number in the map.
   *
   * @return the number
   */
  public long getLandmarkId() {
    return landmarkId;
  }

  /**
   * Whether it was used, or why not.
   *
   * @return the verdict
   */
  public Verdict getVerdict() {
    return verdict;
  }

  /**
   * Where the photograph shows it.
   *
   * @return x, y
   */
  public double[] getPixel() {
    return pixel.clone();
  }

  /**
   * Whether residual and range count.
   *
   * @return true if they do
   */
  public boolean hasResidual() {
    return hasResidual;
  }

  /**
   * Seen minus predicted from the estimate.
   *
   * @return x, y
   */
  public double[] getResidualPixels() {
    return residualPixels.clone();
  }

  /**
   * Share of its full weight that it kept, 0 to 1.
   *
   * @return the share
   */
  public double getWeight() {
    return weight;
  }

  /**
   * Its distance from the estimate.
   *
   * @return metres
   */
  public double getRangeMeters() {
    return rangeMeters;
  }

  /**
   * Standard deviation of the distance.
   *
   * @return metres
   */
  public double getRangeSigmaMeters() {
    return rangeSigmaMeters;
  }

  /**
   * Its place, earth-centred and earth-fixed.
   *
   * @return x, y, z
   */
  public double[] getEcefMeters() {
    return ecefMeters.clone();
  }
}
