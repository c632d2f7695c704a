package io.lodemark;

import java.nio.ByteBuffer;
import java.util.ArrayList;
import java.util.List;

/**
 * One GnssMeasurementsEvent: a GnssClock and its measurements, copied value by value. What is not
 * set is taken as not known. An epoch is meant to be kept and filled again: it lies in direct
 * buffers that the library reads in place, and filling it allocates nothing once it had that many
 * measurements.
 *
 * <pre>{@code
 * epoch.clear().setTimeNanos(clock.getTimeNanos()).setFullBiasNanos(clock.getFullBiasNanos());
 * for (android.location.GnssMeasurement m : event.getMeasurements()) {
 *   epoch.add().setSvid(m.getSvid()).setConstellationType(m.getConstellationType());
 * }
 * session.pushGnss(elapsedRealtimeNanos, epoch);
 * }</pre>
 */
public final class GnssEpoch {
  private static final byte[] ZEROS = new byte[Layout.GnssMeasurement.SIZE];

  private final ByteBuffer clock = Struct.of(Layout.GnssClock.SIZE);
  private final List<GnssMeasurement> views = new ArrayList<>();
  private ByteBuffer rows = Struct.array(Layout.GnssMeasurement.SIZE, 64);
  private int count;

  /** Without any value. */
  public GnssEpoch() {}

  /**
   * Forgets all values, and keeps the memory.
   *
   * @return this
   */
  public GnssEpoch clear() {
    for (int at = 4; at < Layout.GnssClock.SIZE; at += 4) clock.putInt(at, 0);
    count = 0;
    return this;
  }

  /**
   * A further measurement, without any value. The object is used again after {@link #clear}.
   *
   * @return the measurement, to be filled
   */
  public GnssMeasurement add() {
    if (count == Values.LARGEST_COUNT) {
      throw new IllegalStateException("an epoch has at most " + count + " measurements");
    }
    int size = Layout.GnssMeasurement.SIZE;
    if ((count + 1) * size > rows.capacity())
      grow();
    ByteBuffer row = rows.duplicate();
    row.position(count * size + 4);
    row.put(ZEROS, 0, size - 4);
    if (views.size() == count)
      views.add(new GnssMeasurement(this, count * size));
    return views.get(count++);
  }

  /**
   * How many measurements it has.
   *
   * @return the number of calls of {@link #add} since the last {@link #clear}
   */
  public int size() {
    return count;
  }

  /**
   * Android's getTimeNanos.
   *
   * @param timeNanos the receiver's hardware clock
   * @return this
   */
  public GnssEpoch setTimeNanos(long timeNanos) {
    clock.putLong(Layout.GnssClock.TIME_NS, timeNanos);
    return this;
  }

  /**
   * Android's getFullBiasNanos.
   *
   * @param fullBiasNanos hardware clock minus GPS time, whole part
   * @return this
   */
  public GnssEpoch setFullBiasNanos(long fullBiasNanos) {
    clock.putLong(Layout.GnssClock.FULL_BIAS_NS, fullBiasNanos);
    has(Values.CLOCK_HAS_FULL_BIAS);
    return this;
  }

  /**
   * Android's getBiasNanos.
   *
   * @param biasNanos the same, fraction
   * @return this
   */
  public GnssEpoch setBiasNanos(double biasNanos) {
    clock.putDouble(Layout.GnssClock.BIAS_NS, biasNanos);
    has(Values.CLOCK_HAS_BIAS);
    return this;
  }

  /**
   * Android's getBiasUncertaintyNanos.
   *
   * @param biasUncertaintyNanos one standard deviation
   * @return this
   */
  public GnssEpoch setBiasUncertaintyNanos(double biasUncertaintyNanos) {
    clock.putDouble(Layout.GnssClock.BIAS_UNCERTAINTY_NS, biasUncertaintyNanos);
    has(Values.CLOCK_HAS_BIAS_UNCERTAINTY);
    return this;
  }

  /**
   * Android's getDriftNanosPerSecond.
   *
   * @param driftNanosPerSecond of the hardware clock
   * @return this
   */
  public GnssEpoch setDriftNanosPerSecond(double driftNanosPerSecond) {
    clock.putDouble(Layout.GnssClock.DRIFT_NSPS, driftNanosPerSecond);
    has(Values.CLOCK_HAS_DRIFT);
    return this;
  }

  /**
   * Android's getDriftUncertaintyNanosPerSecond.
   *
   * @param driftUncertaintyNanosPerSecond one standard deviation
   * @return this
   */
  public GnssEpoch setDriftUncertaintyNanosPerSecond(double driftUncertaintyNanosPerSecond) {
    clock.putDouble(Layout.GnssClock.DRIFT_UNCERTAINTY_NSPS, driftUncertaintyNanosPerSecond);
    has(Values.CLOCK_HAS_DRIFT_UNCERTAINTY);
    return this;
  }

  /**
   * Android's getTimeUncertaintyNanos.
   *
   * @param timeUncertaintyNanos one standard deviation
   * @return this
   */
  public GnssEpoch setTimeUncertaintyNanos(double timeUncertaintyNanos) {
    clock.putDouble(Layout.GnssClock.TIME_UNCERTAINTY_NS, timeUncertaintyNanos);
    has(Values.CLOCK_HAS_TIME_UNCERTAINTY);
    return this;
  }

  /**
   * Android's getLeapSecond.
   *
   * @param leapSecond GPS time minus UTC, in seconds
   * @return this
   */
  public GnssEpoch setLeapSecond(int leapSecond) {
    clock.putInt(Layout.GnssClock.LEAP_SECOND, leapSecond);
    has(Values.CLOCK_HAS_LEAP_SECOND);
    return this;
  }

  /**
   * Android's getElapsedRealtimeNanos.
   *
   * @param elapsedRealtimeNanos time since boot
   * @return this
   */
  public GnssEpoch setElapsedRealtimeNanos(long elapsedRealtimeNanos) {
    clock.putLong(Layout.GnssClock.ELAPSED_REALTIME_NS, elapsedRealtimeNanos);
    has(Values.CLOCK_HAS_ELAPSED_REALTIME);
    return this;
  }

  /**
   * Android's getHardwareClockDiscontinuityCount.
   *
   * @param hardwareClockDiscontinuityCount grows when the clock jumps
   * @return this
   */
  public GnssEpoch setHardwareClockDiscontinuityCount(int hardwareClockDiscontinuityCount) {
    clock.putInt(
        Layout.GnssClock.HARDWARE_CLOCK_DISCONTINUITY_COUNT, hardwareClockDiscontinuityCount);
    return this;
  }

  ByteBuffer clock() {
    return clock;
  }

  ByteBuffer rows() {
    return rows;
  }

  private void has(int bit) {
    Struct.setBit(clock, Layout.GnssClock.PRESENT, bit);
  }

  private void grow() {
    int size = Layout.GnssMeasurement.SIZE;
    ByteBuffer larger = Struct.array(size, Math.min(2 * count, Values.LARGEST_COUNT));
    ByteBuffer from = rows.duplicate();
    from.position(0).limit(count * size);
    larger.duplicate().put(from);
    rows = larger;
  }
}
