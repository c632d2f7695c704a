package io.lodemark.android;

import android.content.Context;
import android.hardware.SensorEvent;
import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CaptureResult;
import android.location.GnssMeasurementsEvent;
import android.location.GnssNavigationMessage;
import android.media.Image;
import android.os.Handler;
import android.os.HandlerThread;
import android.os.SystemClock;
import io.lodemark.Lens;
import io.lodemark.PositioningSession;
import java.util.HashSet;
import java.util.List;
import java.util.Objects;
import java.util.Set;

/**
 * Feeds a session with what the phone measures, and tells each position. To be closed.
 *
 * <pre>{@code
 * PositioningSession session = PositioningSession.builder().timeBase(TimeBase.BOOT).open();
 * SensorFeed feed = SensorFeed.builder(context, session)
 *     .listener((s, estimate) -> runOnUiThread(() -> show(estimate)))
 *     .build();
 * feed.start(); // satellites, inertial sensors, barometer
 * // and for each photograph of a camera, beside its TotalCaptureResult:
 * feed.onImage(image, result, characteristics);
 * }</pre>
 *
 * <p>One thread of its own, "lodemark", uses the session and calls the listener; a second one,
 * "lodemark-intake", takes the framework's callbacks, so that nothing is missed while a photograph
 * is looked at. What comes faster than the session can follow is bounded: of each {@link FeedKind}
 * the oldest that waits is dropped, counted and told. The {@code on...} methods may be called by
 * any thread, also instead of the framework's own callbacks; all other threads may use the session
 * meanwhile, such as to push ephemerides.
 */
public final class SensorFeed implements AutoCloseable {
  private static final long PATIENCE_MILLIS = 10_000;
  private static final long INTAKE_MILLIS = 1000;

  private final Context context;
  private final FeedListener listener;
  private final boolean withSensors;
  private final boolean withFramework;
  private final Lens lens;
  private final Intake intake = new Intake();
  private final FeedTally tally = new FeedTally();
  private final SessionFeeder feeder;
  private final Set<String> told = new HashSet<>();
  private final Runnable drain = this::drain;

  // Guarded by this.
  private HandlerThread feedThread;
  private HandlerThread intakeThread;
  private FrameworkSources sources;
  private boolean closed;

  private volatile Handler handler; // null while stopped

  private SensorFeed(Builder builder) {
    context = builder.context;
    listener = builder.listener;
    withSensors = builder.withSensors;
    withFramework = builder.withFramework;
    lens = builder.lens;
    feeder = new SessionFeeder(builder.session, listener, builder.log, tally, this::tell);
  }

  /**
   * Options to choose from.
   *
   * @param context of the app
   * @param session to be fed; stays the caller's to close, after the feed. Of {@link
   *     io.lodemark.TimeBase#BOOT}, or of GPS time if nothing but satellites is fed before the
   *     first epoch
   * @return a builder with the defaults
   */
  public static Builder builder(Context context, PositioningSession session) {
    return new Builder(context, session);
  }

  /**
   * Begins to listen. Does nothing if it does already.
   *
   * @throws IllegalStateException if something keeps it from starting, with what to do about it as
   *     its message; {@link FeedCheck} finds the same beforehand. Also once closed.
   */
  public synchronized void start() {
    if (closed)
      throw new IllegalStateException("feed is closed");
    if (feedThread != null)
      return;
    if (withFramework) {
      FeedCheck check = FeedCheck.of(context);
      List<String> obstacles = check.getObstacles();
      if (!obstacles.isEmpty())
        throw new IllegalStateException(String.join(" ", obstacles));
      if (withSensors) {
        for (String warning : check.getWarnings()) tell(warning);
      }
    }
    intake.clear();
    feedThread = new HandlerThread("lodemark");
    feedThread.start();
    handler = new Handler(feedThread.getLooper());
    if (withFramework) {
      intakeThread = new HandlerThread("lodemark-intake");
      intakeThread.start();
      sources = new FrameworkSources(context, this);
      sources.register(new Handler(intakeThread.getLooper()), withSensors);
    }
  }

  /**
   * Stops listening, and processes what waits but for photographs, which are dropped. When it
   * returns nothing is told any more and the log is flushed; called by the listener, that is so
   * when the listener returns. Does nothing if it is stopped.
   */
  public void stop() {
    HandlerThread thread;
    synchronized (this) {
      if (feedThread == null)
        return;
      if (sources != null) {
        sources.unregister();
        intakeThread.quitSafely(); // what was called back already still comes in
        join(intakeThread, INTAKE_MILLIS);
      }
      Handler last = handler;
      handler = null;
      while (intake.take(FeedKind.IMAGE) != null) noteDrop(FeedKind.IMAGE);
      last.post(this::finish);
      thread = feedThread;
      thread.quitSafely();
      feedThread = null;
      intakeThread = null;
      sources = null;
    }
    join(thread, PATIENCE_MILLIS);
  }

  private static void join(HandlerThread thread, long millis) {
    if (Thread.currentThread() == thread)
      return;
    try {
      thread.join(millis);
    } catch (InterruptedException interruption) {
      Thread.currentThread().interrupt();
    }
  }

  /** Stops for good. The session and the log stay the caller's to close. */
  @Override
  public void close() {
    synchronized (this) {
      closed = true;
    }
    stop();
  }

  /**
   * Whether it listens.
   *
   * @return true between start and stop
   */
  public boolean isRunning() {
    return handler != null;
  }

  /**
   * What became of what it was given.
   *
   * @return as it is now
   */
  public FeedCounts getCounts() {
    return tally.counts();
  }

  /**
   * An epoch of satellites.
   *
   * @param event kept until it was processed
   */
  public void onGnssMeasurements(GnssMeasurementsEvent event) {
    offer(FeedKind.EPOCH, Objects.requireNonNull(event, "event"));
  }

  /**
   * A message of a satellite.
   *
   * @param message kept until it was processed
   */
  public void onNavigationMessage(GnssNavigationMessage message) {
    offer(FeedKind.MESSAGE, Objects.requireNonNull(message, "message"));
  }

  /**
   * A sample of the uncalibrated accelerometer or gyroscope, the barometer or the game rotation
   * vector; others are passed over.
   *
   * @param event copied
   */
  public void onSensorChanged(SensorEvent event) {
    onSample(event.sensor.getType(), event.timestamp, event.values);
  }

  /**
   * The same, value by value.
   *
   * @param sensorType Sensor.TYPE_...
   * @param timestamp SensorEvent.timestamp: nanoseconds since boot
   * @param values SensorEvent.values, copied
   */
  public void onSample(int sensorType, long timestamp, float[] values) {
    boolean known = false;
    for (int type : FrameworkSources.SENSOR_TYPES) known |= type == sensorType;
    if (!known || handler == null)
      return;
    tally.give(FeedKind.SAMPLE);
    if (intake.offer(sensorType, timestamp, values))
      noteDrop(FeedKind.SAMPLE);
    wake();
  }

  /**
   * A photograph: YUV_420_888, of which the luma is used, or JPEG, which is decoded by the calling
   * thread. It may be closed when the method returns.
   *
   * @param image of an ImageReader
   * @param capture the TotalCaptureResult of the same SENSOR_TIMESTAMP
   * @param camera the characteristics of the camera that took it
   * @return false if it was refused: the listener is told why
   */
  public boolean onImage(Image image, CaptureResult capture, CameraCharacteristics camera) {
    if (handler == null)
      return false;
    tally.give(FeedKind.IMAGE);
    String problem = Photo.problem(image, capture, camera);
    Photo photo = problem == null ? Photo.copy(image, capture, camera, lens) : null;
    if (problem == null && photo == null) {
      problem = "A photograph could not be decoded, or the camera does not say what its lens is "
          + "like or not for this size: calibrate it and give the feed its lens.";
    }
    if (problem != null) {
      tally.refuse(FeedKind.IMAGE, 1);
      tell(problem);
      return false;
    }
    if (lens == null && !CameraLens.isCalibrated(camera, capture)) {
      tell("This camera tells its focal length but not its calibration, so photographs place the "
          + "phone less well: calibrate it with lodemark calibrate and give the feed its lens.");
    }
    put(FeedKind.IMAGE, photo);
    return true;
  }

  private void offer(FeedKind kind, Object value) {
    if (handler == null)
      return;
    tally.give(kind);
    put(kind, value);
  }

  private void put(FeedKind kind, Object value) {
    if (intake.offer(kind, value, SystemClock.elapsedRealtimeNanos()) != null)
      noteDrop(kind);
    wake();
  }

  /** At most one drain waits. */
  private void wake() {
    Handler to = handler;
    if (to != null && !to.hasCallbacks(drain))
      to.post(drain);
  }

  private void noteDrop(FeedKind kind) {
    String drop = tally.drop(kind);
    if (drop != null)
      tell(drop);
  }

  /** Each sentence once. */
  void tell(String problem) {
    synchronized (told) {
      if (!told.add(problem))
        return;
    }
    listener.onProblem(problem);
  }

  private void drain() {
    feeder.drain(intake);
  }

  private void finish() {
    feeder.drain(intake);
    feeder.flush();
  }

  /** What a feed is to do. All of it may be left as it is. */
  public static final class Builder {
    private final Context context;
    private final PositioningSession session;
    private FeedListener listener = (ignored, estimate) -> {};
    private GnssLogWriter log;
    private Lens lens;
    private boolean withSensors = true;
    private boolean withFramework = true;

    private Builder(Context context, PositioningSession session) {
      this.context = Objects.requireNonNull(context, "context").getApplicationContext();
      this.session = Objects.requireNonNull(session, "session");
    }

    /**
     * Who is told of positions and problems; nobody if not set.
     *
     * @param listener called by the feed's thread; problems also by others
     * @return this
     */
    public Builder listener(FeedListener listener) {
      this.listener = Objects.requireNonNull(listener, "listener");
      return this;
    }

    /**
     * Records what the session is given, in the order it is given.
     *
     * @param log stays the caller's to close, after the feed; null for none
     * @return this
     */
    public Builder log(GnssLogWriter log) {
      this.log = log;
      return this;
    }

    /**
     * The camera's lens, as {@code lodemark calibrate} found it, for photographs of its size.
     *
     * @param lens null to believe what the camera says, which is the default
     * @return this
     */
    public Builder lens(Lens lens) {
      this.lens = lens;
      return this;
    }

    /**
     * Satellites only: accelerometer, gyroscope, barometer and rotation vector are left alone.
     *
     * @return this
     */
    public Builder withoutSensors() {
      withSensors = false;
      return this;
    }

    /**
     * Registers no callbacks: the app calls the {@code on...} methods, as one does that listens to
     * the receiver already, or that replays.
     *
     * @return this
     */
    public Builder withoutCallbacks() {
      withFramework = false;
      return this;
    }

    /**
     * A feed with these options.
     *
     * @return a feed, to be started
     */
    public SensorFeed build() {
      return new SensorFeed(this);
    }
  }
}
