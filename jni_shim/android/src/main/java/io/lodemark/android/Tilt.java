package io.lodemark.android;

/**
 * How the phone was held, from its game rotation vector: what of it is up, in the axes of a camera.
 * The rotation turns the phone's axes (x to the right and y up along the screen, z out of it) into
 * axes of which the third is up.
 */
final class Tilt {
  /** Standard deviation of the direction while the phone is carried. */
  static final double SIGMA_DEGREES = 3.0;

  /** A rotation further away in time says nothing of a photograph. */
  private static final long NEAR_NANOS = 50_000_000L;
  private static final int KEPT = 128;

  private final long[] times = new long[KEPT];
  private final float[] rotations = new float[4 * KEPT];
  private int next;
  private int count;

  /** x, y, z, w as SensorEvent.values of TYPE_GAME_ROTATION_VECTOR has them. */
  void add(long bootNanos, float x, float y, float z, float w) {
    times[next] = bootNanos;
    rotations[4 * next] = x;
    rotations[4 * next + 1] = y;
    rotations[4 * next + 2] = z;
    rotations[4 * next + 3] = w;
    next = (next + 1) % KEPT;
    count = Math.min(count + 1, KEPT);
  }

  /**
   * Null if the rotation is not known at that time.
   *
   * @param sensorOrientation degrees clockwise by which the photograph is turned to be upright
   * @param front whether the camera looks out of the screen
   */
  double[] upInCamera(long bootNanos, int sensorOrientation, boolean front) {
    int nearest = -1;
    for (int i = 0; i < count; ++i) {
      if (nearest < 0 || distance(i, bootNanos) < distance(nearest, bootNanos))
        nearest = i;
    }
    if (nearest < 0 || distance(nearest, bootNanos) > NEAR_NANOS)
      return null;
    double x = rotations[4 * nearest];
    double y = rotations[4 * nearest + 1];
    double z = rotations[4 * nearest + 2];
    double w = rotations[4 * nearest + 3];
    // The third row of the rotation matrix.
    double upX = 2 * (x * z - w * y);
    double upY = 2 * (y * z + w * x);
    double upZ = 1 - 2 * (x * x + y * y);
    // The camera's right and down, were the sensor not turned in the phone.
    double right = front ? -upX : upX;
    double down = -upY;
    double turn = Math.toRadians(sensorOrientation);
    return new double[] {Math.cos(turn) * right + Math.sin(turn) * down,
        -Math.sin(turn) * right + Math.cos(turn) * down, front ? upZ : -upZ};
  }

  private long distance(int i, long bootNanos) {
    return Math.abs(times[i] - bootNanos);
  }
}
