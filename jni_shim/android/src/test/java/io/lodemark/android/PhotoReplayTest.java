package io.lodemark.android;

import static org.junit.Assert.assertTrue;

import android.graphics.ImageFormat;
import android.graphics.Rect;
import android.hardware.Sensor;
import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CameraMetadata;
import android.hardware.camera2.CaptureResult;
import android.location.GnssMeasurementsEvent;
import android.media.FakeImage;
import io.lodemark.Estimate;
import io.lodemark.FeatureMap;
import io.lodemark.PhotoOutcome;
import io.lodemark.PositioningSession;
import io.lodemark.TimeBase;
import java.awt.image.BufferedImage;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import javax.imageio.ImageIO;
import org.junit.Rule;
import org.junit.Test;
import org.junit.rules.TemporaryFolder;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.Shadows;
import org.robolectric.annotation.Config;
import org.robolectric.shadows.ShadowCameraCharacteristics;
import org.robolectric.shadows.ShadowCaptureResult;

/**
 * The square with its photographs, as Images of a camera in the back of a phone whose game rotation
 * vector is the truth: the feed recognises them, and so does a replay of what it recorded.
 */
@RunWith(RobolectricTestRunner.class)
@Config(sdk = 34, manifest = Config.NONE)
public class PhotoReplayTest {
  private static final Path SQUARE = Recorded.ROOT.resolve("sample_logs/square");
  private static final int WIDTH = 1280;
  private static final int HEIGHT = 960;
  private static final int PHOTOGRAPHS = 5; // more take longer, and tell no more

  @Rule public final TemporaryFolder folder = new TemporaryFolder();

  private final FedFixes fixes = new FedFixes();
  private final List<GnssMeasurementsEvent> epochs = new ArrayList<>();

  /** That of cam0/camera.json. */
  private static CameraCharacteristics camera() {
    CameraCharacteristics camera = ShadowCameraCharacteristics.newCameraCharacteristics();
    ShadowCameraCharacteristics set = Shadows.shadowOf(camera);
    set.set(CameraCharacteristics.SENSOR_INFO_TIMESTAMP_SOURCE,
        CameraMetadata.SENSOR_INFO_TIMESTAMP_SOURCE_REALTIME);
    set.set(CameraCharacteristics.SENSOR_INFO_ACTIVE_ARRAY_SIZE, new Rect(0, 0, WIDTH, HEIGHT));
    set.set(CameraCharacteristics.SENSOR_ORIENTATION, 0);
    set.set(CameraCharacteristics.LENS_FACING, CameraMetadata.LENS_FACING_BACK);
    set.set(CameraCharacteristics.LENS_INTRINSIC_CALIBRATION,
        new float[] {1012.4f, 1011.6f, 643.7f, 477.3f, 0f});
    set.set(CameraCharacteristics.LENS_DISTORTION,
        new float[] {0.112f, -0.238f, 0.121f, 0.0006f, -0.0004f});
    return camera;
  }

  private static FakeImage image(Path file, long timestamp) throws IOException {
    BufferedImage picture = ImageIO.read(file.toFile());
    ByteBuffer luma = ByteBuffer.allocateDirect(WIDTH * HEIGHT);
    int[] row = new int[WIDTH];
    for (int y = 0; y < HEIGHT; ++y) {
      picture.getRGB(0, y, WIDTH, 1, row, 0, WIDTH);
      for (int argb : row) luma.put((byte) (argb >> 8));
    }
    luma.rewind();
    return new FakeImage(ImageFormat.YUV_420_888, WIDTH, HEIGHT, timestamp, luma, WIDTH, 1);
  }

  private static long gps(GnssMeasurementsEvent epoch) {
    return epoch.getClock().getTimeNanos() - epoch.getClock().getFullBiasNanos();
  }

  /** Phone to world, of a camera that world to camera is known of: x, y, z, w. */
  private static float[] rotation(String[] pose) {
    double w = Double.parseDouble(pose[1]);
    double x = Double.parseDouble(pose[2]);
    double y = Double.parseDouble(pose[3]);
    double z = Double.parseDouble(pose[4]);
    // The camera is the phone turned by half a turn about x: (0, 1, 0, 0) times the pose, inverted.
    return new float[] {(float) -w, (float) z, (float) -y, (float) -x};
  }

  private static Map<String, String[]> poses() throws IOException {
    Map<String, String[]> poses = new HashMap<>();
    for (String line : Files.readAllLines(SQUARE.resolve("cam0/poses.csv")))
      poses.put(line.substring(0, line.indexOf(',')), line.split(","));
    return poses;
  }

  private void feed(SensorFeed feed) throws IOException {
    Map<String, String[]> poses = poses();
    List<String> photographs = Files.readAllLines(SQUARE.resolve("cam0/data.csv"));
    int next = 1;
    for (GnssMeasurementsEvent epoch : epochs) {
      if (next > PHOTOGRAPHS)
        return;
      feed.onGnssMeasurements(epoch);
      fixes.await();
      long gpsMinusBoot = gps(epoch) - epoch.getClock().getElapsedRealtimeNanos();
      while (next < photographs.size()) {
        String[] cells = photographs.get(next).split(",");
        long taken = Long.parseLong(cells[0]);
        if (taken >= gps(epoch) + 1_000_000_000L)
          break;
        long boot = taken - gpsMinusBoot;
        CaptureResult capture = ShadowCaptureResult.newCaptureResult();
        Shadows.<ShadowCaptureResult>shadowOf(capture).set(CaptureResult.SENSOR_TIMESTAMP, boot);
        feed.onSample(Sensor.TYPE_GAME_ROTATION_VECTOR, boot, rotation(poses.get(cells[1])));
        assertTrue(fixes.problems.toString(),
            feed.onImage(image(SQUARE.resolve("cam0").resolve(cells[1]), boot), capture, camera()));
        fixes.await();
        ++next;
      }
    }
  }

  @Test
  public void theSquareIsRecognisedAndItsRecordingToo() throws Exception {
    LoggedEvents.read(SQUARE.resolve("gnss_log.txt"), epochs::add, message -> {});
    Path map = folder.getRoot().toPath().resolve("square.map");
    Recorded.command("map", "build", "--images", SQUARE.resolve("database").toString(), "--poses",
        SQUARE.resolve("database/poses.csv").toString(), "--camera",
        SQUARE.resolve("database/camera.json").toString(), "--origin", "30.5287,114.3561,24",
        "--out", map.toString());
    Path recording = folder.getRoot().toPath().resolve("recording");
    byte[] orbits = Files.readAllBytes(SQUARE.resolve("navigation.rnx"));
    try (FeatureMap landmarks = FeatureMap.open(map);
        PositioningSession session = PositioningSession.builder().timeBase(TimeBase.BOOT).open();
        GnssLogWriter log = GnssLogWriter.create(recording.toFile(), orbits);
        SensorFeed feed = SensorFeed.builder(Phone.app(), session)
            .withoutCallbacks()
            .listener(fixes)
            .log(log)
            .build()) {
      session.pushNavigation("navigation.rnx", orbits);
      session.useMap(landmarks);
      feed.start();
      feed(feed);
    }
    int used = 0;
    for (Estimate estimate : fixes.estimates) {
      if (estimate.getPhoto() == PhotoOutcome.USED)
        ++used;
    }
    assertTrue("photographs used: " + used + " " + fixes.problems, used >= PHOTOGRAPHS);
    List<String[]> rows = Recorded.replay(
        folder.getRoot().toPath().resolve("run"), recording.toString(), "--map", map.toString());
    fixes.assertAre(rows);
  }
}
