package io.lodemark;

import java.nio.ByteBuffer;
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
  private final StructList<SatelliteStatus> satellites =
      new StructList<>(Layout.Satellite.SIZE, Native::sessionSatellites, SatelliteStatus::new);
  private final StructList<LandmarkStatus> landmarks =
      new StructList<>(Layout.Landmark.SIZE, Native::sessionLandmarks, LandmarkStatus::new);
  private final StructList<SessionEvent> events =
      new StructList<>(Layout.Event.SIZE, Native::sessionEvents, SessionEvent::new);
  private final int[] total = new int[1];
  private final TimeBase timeBase;
  private FeatureMap map;

  PositioningSession(long address, TimeBase timeBase) {
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
  public static SessionBuilder builder() {
    return new SessionBuilder();
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
   * Takes what accelerometer, gyroscope, barometer or vehicle measured; it needs no {@link
   * #process}. Push what was measured before an epoch before the epoch is processed: later it is
   * not heard. {@link Estimator#FILTER} and {@link Estimator#SMOOTHER} use it. A sample that is not
   * later than the one before of its sensor is dropped, and an event tells of the first.
   *
   * @param batch copied; those of one sensor in the order of their times
   */
  public void pushImu(ImuBatch batch) {
    Objects.requireNonNull(batch, "batch");
    synchronized (lock) {
      Native.check(Native.sessionPushSensors(address(), batch.rows(), batch.size()));
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
      return satellites.fetch(address());
    }
  }

  /**
   * The landmarks that the estimate looked at, used or not; none where no photograph was near.
   *
   * @return a list of the caller's own
   */
  public List<LandmarkStatus> landmarks() {
    synchronized (lock) {
      return landmarks.fetch(address());
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
      // Not kept: a recording's worth of estimates is large.
      return new StructList<>(Layout.Estimate.SIZE, Native::sessionSmoothed, Estimate::new)
          .fetch(address());
    }
  }

  /**
   * What happened since the last call, oldest first. Of more than 256 the oldest are lost.
   *
   * @return a list of the caller's own
   */
  public List<SessionEvent> takeEvents() {
    synchronized (lock) {
      List<SessionEvent> taken = events.fetch(address());
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
}
