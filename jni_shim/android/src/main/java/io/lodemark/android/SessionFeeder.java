package io.lodemark.android;

import android.hardware.Sensor;
import android.location.GnssClock;
import android.location.GnssMeasurementsEvent;
import android.location.GnssNavigationMessage;
import io.lodemark.CameraImage;
import io.lodemark.Estimate;
import io.lodemark.GnssEpoch;
import io.lodemark.ImuBatch;
import io.lodemark.LodemarkException;
import io.lodemark.PositioningSession;
import io.lodemark.TimeBase;
import java.io.IOException;
import java.util.ArrayDeque;
import java.util.function.Consumer;

/** Takes what waits, pushes it into the session and the log in one order, and processes it. */
final class SessionFeeder {
  private final PositioningSession session;
  private final FeedListener listener;
  private final FeedTally tally;
  private final Consumer<String> teller;
  private final GnssEpoch epoch = new GnssEpoch();
  private final Sample sample = new Sample();
  private final ImuBatch batch = new ImuBatch();
  private final Tilt tilt = new Tilt();
  private final BootClock clock = new BootClock();
  private final ArrayDeque<GnssNavigationMessage> messages = new ArrayDeque<>();
  private GnssLogWriter log; // null once it failed

  SessionFeeder(PositioningSession session, FeedListener listener, GnssLogWriter log,
      FeedTally tally, Consumer<String> teller) {
    this.session = session;
    this.listener = listener;
    this.log = log;
    this.tally = tally;
    this.teller = teller;
  }

  void drain(Intake intake) {
    while (true) {
      if (intake.takeSample(sample)) {
        take(sample);
        continue;
      }
      pushSamples();
      Intake.Item item = intake.take();
      if (item == null)
        return;
      if (item.kind == FeedKind.EPOCH) {
        take((GnssMeasurementsEvent) item.value, item.arrivalNanos);
      } else if (item.kind == FeedKind.MESSAGE) {
        take((GnssNavigationMessage) item.value);
      } else {
        take((Photo) item.value);
      }
    }
  }

  void flush() {
    record(GnssLogWriter::flush);
  }

  private void take(GnssMeasurementsEvent event, long arrivalNanos) {
    GnssClock receiver = event.getClock();
    long bootNanos = GnssEvents.bootNanos(receiver, arrivalNanos);
    clock.learn(receiver, bootNanos);
    record(to -> to.write(event, bootNanos));
    pushMessages();
    GnssEvents.fill(event, epoch);
    if (push(FeedKind.EPOCH, 1, () -> session.pushGnss(bootNanos, epoch)))
      process();
  }

  /** Waits for the next epoch, as it does when the log is replayed. */
  private void take(GnssNavigationMessage message) {
    record(to -> to.write(message));
    if (messages.size() == FeedKind.MESSAGE.getCapacity()) {
      messages.remove();
      tally.drop(FeedKind.MESSAGE);
    }
    messages.add(message);
  }

  /** Before the receiver knows the time they cannot be placed, and wait. */
  private void pushMessages() {
    while (!messages.isEmpty()) {
      GnssNavigationMessage message = messages.peek();
      try {
        session.pushBroadcast(message.getType(), message.getSvid(), message.getMessageId(),
            message.getSubmessageId(), message.getData());
        tally.use(FeedKind.MESSAGE, 1);
      } catch (LodemarkException refusal) {
        if (refusal.getStatus() == LodemarkException.Status.OUT_OF_ORDER)
          return;
        tally.refuse(FeedKind.MESSAGE, 1);
      } catch (IllegalStateException closed) {
        tellClosed();
        return;
      }
      messages.remove();
    }
  }

  private void take(Photo photo) {
    double[] up = tilt.upInCamera(photo.bootNanos, photo.sensorOrientation, photo.front);
    record(to -> to.write(photo.pixels, photo.lens, photo.bootNanos, up, Tilt.SIGMA_DEGREES));
    if (session.getTimeBase() == TimeBase.GPS && !clock.isKnown()) {
      tally.refuse(FeedKind.IMAGE, 1);
      teller.accept("Photographs came before the first epoch of satellites: a session of "
          + "TimeBase.BOOT can use them.");
      return;
    }
    CameraImage image = new CameraImage(photo.lens, photo.pixels, photo.width);
    image.setTimeNanos(inSession(photo.bootNanos));
    if (up != null)
      image.setGravity(up, Tilt.SIGMA_DEGREES);
    if (photo.cameraFromDevice != null)
      image.setCameraFromDevice(photo.cameraFromDevice);
    if (push(FeedKind.IMAGE, 1, () -> session.pushImage(image)))
      process();
  }

  private void take(Sample next) {
    record(to -> to.write(next));
    if (next.sensorType == Sensor.TYPE_GAME_ROTATION_VECTOR && next.count >= 4) {
      tilt.add(next.bootNanos, next.values[0], next.values[1], next.values[2], next.values[3]);
      tally.use(FeedKind.SAMPLE, 1);
      return;
    }
    boolean placed = session.getTimeBase() == TimeBase.BOOT || clock.isKnown();
    if (!placed || !next.isFinite()) {
      tally.refuse(FeedKind.SAMPLE, 1);
      return;
    }
    long timeNanos = inSession(next.bootNanos);
    if (next.sensorType == Sensor.TYPE_ACCELEROMETER_UNCALIBRATED) {
      batch.addAccelerometer(timeNanos, next.unbiased(0), next.unbiased(1), next.unbiased(2));
    } else if (next.sensorType == Sensor.TYPE_GYROSCOPE_UNCALIBRATED) {
      batch.addGyroscope(timeNanos, next.unbiased(0), next.unbiased(1), next.unbiased(2));
    } else {
      batch.addBarometer(timeNanos, next.values[0]);
    }
    if (batch.size() == ImuBatch.LARGEST_SIZE)
      pushSamples();
  }

  private void pushSamples() {
    int count = batch.size();
    if (count == 0)
      return;
    push(FeedKind.SAMPLE, count, () -> session.pushImu(batch));
    batch.clear();
  }

  private long inSession(long bootNanos) {
    return session.getTimeBase() == TimeBase.BOOT ? bootNanos : clock.gpsNanos(bootNanos);
  }

  private boolean push(FeedKind kind, int count, Runnable call) {
    try {
      call.run();
      tally.use(kind, count);
      return true;
    } catch (LodemarkException refusal) {
      tally.refuse(kind, count);
      teller.accept(
          kind == FeedKind.IMAGE && refusal.getStatus() == LodemarkException.Status.OUT_OF_ORDER
              ? "Photographs are not looked up: give the session a map with useMap()."
              : "The session refused some " + kind.plural() + ": " + refusal.getMessage());
    } catch (IllegalStateException closed) {
      tally.refuse(kind, count);
      tellClosed();
    }
    return false;
  }

  private void process() {
    for (Estimate next = processed(); next != null; next = processed())
      listener.onEstimate(session, next);
  }

  /** Null if nothing waits. */
  private Estimate processed() {
    try {
      return session.process() ? session.estimate() : null;
    } catch (LodemarkException failure) {
      teller.accept("The session failed: " + failure.getMessage());
    } catch (IllegalStateException closed) {
      tellClosed();
    }
    return null;
  }

  private void tellClosed() {
    teller.accept("The session was closed before its feed: close the feed first.");
  }

  /** Something to be written. */
  private interface Writing {
    void to(GnssLogWriter log) throws IOException;
  }

  private void record(Writing writing) {
    if (log == null)
      return;
    try {
      writing.to(log);
    } catch (IOException failure) {
      log = null;
      teller.accept("Recording ended: " + failure.getMessage() + ". Make room and begin another.");
    }
  }
}
