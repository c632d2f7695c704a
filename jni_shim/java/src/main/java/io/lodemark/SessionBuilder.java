package io.lodemark;

import java.nio.ByteBuffer;

/** The options of a {@link PositioningSession}. All of them may be left as they are. */
public final class SessionBuilder {
  private final ByteBuffer options = Struct.of(Layout.SessionOptions.SIZE);

  SessionBuilder() {}

  /**
   * Which clock its times are of; GPS if not set.
   *
   * @param timeBase the clock
   * @return this
   */
  public SessionBuilder timeBase(TimeBase timeBase) {
    return put(Layout.SessionOptions.TIME_BASE, timeBase.ordinal());
  }

  /**
   * The systems to use; all if not set.
   *
   * @param systems at least one
   * @return this
   */
  public SessionBuilder systems(SatelliteSystem... systems) {
    if (systems.length == 0)
      throw new IllegalArgumentException("systems is empty");
    int bits = 0;
    for (SatelliteSystem system : systems) bits |= 1 << system.ordinal();
    return put(Layout.SessionOptions.SYSTEMS, bits);
  }

  /**
   * What a position is made of where there are photographs; jointly if not set.
   *
   * @param scheme the choice
   * @return this
   */
  public SessionBuilder scheme(Scheme scheme) {
    return put(Layout.SessionOptions.SCHEME, scheme.ordinal());
  }

  /**
   * What a position takes from the moments before; nothing but biases if not set.
   *
   * @param estimator the choice
   * @return this
   */
  public SessionBuilder estimator(Estimator estimator) {
    return put(Layout.SessionOptions.ESTIMATOR, estimator.ordinal());
  }

  /**
   * How the ionosphere is modelled; the best way if not set.
   *
   * @param ionosphere the choice
   * @return this
   */
  public SessionBuilder ionosphere(Ionosphere ionosphere) {
    return put(Layout.SessionOptions.IONOSPHERE, ionosphere.ordinal());
  }

  /**
   * How the troposphere is modelled; after Saastamoinen if not set.
   *
   * @param troposphere the choice
   * @return this
   */
  public SessionBuilder troposphere(Troposphere troposphere) {
    return put(Layout.SessionOptions.TROPOSPHERE, troposphere.ordinal());
  }

  /**
   * What the weight of a range follows; its signal if not set.
   *
   * @param weighting the choice
   * @return this
   */
  public SessionBuilder weighting(Weighting weighting) {
    return put(Layout.SessionOptions.WEIGHT, weighting.ordinal());
  }

  /**
   * How many epochs may wait for {@link PositioningSession#process}; 64 if not set.
   *
   * @param epochs 1 to 4096
   * @return this
   */
  public SessionBuilder queueCapacity(int epochs) {
    return put(Layout.SessionOptions.QUEUE_CAPACITY, epochs);
  }

  /**
   * Satellites below are not used; 5 degrees if not set.
   *
   * @param degrees above the horizon; -90 for no mask
   * @return this
   */
  public SessionBuilder elevationMask(double degrees) {
    // To the library 0 means the default; a mask that no satellite can tell from 0 does not.
    return put(Layout.SessionOptions.ELEVATION_MASK_DEG, degrees == 0.0 ? 1e-9 : degrees);
  }

  /**
   * Weaker signals are not used; 10 dB-Hz if not set.
   *
   * @param dbHz 0 or less for no limit
   * @return this
   */
  public SessionBuilder smallestCn0(double dbHz) {
    return put(Layout.SessionOptions.SMALLEST_CN0_DBHZ, dbHz <= 0.0 ? -1.0 : dbHz);
  }

  /**
   * Of {@link Weighting#ELEVATION}: a^2 + b^2 / sin^2(elevation); 1 m each if not set.
   *
   * @param aMeters the part that is the same everywhere
   * @param bMeters the part that grows towards the horizon
   * @return this
   */
  public SessionBuilder elevationModel(double aMeters, double bMeters) {
    put(Layout.SessionOptions.ELEVATION_A_M, aMeters);
    return put(Layout.SessionOptions.ELEVATION_B_M, bMeters);
  }

  /**
   * Where every random choice begins; 1 if not set.
   *
   * @param seed any number but 0
   * @return this
   */
  public SessionBuilder seed(long seed) {
    options.putLong(Layout.SessionOptions.SEED, seed);
    return this;
  }

  /**
   * Scales the stated variances to what the residuals say.
   *
   * @return this
   */
  public SessionBuilder varianceComponents() {
    return flag(Values.SESSION_VARIANCE_COMPONENTS);
  }

  /**
   * Estimates a tropospheric zenith delay.
   *
   * @return this
   */
  public SessionBuilder zenithDelay() {
    return flag(Values.SESSION_ZENITH_DELAY);
  }

  /**
   * Keeps a weak memory of the height.
   *
   * @return this
   */
  public SessionBuilder heightMemory() {
    return flag(Values.SESSION_HEIGHT_MEMORY);
  }

  /**
   * Learns no biases from past epochs.
   *
   * @return this
   */
  public SessionBuilder fixedBiases() {
    return flag(Values.SESSION_FIXED_BIASES);
  }

  /**
   * Uses satellites that say they are unhealthy.
   *
   * @return this
   */
  public SessionBuilder acceptUnhealthy() {
    return flag(Values.SESSION_ACCEPT_UNHEALTHY);
  }

  /**
   * Opens a session with these options, which stay for further ones.
   *
   * @return an open session
   */
  public PositioningSession open() {
    long[] out = new long[1];
    Native.check(Native.sessionOpen(options, out));
    TimeBase base = TimeBase.values()[options.getInt(Layout.SessionOptions.TIME_BASE)];
    return new PositioningSession(out[0], base);
  }

  private SessionBuilder put(int at, int value) {
    options.putInt(at, value);
    return this;
  }

  private SessionBuilder put(int at, double value) {
    options.putDouble(at, value);
    return this;
  }

  private SessionBuilder flag(int bit) {
    Struct.setBit(options, Layout.SessionOptions.FLAGS, bit);
    return this;
  }
}
