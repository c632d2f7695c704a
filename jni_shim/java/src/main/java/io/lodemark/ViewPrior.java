package io.lodemark;

import java.nio.ByteBuffer;

/** What is known of a camera before its photograph is looked at. All of it optional. */
public final class ViewPrior {
  private final ByteBuffer struct = Struct.of(Layout.ViewPrior.SIZE);

  /** Nothing. */
  public ViewPrior() {}

  /**
   * Where it is, as from satellites.
   *
   * @param ecefMeters x, y, z
   * @param covarianceEnu of the place in east, north, up by rows: nine values in square metres
   * @return this
   */
  public ViewPrior setPosition(double[] ecefMeters, double[] covarianceEnu) {
    Struct.putDoubles(
        struct, Layout.ViewPrior.POSITION_IN_ECEF_M, Struct.checked(ecefMeters, 3, "ecefMeters"));
    Struct.putDoubles(struct, Layout.ViewPrior.POSITION_COVARIANCE_ENU_M2,
        Struct.checked(covarianceEnu, 9, "covarianceEnu"));
    return has(Values.VIEW_HAS_POSITION);
  }

  /**
   * How it is held.
   *
   * @param upInCamera what an accelerometer at rest measures, in camera axes, of any length
   * @param sigmaDegrees standard deviation of this direction
   * @return this
   */
  public ViewPrior setGravity(double[] upInCamera, double sigmaDegrees) {
    Struct.putDoubles(
        struct, Layout.ViewPrior.UP_IN_CAMERA, Struct.checked(upInCamera, 3, "upInCamera"));
    struct.putDouble(Layout.ViewPrior.UP_SIGMA_DEG, sigmaDegrees);
    return has(Values.VIEW_HAS_GRAVITY);
  }

  /**
   * Where it looks; needs a position.
   *
   * @param headingDegrees of the optical axis, clockwise from north
   * @param sigmaDegrees standard deviation of the heading
   * @return this
   */
  public ViewPrior setHeading(double headingDegrees, double sigmaDegrees) {
    struct.putDouble(Layout.ViewPrior.HEADING_DEG, headingDegrees);
    struct.putDouble(Layout.ViewPrior.HEADING_SIGMA_DEG, sigmaDegrees);
    return has(Values.VIEW_HAS_HEADING);
  }

  ByteBuffer struct() {
    return struct;
  }

  private ViewPrior has(int bit) {
    Struct.setBit(struct, Layout.ViewPrior.PRESENT, bit);
    return this;
  }
}
