package io.lodemark.android;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertFalse;
import static org.junit.Assert.assertNotEquals;
import static org.junit.Assert.assertThrows;
import static org.junit.Assert.assertTrue;

import android.Manifest;
import android.app.Activity;
import android.graphics.ImageFormat;
import android.hardware.Sensor;
import android.hardware.SensorEvent;
import android.hardware.SensorManager;
import android.location.GnssMeasurementsEvent;
import android.location.LocationManager;
import android.media.FakeImage;
import android.media.Image;
import io.lodemark.Estimate;
import io.lodemark.PositioningSession;
import io.lodemark.TimeBase;
import java.io.File;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.CountDownLatch;
import org.junit.After;
import org.junit.Before;
import org.junit.Rule;
import org.junit.Test;
import org.junit.rules.TemporaryFolder;
import org.junit.runner.RunWith;
import org.robolectric.Robolectric;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.Shadows;
import org.robolectric.android.controller.ActivityController;
import org.robolectric.annotation.Config;
import org.robolectric.shadows.SensorEventBuilder;

/** The feed on the framework's own callbacks, hurried, interrupted and misused. */
@RunWith(RobolectricTestRunner.class)
@Config(sdk = 34, manifest = Config.NONE)
public class SensorFeedTest {
  private static final Path WALK = Recorded.ROOT.resolve("sample_logs/walk");

  @Rule public final TemporaryFolder folder = new TemporaryFolder();

  private final FedFixes fixes = new FedFixes();
  private final List<GnssMeasurementsEvent> events = new ArrayList<>();
  private PositioningSession session;

  @Before
  public void open() throws IOException {
    Phone.allow();
    session = PositioningSession.builder().timeBase(TimeBase.BOOT).open();
    session.pushNavigation("navigation.rnx", Files.readAllBytes(WALK.resolve("navigation.rnx")));
    LoggedEvents.read(WALK.resolve("gnss_log.txt"), events::add, message -> {});
  }

  @After
  public void close() {
    session.close();
  }

  private SensorFeed.Builder builder() {
    return SensorFeed.builder(Phone.app(), session).listener(fixes);
  }

  private static boolean isAlive(String thread) {
    for (Thread other : Thread.getAllStackTraces().keySet()) {
      if (other.getName().equals(thread) && other.isAlive())
        return true;
    }
    return false;
  }

  @Test
  public void theFrameworksCallbacksGiveAFix() throws Exception {
    try (SensorFeed feed = builder().build()) {
      feed.start();
      feed.start(); // changes nothing
      assertTrue(feed.isRunning());
      Shadows.shadowOf(Phone.location()).simulateGnssMeasurementsEvent(events.get(0));
      fixes.await();
      SensorManager sensors = Phone.app().getSystemService(SensorManager.class);
      for (int type : FrameworkSources.SENSOR_TYPES) {
        SensorEvent event = SensorEventBuilder.newBuilder()
                                .setSensor(Phone.sensor(type))
                                .setValues(new float[] {500, 2, 3, 0, 0, 0})
                                .setTimestamp(Phone.TAKEN)
                                .build();
        Shadows.shadowOf(sensors).sendSensorEventToListeners(event);
      }
      feed.stop();
      FeedCounts counts = feed.getCounts();
      assertEquals(4, counts.getGiven(FeedKind.SAMPLE));
      assertEquals(counts.toString(), 4, counts.getUsed(FeedKind.SAMPLE));
    }
    Estimate fix = fixes.estimates.get(0);
    assertTrue(fix.hasPosition());
    assertEquals(30.5287, fix.getLatitudeDegrees(), 3e-4);
    assertEquals(new ArrayList<String>(), fixes.problems);
    // Nothing is left behind.
    assertFalse(isAlive("lodemark"));
    assertFalse(isAlive("lodemark-intake"));
    Shadows.shadowOf(Phone.location()).simulateGnssMeasurementsEvent(events.get(1));
    SensorManager sensors = Phone.app().getSystemService(SensorManager.class);
    assertTrue(Shadows.shadowOf(sensors).getListeners().isEmpty());
    assertEquals(1, fixes.estimates.size());
  }

  @Test
  public void whatComesTooFastIsDroppedAndTold() throws Exception {
    CountDownLatch busy = new CountDownLatch(1);
    CountDownLatch entered = new CountDownLatch(1);
    FeedListener slow = new FeedListener() {
      @Override
      public void onEstimate(PositioningSession ignored, Estimate estimate) {
        fixes.onEstimate(ignored, estimate);
        entered.countDown();
        try {
          busy.await();
        } catch (InterruptedException interruption) {
          throw new AssertionError(interruption);
        }
      }

      @Override
      public void onProblem(String problem) {
        fixes.onProblem(problem);
      }
    };
    SensorFeed feed = builder().listener(slow).withoutCallbacks().build();
    feed.start();
    feed.onGnssMeasurements(events.get(0));
    entered.await();
    int room = FeedKind.EPOCH.getCapacity();
    for (int i = 1; i <= room + 5; ++i) feed.onGnssMeasurements(events.get(i));
    int samples = FeedKind.SAMPLE.getCapacity() + 7;
    for (int i = 0; i < samples; ++i)
      feed.onSample(Sensor.TYPE_PRESSURE, Phone.TAKEN + i, new float[] {1000});
    busy.countDown();
    feed.close();

    FeedCounts counts = feed.getCounts();
    assertEquals(5, counts.getDropped(FeedKind.EPOCH));
    assertEquals(room + 1, counts.getUsed(FeedKind.EPOCH));
    assertEquals(7, counts.getDropped(FeedKind.SAMPLE));
    assertTrue(fixes.problems.toString(), fixes.problems.get(0).startsWith("Of epochs"));
    // The oldest went: the last is the newest.
    assertEquals(room + 1, fixes.estimates.size());
    long first = fixes.estimates.get(0).getTimeGpsNanos();
    long second = fixes.estimates.get(1).getTimeGpsNanos();
    assertEquals(6, Math.round((second - first) * 1e-9));
    assertTrue(counts.toString(), counts.toString().contains("5 dropped"));
  }

  @Test
  public void theListenerMayStopTheFeed() throws Exception {
    CountDownLatch stopped = new CountDownLatch(1);
    SensorFeed[] feed = new SensorFeed[1];
    feed[0] = builder()
                  .withoutCallbacks()
                  .listener((ignored, estimate) -> {
                    feed[0].stop();
                    stopped.countDown();
                  })
                  .build();
    feed[0].start();
    feed[0].onGnssMeasurements(events.get(0));
    stopped.await();
    assertFalse(feed[0].isRunning());
    feed[0].onGnssMeasurements(events.get(1)); // passed over
    feed[0].start();
    assertTrue(feed[0].isRunning());
    feed[0].close();
    feed[0].close();
    assertThrows(IllegalStateException.class, feed[0] ::start);
    assertEquals(1, feed[0].getCounts().getGiven(FeedKind.EPOCH));
  }

  @Test
  public void aFeedCanBeStoppedAndStartedAgain() {
    try (SensorFeed feed = builder().withoutCallbacks().build()) {
      for (int i = 0; i < 20; ++i) {
        feed.start();
        feed.onGnssMeasurements(events.get(i));
        feed.stop(); // what waits is processed first
        feed.stop();
        assertEquals(i + 1, fixes.estimates.size());
      }
    }
  }

  @Test
  public void aSessionClosedTooEarlyIsTold() {
    SensorFeed feed = builder().withoutCallbacks().build();
    feed.start();
    session.close();
    feed.onGnssMeasurements(events.get(0));
    feed.close();
    assertEquals(1, feed.getCounts().getRefused(FeedKind.EPOCH));
    assertTrue(fixes.problems.toString(), fixes.problems.get(0).contains("closed before its feed"));
  }

  @Test
  public void obstaclesSayWhatToDo() {
    Shadows.shadowOf(Phone.app()).denyPermissions(Manifest.permission.ACCESS_FINE_LOCATION);
    Shadows.shadowOf(Phone.location()).setProviderEnabled(LocationManager.GPS_PROVIDER, false);
    List<String> obstacles = FeedCheck.of(Phone.app()).getObstacles();
    assertEquals(2, obstacles.size());
    assertTrue(obstacles.get(0), obstacles.get(0).contains("requestPermissions()"));
    assertTrue(obstacles.get(1), obstacles.get(1).contains("ACTION_LOCATION_SOURCE_SETTINGS"));
    SensorFeed feed = builder().build();
    IllegalStateException refused = assertThrows(IllegalStateException.class, feed::start);
    assertTrue(refused.getMessage(), refused.getMessage().contains("ACCESS_FINE_LOCATION"));
    assertFalse(feed.isRunning());
    Phone.allow();
    assertTrue(FeedCheck.of(Phone.app()).getObstacles().isEmpty());
    assertTrue(FeedCheck.of(Phone.app()).getWarnings().isEmpty());
  }

  @Test
  public void aFeedFollowsAnActivity() {
    SensorFeed feed = builder().build();
    ActivityController<Activity> controller = Robolectric.buildActivity(Activity.class).create();
    FeedLifecycle.follow(controller.get(), feed);
    assertFalse(feed.isRunning());
    controller.start();
    assertTrue(feed.isRunning());
    controller.stop();
    assertFalse(feed.isRunning());
    controller.restart().start();
    assertTrue(feed.isRunning());
    controller.stop().destroy();
    assertFalse(feed.isRunning());
    assertThrows(IllegalStateException.class, feed::start);
  }

  private static Image photograph() {
    ByteBuffer pixels = ByteBuffer.allocateDirect(400 * 300);
    for (int i = 0; i < pixels.capacity(); ++i) pixels.put(i, (byte) (i * i));
    return new FakeImage(ImageFormat.YUV_420_888, 400, 300, Phone.TAKEN, pixels, 400, 1);
  }

  @Test
  public void photographsWithoutATimeAreRefused() {
    try (SensorFeed feed = builder().withoutCallbacks().build()) {
      feed.start();
      assertFalse(
          feed.onImage(photograph(), Phone.capture(Phone.TAKEN), Phone.camera(false, true)));
      assertEquals(1, feed.getCounts().getRefused(FeedKind.IMAGE));
      assertTrue(fixes.problems.get(0).contains("REALTIME"));
    }
  }

  @Test
  public void photographsNeedAMap() {
    SensorFeed feed = builder().withoutCallbacks().build();
    feed.start();
    assertTrue(feed.onImage(photograph(), Phone.capture(Phone.TAKEN), Phone.camera(true, false)));
    CountDownLatch seen = new CountDownLatch(1);
    feed.onGnssMeasurements(events.get(0));
    fixes.await(); // behind the photograph
    seen.countDown();
    feed.close();
    assertEquals(1, feed.getCounts().getRefused(FeedKind.IMAGE));
    assertTrue(fixes.problems.toString(), fixes.problems.get(0).contains("lodemark calibrate"));
    assertTrue(fixes.problems.toString(), fixes.problems.get(1).contains("useMap()"));
  }

  @Test
  public void aLogHoldsEverySensorAndPhotograph() throws Exception {
    File recording = new File(folder.getRoot(), "field \"day\"");
    try (GnssLogWriter log = GnssLogWriter.create(recording);
        SensorFeed feed = builder().withoutCallbacks().log(log).build()) {
      feed.start();
      feed.onGnssMeasurements(events.get(0));
      fixes.await();
      float half = (float) Math.sqrt(0.5);
      long middle = Phone.TAKEN + (Phone.EXPOSURE + Phone.SKEW) / 2;
      feed.onSample(Sensor.TYPE_GAME_ROTATION_VECTOR, middle, new float[] {half, 0, 0, half});
      feed.onSample(Sensor.TYPE_ACCELEROMETER_UNCALIBRATED, middle,
          new float[] {0.1f, 9.8f, 0.2f, 0.01f, 0.02f, 0.03f});
      feed.onSample(Sensor.TYPE_GYROSCOPE_UNCALIBRATED, middle, new float[] {500, 2, 3, 0, 0, 0});
      feed.onSample(Sensor.TYPE_PRESSURE, middle, new float[] {1013.25f});
      feed.onSample(Sensor.TYPE_LIGHT, middle, new float[] {1});
      assertTrue(feed.onImage(photograph(), Phone.capture(Phone.TAKEN), Phone.camera(true, true)));
      feed.onGnssMeasurements(events.get(1));
      fixes.await();
    }
    String text = new String(Files.readAllBytes(recording.toPath().resolve("gnss_log.txt")));
    assertTrue(text, text.matches("(?s).*\nUncalAccel,\\d+,\\d+,0.1[^,]*,9.8[^,]*,.*"));
    assertTrue(text, text.contains("\nPressure,"));
    assertTrue(text, text.contains("," + (Phone.TAKEN + 14_000_000L) + ",1013.25\n"));
    assertTrue(text, text.contains("\nGameRotationVector,"));
    List<String> list = Files.readAllLines(recording.toPath().resolve("cam0/data.csv"));
    assertEquals(2, list.size());
    String[] row = list.get(1).split(",");
    assertEquals("000001.pgm", row[1]);
    assertEquals(-1.0, Double.parseDouble(row[2]), 1e-6); // up, in a sensor that is turned by 90
    byte[] picture = Files.readAllBytes(recording.toPath().resolve("cam0/data/000001.pgm"));
    assertEquals(15 + 400 * 300, picture.length);
    // Photograph and first epoch lie as far apart in GPS time as since boot.
    long apart = Long.parseLong(row[0]) - fixes.estimates.get(0).getTimeGpsNanos();
    assertEquals(Phone.TAKEN + 14_000_000L - fixes.estimates.get(0).getTimeNanos(), apart, 1000);
    assertThrows(IOException.class, () -> GnssLogWriter.create(recording));
    assertNotEquals(0, recording.toPath().resolve("manifest.json").toFile().length());
  }
}
