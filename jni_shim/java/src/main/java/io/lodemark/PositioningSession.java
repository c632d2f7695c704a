package io.lodemark;

import java.nio.ByteBuffer;
import java.util.ArrayList;
import java.util.List;
import java.util.Objects;

/**
 * A stream of measurements in, a position at each epoch and photograph out. To be closed.
 *
 * <pre>{@code
 * try (PositioningSession session = PositioningSession.builder().timeBase(TimeBase.BOOT).open()) {
 *   session.pushNavigation("brdc.rnx", ephemerides);
 *   session.pushGnss(elapsedRealtimeNanos, epoch); // for each GnssMeasurementsEvent
 *   while (session.process()) show(session.estimate());
 * }
 * }</pre>
 *
 * <p>Any number of threads may use and close it; each call waits for the one before it.
 */
public final class PositioningSession extends Handle {
  private final ByteBuffer estimate = Struct.of(Layout.Estimate.SIZE);
  private ByteBuffer satellites = Struct.of(Layout.Satellite.SIZE);
  private ByteBuffer landmarks = Struct.of(Layout.Landmark.SIZE);
  private ByteBuffer events = Struct.of(Layout.Event.SIZE);
  private final int[] total = new int[1];
  private final TimeBase timeBase;
  private FeatureMap map;

  private PositioningSession(long address, TimeBase timeBase) {
    super("session", address);
    this.timeBase = timeBase;
  }

  /**
   * A session with the default options.
   *
   * @return an open session, based on GPS time
   */
  public static PositioningSession open() {
    return builder().open();
  }

  /**
   * Options to choose from.
   *
   * @return a builder with the defaults
   */
  public static Builder builder() {
    return new Builder();
  }

  /**
   * Which clock its times are of.
   *
   * @return as it was opened with
   */
  public TimeBase getTimeBase() {
    return timeBase;
  }

  /**
   * Queues an epoch whose time is that of its clock: in a session based on GPS time, or on time
   * since boot if the clock has its elapsed realtime.
   *
   * @param epoch copied
   */
  public void pushGnss(GnssEpoch epoch) {
    pushGnss(epoch.clock().getLong(Layout.GnssClock.ELAPSED_REALTIME_NS), epoch);
  }

  /**
   * Queues an epoch. {@link LodemarkException.Status#QUEUE_FULL} if too many wait.
   *
   * @param timeNanos its time in the session's base; ignored by a session based on GPS time
   * @param epoch copied
   */
  public void pushGnss(long timeNanos, GnssEpoch epoch) {
    ByteBuffer clock = epoch.clock();
    synchronized (lock) {
      Native.check(Native.sessionPushGnss(address(), timeNanos, clock, epoch.rows(), epoch.size()));
    }
  }

  /**
   * Takes the content of a RINEX navigation file of any version, plain or gzip. Malformed rows are
   * counted and left out; {@link LodemarkException.Status#BAD_DATA} if it is no such file at all.
   *
   * @param name stands for the file in messages
   * @param content of the file
   * @return what it held
   */
  public ReadReport pushNavigation(String name, byte[] content) {
    return pushNavigation(name, Pixels.copy(content));
  }

  /**
   * The same of what remains in a direct buffer, such as a mapped file.
   *
   * @param name stands for the file in messages
   * @param content read from its position on, which stays
   * @return what it held
   */
  public ReadReport pushNavigation(String name, ByteBuffer content) {
    return pushFile(name, content, Native::sessionPushNavigation);
  }

  /**
   * Takes the content of an SP3 file, plain or gzip, as {@link #pushNavigation(String, byte[])}
   * does.
   *
   * @param name stands for the file in messages
   * @param content of the file
   * @return what it held
   */
  public ReadReport pushPreciseOrbits(String name, byte[] content) {
    return pushPreciseOrbits(name, Pixels.copy(content));
  }

  /**
   * The same of what remains in a direct buffer.
   *
   * @param name stands for the file in messages
   * @param content read from its position on, which stays
   * @return what it held
   */
  public ReadReport pushPreciseOrbits(String name, ByteBuffer content) {
    return pushFile(name, content, Native::sessionPushPreciseOrbits);
  }

  /**
   * Takes an android.location.GnssNavigationMessage. An orbit takes effect when its last part has
   * arrived. {@link LodemarkException.Status#OUT_OF_ORDER} before the first epoch gave a GPS time,
   * {@link LodemarkException.Status#UNSUPPORTED} for a type that is not decoded.
   *
   * @param type GnssNavigationMessage.TYPE_...
   * @param svid the satellite
   * @param messageId as Android gives it
   * @param submessageId as Android gives it
   * @param data as it was broadcast
   */
  public void pushBroadcast(int type, int svid, int messageId, int submessageId, byte[] data) {
    ByteBuffer message = Struct.of(Layout.BroadcastMessage.SIZE);
    message.putInt(Layout.BroadcastMessage.TYPE, type);
    message.putInt(Layout.BroadcastMessage.SVID, svid);
    message.putInt(Layout.BroadcastMessage.MESSAGE_ID, messageId);
    message.putInt(Layout.BroadcastMessage.SUBMESSAGE_ID, submessageId);
    ByteBuffer bytes = Pixels.copy(data);
    synchronized (lock) {
      Native.check(Native.sessionPushBroadcast(address(), message, bytes, data.length));
    }
  }

  /**
   * Has photographs looked up in a map, and satellites behind its buildings trusted less. The map
   * may be closed meanwhile: the session keeps what it needs of it.
   *
   * @param newMap null for none
   */
  public void useMap(FeatureMap newMap) {
    synchronized (lock) {
      long session = address();
      FeatureMap old = map;
      int status;
      if (newMap == null) {
        status = Native.sessionUseMap(session, 0);
      } else {
        synchronized (newMap.lock) {
          status = Native.sessionUseMap(session, newMap.acquire());
          if (status < 0)
            newMap.release();
        }
      }
      map = status < 0 ? null : newMap;
      // Not while the other map's lock is held: sessions that swap two maps would wait for each
      // other.
      LodemarkException refused = status < 0 ? Native.failure(status) : null;
      if (status < 0)
        Native.sessionUseMap(session, 0);
      if (old != null)
        old.release();
      if (refused != null)
        throw refused;
    }
  }

  /**
   * Queues a photograph. {@link LodemarkException.Status#OUT_OF_ORDER} before a map is used, {@link
   * LodemarkException.Status#QUEUE_FULL} if four photographs wait.
   *
   * @param image copied
   */
  public void pushImage(CameraImage image) {
    Objects.requireNonNull(image, "image");
    synchronized (lock) {
      Native.check(Native.sessionPushImage(address(), image.frame(), image.lens().struct(),
          image.pixels(), image.size(), image.strideBytes()));
    }
  }

  /**
   * Turns the oldest of what waits, epoch or photograph, into an estimate at its time: an epoch
   * with the latest photograph, a photograph with the latest epoch, where they are within 1.5 s.
   *
   * @return false if nothing waits; true even if there is no position: the estimate says why
   */
  public boolean process() {
    synchronized (lock) {
      long session = address();
      synchronized (map == null ? lock : map.lock) {
        return Native.check(Native.sessionProcess(session)) != Values.NOTHING_QUEUED;
      }
    }
  }

  /**
   * How many epochs and photographs wait for {@link #process}.
   *
   * @return their number
   */
  public int queued() {
    synchronized (lock) {
      Native.check(Native.sessionQueued(address(), total));
      return total[0];
    }
  }

  /**
   * Where the phone was at the epoch or photograph processed last.
   *
   * @return the estimate, with or without a position
   */
  public Estimate estimate() {
    synchronized (lock) {
      Native.check(Native.sessionEstimate(address(), estimate));
      return new Estimate(estimate, 0);
    }
  }

  /**
   * The signals of the epoch processed last, used or not; none if it was a photograph.
   *
   * @return a list of the caller's own
   */
  public List<SatelliteStatus> satellites() {
    synchronized (lock) {
      satellites = fetch(satellites, Layout.Satellite.SIZE, Native::sessionSatellites);
      return read(satellites, Layout.Satellite.SIZE, SatelliteStatus::new);
    }
  }

  /**
   * The landmarks that the estimate looked at, used or not; none where no photograph was near.
   *
   * @return a list of the caller's own
   */
  public List<LandmarkStatus> landmarks() {
    synchronized (lock) {
      landmarks = fetch(landmarks, Layout.Landmark.SIZE, Native::sessionLandmarks);
      return read(landmarks, Layout.Landmark.SIZE, LandmarkStatus::new);
    }
  }

  /**
   * Every estimate since the session was opened or reset, each with what came after it: for a
   * recording, not for live use. Takes longer the more there are.
   *
   * @return a list of the caller's own; empty without {@link Estimator#SMOOTHER}
   */
  public List<Estimate> smoothed() {
    synchronized (lock) {
      ByteBuffer all =
          fetch(Struct.of(Layout.Estimate.SIZE), Layout.Estimate.SIZE, Native::sessionSmoothed);
      return read(all, Layout.Estimate.SIZE, Estimate::new);
    }
  }

  /**
   * What happened since the last call, oldest first. Of more than 256 the oldest are lost.
   *
   * @return a list of the caller's own
   */
  public List<SessionEvent> takeEvents() {
    synchronized (lock) {
      events = fetch(events, Layout.Event.SIZE, Native::sessionEvents);
      List<SessionEvent> taken = read(events, Layout.Event.SIZE, SessionEvent::new);
      Native.check(Native.sessionClearEvents(address()));
      return taken;
    }
  }

  /** Forgets positions, clocks, queued epochs, events and learned biases; keeps the orbits. */
  public void reset() {
    synchronized (lock) {
      long session = address();
      synchronized (map == null ? lock : map.lock) {
        Native.check(Native.sessionReset(session));
      }
    }
  }

  @Override
  public void close() {
    synchronized (lock) {
      Native.sessionClose(take());
      if (map != null)
        map.release();
      map = null;
    }
  }

  /** One of the natives that take a file. */
  private interface FilePush {
    int call(long session, byte[] name, ByteBuffer bytes, long size, ByteBuffer report);
  }

  private ReadReport pushFile(String name, ByteBuffer content, FilePush push) {
    byte[] utf8 = Native.bytes(name, "name");
    ByteBuffer bytes = Pixels.direct(content, 0, "content");
    ByteBuffer report = Struct.of(Layout.ReadReport.SIZE);
    synchronized (lock) {
      Native.check(push.call(address(), utf8, bytes, bytes.capacity(), report));
    }
    return new ReadReport(report, 0);
  }

  /** One of the natives that fill a list. */
  private interface ListNative {
    int call(long session, ByteBuffer out, int capacity, int[] total);
  }

  /** A value class made of one struct of a list. */
  private interface Reader<T> {
    T read(ByteBuffer structs, int at);
  }

  /** Fills structs, or a larger array where it has too little room; total is how many there are. */
  private ByteBuffer fetch(ByteBuffer structs, int size, ListNative list) {
    Native.check(list.call(address(), structs, structs.capacity() / size, total));
    if (total[0] <= structs.capacity() / size)
      return structs;
    int capacity = total[0] + total[0] / 2;
    ByteBuffer larger = Struct.array(size, capacity);
    Native.check(list.call(address(), larger, capacity, total));
    return larger;
  }

  private <T> List<T> read(ByteBuffer structs, int size, Reader<T> reader) {
    List<T> values = new ArrayList<>(total[0]);
    for (int i = 0; i < total[0]; ++i) values.add(reader.read(structs, i * size));
    return values;
  }

  /** The options of a session. All of them may be left as they are. */
  public static final class Builder {
    private final ByteBuffer options = Struct.of(Layout.SessionOptions.SIZE);

    private Builder() {}

    /**
     * Which clock its times are of; GPS if not set.
     *
     * @param timeBase the clock
     * @return this
     */
    public Builder timeBase(TimeBase timeBase) {
      return put(Layout.SessionOptions.TIME_BASE, timeBase.ordinal());
    }

    /**
     * The systems to use; all if not set.
     *
     * @param systems at least one
     * @return this
     */
    public Builder systems(SatelliteSystem... systems) {
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
    public Builder scheme(Scheme scheme) {
      return put(Layout.SessionOptions.SCHEME, scheme.ordinal());
    }

    /**
     * What a position takes from the moments before; nothing but biases if not set.
     *
     * @param estimator the choice
     * @return this
     */
    public Builder estimator(Estimator estimator) {
      return put(Layout.SessionOptions.ESTIMATOR, estimator.ordinal());
    }

    /**
     * How the ionosphere is modelled; the best way if not set.
     *
     * @param ionosphere the choice
     * @return this
     */
    public Builder ionosphere(Ionosphere ionosphere) {
      return put(Layout.SessionOptions.IONOSPHERE, ionosphere.ordinal());
    }

    /**
     * How the troposphere is modelled; after Saastamoinen if not set.
     *
     * @param troposphere the choice
     * @return this
     */
    public Builder troposphere(Troposphere troposphere) {
      return put(Layout.SessionOptions.TROPOSPHERE, troposphere.ordinal());
    }

    /**
     * What the weight of a range follows; its signal if not set.
     *
     * @param weighting the choice
     * @return this
     */
    public Builder weighting(Weighting weighting) {
      return put(Layout.SessionOptions.WEIGHT, weighting.ordinal());
    }

    /**
     * How many epochs may wait for {@link PositioningSession#process}; 64 if not set.
     *
     * @param epochs 1 to 4096
     * @return this
     */
    public Builder queueCapacity(int epochs) {
      return put(Layout.SessionOptions.QUEUE_CAPACITY, epochs);
    }

    /**
     * Satellites below are not used; 5 degrees if not set.
     *
     * @param degrees above the horizon; -90 for no mask
     * @return this
     */
    public Builder elevationMask(double degrees) {
      // To the library 0 means the default; a mask that no satellite can tell from 0 does not.
      return put(Layout.SessionOptions.ELEVATION_MASK_DEG, degrees == 0.0 ? 1e-9 : degrees);
    }

    /**
     * Weaker signals are not used; 10 dB-Hz if not set.
     *
     * @param dbHz 0 or less for no limit
     * @return this
     */
    public Builder smallestCn0(double dbHz) {
      return put(Layout.SessionOptions.SMALLEST_CN0_DBHZ, dbHz <= 0.0 ? -1.0 : dbHz);
    }

    /**
     * Of {@link Weighting#ELEVATION}: a^2 + b^2 / sin^2(elevation); 1 m each if not set.
     *
     * @param aMeters the part that is the same everywhere
     * @param bMeters the part that grows towards the horizon
     * @return this
     */
    public Builder elevationModel(double aMeters, double bMeters) {
      put(Layout.SessionOptions.ELEVATION_A_M, aMeters);
      return put(Layout.SessionOptions.ELEVATION_B_M, bMeters);
    }

    /**
     * Where every random choice begins; 1 if not set.
     *
     * @param seed any number but 0
     * @return this
     */
    public Builder seed(long seed) {
      options.putLong(Layout.SessionOptions.SEED, seed);
      return this;
    }

    /**
     * Scales the stated variances to what the residuals say.
     *
     * @return this
     */
    public Builder varianceComponents() {
      return flag(Values.SESSION_VARIANCE_COMPONENTS);
    }

    /**
     * Estimates a tropospheric zenith delay.
     *
     * @return this
     */
    public Builder zenithDelay() {
      return flag(Values.SESSION_ZENITH_DELAY);
    }

    /**
     * Keeps a weak memory of the height.
     *
     * @return this
     */
    public Builder heightMemory() {
      return flag(Values.SESSION_HEIGHT_MEMORY);
    }

    /**
     * Learns no biases from past epochs.
     *
     * @return this
     */
    public Builder fixedBiases() {
      return flag(Values.SESSION_FIXED_BIASES);
    }

    /**
     * Uses satellites that say they are unhealthy.
     *
     * @return this
     */
    public Builder acceptUnhealthy() {
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

    private Builder put(int at, int value) {
      options.putInt(at, value);
      return this;
    }

    private Builder put(int at, double value) {
      options.putDouble(at, value);
      return this;
    }

    private Builder flag(int bit) {
      Struct.setBit(options, Layout.SessionOptions.FLAGS, bit);
      return this;
    }
  }
}
