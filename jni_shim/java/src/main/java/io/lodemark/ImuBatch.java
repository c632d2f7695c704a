package io.lodemark;

import java.nio.ByteBuffer;

/**
 * What inertial sensors, a barometer or a vehicle measured, sample by sample. A batch is meant to
 * be kept and filled again: it lies in a direct buffer that the library reads in place, and filling
 * it allocates nothing once it had that many samples.
 *
 * <p>Both inertial sensors share their axes, which are those of the phone: Android's. Its
 * calibrated sensors will do, or the uncalibrated ones less the bias that is stated beside them.
 */
public final class ImuBatch {
  /** As many as one push takes. */
  public static final int LARGEST_SIZE = Values.LARGEST_COUNT;

  private ByteBuffer rows = Struct.array(Layout.SensorSample.SIZE, 64);
  private int count;

  /** Without any sample. */
  public ImuBatch() {}

  /**
   * Forgets all samples, and keeps the memory.
   *
   * @return this
   */
  public ImuBatch clear() {
    count = 0;
    return this;
  }

  /**
   * How many samples it has.
   *
   * @return their number, at most {@link #LARGEST_SIZE}
   */
  public int size() {
    return count;
  }

  /**
   * A specific force in m/s2, as Android's TYPE_ACCELEROMETER gives it: at rest 9.8
   * upwards.
   *
   * @param timeNanos in the session's base
   * @param x to the right of the screen
   * @param y up along the screen
   * @param z out of the screen
   * @return this
   */
  public ImuBatch addAccelerometer(long timeNanos, double x, double y, double z) {
    return add(Values.SENSOR_ACCELEROMETER, timeNanos, x, y, z);
  }

  /**
   * A turn rate in rad/s, as Android's TYPE_GYROSCOPE gives it.
   *
   * @param timeNanos in the session's base
   * @param x about the axis to the right of the screen, right-handed
   * @param y about the axis up along the screen
   * @param z about the axis out of the screen
   * @return this
   */
  public ImuBatch addGyroscope(long timeNanos, double x, double y, double z) {
    return add(Values.SENSOR_GYROSCOPE, timeNanos, x, y, z);
  }

  /**
   * A pressure, as Android's TYPE_PRESSURE gives it.
   *
   * @param timeNanos in the session's base
   * @param hectopascals the pressure
   * @return this
   */
  public ImuBatch addBarometer(long timeNanos, double hectopascals) {
    return add(Values.SENSOR_BAROMETER, timeNanos, hectopascals, 0, 0);
  }

  /**
   * What a vehicle measures of itself.
   *
   * @param timeNanos in the session's base
   * @param metersPerSecond forwards
   * @param yawRate in rad/s, to the left
   * @return this
   */
  public ImuBatch addVehicle(long timeNanos, double metersPerSecond, double yawRate) {
    return add(Values.SENSOR_VEHICLE, timeNanos, metersPerSecond, yawRate, 0);
  }

  ByteBuffer rows() {
    return rows;
  }

  private ImuBatch add(int sensor, long timeNanos, double x, double y, double z) {
    if (count == LARGEST_SIZE)
      throw new IllegalStateException("a batch has at most " + count + " samples");
    int size = Layout.SensorSample.SIZE;
    if ((count + 1) * size > rows.capacity())
      grow();
    int at = count * size;
    rows.putInt(at + Layout.SensorSample.SENSOR, sensor);
    rows.putLong(at + Layout.SensorSample.TIME_NS, timeNanos);
    rows.putDouble(at + Layout.SensorSample.VALUE, x);
    rows.putDouble(at + Layout.SensorSample.VALUE + 8, y);
    rows.putDouble(at + Layout.SensorSample.VALUE + 16, z);
    ++count;
    return this;
  }

  private void grow() {
    int size = Layout.SensorSample.SIZE;
    ByteBuffer larger = Struct.array(size, Math.min(2 * count, LARGEST_SIZE));
    ByteBuffer from = rows.duplicate();
    from.position(0).limit(count * size);
    larger.duplicate().put(from);
    rows = larger;
  }
}
