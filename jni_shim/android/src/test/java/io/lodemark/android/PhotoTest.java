package io.lodemark.android;

import static org.junit.Assert.assertArrayEquals;
import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertFalse;
import static org.junit.Assert.assertNull;
import static org.junit.Assert.assertTrue;

import android.graphics.ImageFormat;
import android.graphics.Rect;
import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CameraMetadata;
import android.hardware.camera2.CaptureResult;
import android.media.FakeImage;
import android.media.Image;
import io.lodemark.Lens;
import java.awt.image.BufferedImage;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.nio.file.Path;
import javax.imageio.ImageIO;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.Shadows;
import org.robolectric.annotation.Config;
import org.robolectric.annotation.GraphicsMode;
import org.robolectric.shadows.ShadowCameraCharacteristics;

/** What is made of an Image and of what Android says of its camera. */
@RunWith(RobolectricTestRunner.class)
@Config(sdk = 34, manifest = Config.NONE)
@GraphicsMode(GraphicsMode.Mode.NATIVE) // Android's own decoder
public class PhotoTest {
  private static final CameraCharacteristics CAMERA = Phone.camera(true, true);

  /** Two rows of three pixels 10 .. 15, with gaps of 99 between rows or pixels. */
  private static Image image(int rowStride, int pixelStride, long timestamp) {
    ByteBuffer bytes = ByteBuffer.allocateDirect(rowStride + 3 * pixelStride);
    for (int i = 0; i < bytes.capacity(); ++i) bytes.put(i, (byte) 99);
    for (int i = 0; i < 6; ++i) bytes.put(i / 3 * rowStride + i % 3 * pixelStride, (byte) (10 + i));
    return new FakeImage(ImageFormat.YUV_420_888, 3, 2, timestamp, bytes, rowStride, pixelStride);
  }

  private static byte[] bytes(ByteBuffer buffer) {
    byte[] bytes = new byte[buffer.remaining()];
    buffer.duplicate().get(bytes);
    return bytes;
  }

  @Test
  public void lumaIsCopiedWithoutGaps() {
    CaptureResult capture = Phone.capture(Phone.TAKEN);
    for (Image image : new Image[] {
             image(8, 1, Phone.TAKEN), image(3, 1, Phone.TAKEN), image(16, 2, Phone.TAKEN)}) {
      assertNull(Photo.problem(image, capture, CAMERA));
      Photo photo = Photo.copy(image, capture, CAMERA, null);
      assertArrayEquals(new byte[] {10, 11, 12, 13, 14, 15}, bytes(photo.pixels));
      assertTrue(photo.pixels.isDirect());
    }
  }

  @Test
  public void itsTimeIsTheMiddleOfTheExposureInTheMiddleRow() {
    CaptureResult capture = Phone.capture(Phone.TAKEN);
    Photo photo = Photo.copy(image(3, 1, Phone.TAKEN), capture, CAMERA, null);
    assertEquals(Phone.TAKEN + Phone.EXPOSURE / 2 + Phone.SKEW / 2, photo.bootNanos);
  }

  @Test
  public void aTimeThatIsNotSinceBootIsNotTrusted() {
    String problem = Photo.problem(
        image(3, 1, Phone.TAKEN), Phone.capture(Phone.TAKEN), Phone.camera(false, true));
    assertTrue(problem, problem.contains("REALTIME"));
    problem = Photo.problem(image(3, 1, Phone.TAKEN), Phone.capture(Phone.TAKEN + 1), CAMERA);
    assertTrue(problem, problem.contains("TotalCaptureResult"));
  }

  @Test
  public void otherFormatsAreRefused() {
    Image raw = new FakeImage(
        ImageFormat.RAW_SENSOR, 3, 2, Phone.TAKEN, ByteBuffer.allocateDirect(12), 6, 2);
    String problem = Photo.problem(raw, Phone.capture(Phone.TAKEN), CAMERA);
    assertTrue(problem, problem.contains("YUV_420_888"));
  }

  @Test
  public void theLensIsScaledToThePhotograph() {
    Lens lens = CameraLens.of(CAMERA, Phone.capture(Phone.TAKEN), 1000, 750);
    double[] k = lens.getIntrinsics();
    assertEquals(750.0, k[0], 1e-9);
    assertEquals(752.5, k[1], 1e-9);
    // The corner of the array is half a pixel from the centre of its first one.
    assertEquals(2000.5 / 4 - 0.5, k[2], 1e-9);
    assertEquals(1490.5 / 4 - 0.5, k[3], 1e-9);
    // k1 k2 p1 p2 k3 of Android's k1 k2 k3 p1 p2.
    assertArrayEquals(new double[] {0.1f, -0.2f, 0.001f, 0.002f, 0.03f},
        new double[] {k[4], k[5], k[6], k[7], k[8]}, 0);
  }

  @Test
  public void aWiderPhotographShowsTheMiddle() {
    // 16:9 of 4:3: 4000 x 2250 in the middle, 375 rows cut above and below.
    double[] k = CameraLens.of(CAMERA, Phone.capture(Phone.TAKEN), 1600, 900).getIntrinsics();
    assertEquals(0.4 * 3000, k[0], 1e-9);
    assertEquals(0.4 * 2000.5 - 0.5, k[2], 1e-9);
    assertEquals(0.4 * (1490.5 - 375) - 0.5, k[3], 1e-9);
  }

  @Test
  public void zoomIsACrop() {
    CaptureResult capture = Phone.capture(Phone.TAKEN, new Rect(1000, 750, 3000, 2250));
    double[] k = CameraLens.of(CAMERA, capture, 1000, 750).getIntrinsics();
    assertEquals(0.5 * 3000, k[0], 1e-9);
    assertEquals(0.5 * 1000.5 - 0.5, k[2], 1e-9);
    assertEquals(0.5 * 740.5 - 0.5, k[3], 1e-9);
  }

  @Test
  public void aCorrectedPhotographHasNoDistortion() {
    CaptureResult capture = Phone.capture(Phone.TAKEN);
    Shadows.shadowOf(capture).set(
        CaptureResult.DISTORTION_CORRECTION_MODE, CameraMetadata.DISTORTION_CORRECTION_MODE_FAST);
    double[] k = CameraLens.of(CAMERA, capture, 1000, 750).getIntrinsics();
    assertEquals(750.0, k[0], 1e-9);
    assertEquals(0.0, k[4], 0);
  }

  @Test
  public void aCameraWithoutCalibrationHasItsFocalLength() {
    CameraCharacteristics plain = Phone.camera(true, false);
    CaptureResult capture = Phone.capture(Phone.TAKEN);
    assertFalse(CameraLens.isCalibrated(plain, capture));
    double[] k = CameraLens.of(plain, capture, 1000, 750).getIntrinsics();
    assertEquals(4.8 / 6.4 * 1000, k[0], 1e-3);
    assertEquals(499.5, k[2], 1e-9);
  }

  @Test
  public void tiltTellsWhatIsUpInThePhotograph() {
    Tilt tilt = new Tilt();
    // Upright, screen to the user: turned by 90 degrees about x from lying on its back.
    float half = (float) Math.sqrt(0.5);
    tilt.add(1_000_000_000L, half, 0, 0, half);
    // A sensor that is mounted upright has its rows downwards; one at 90 has its columns so.
    assertArrayEquals(new double[] {0, -1, 0}, tilt.upInCamera(1_000_000_000L, 0, false), 1e-6);
    assertArrayEquals(new double[] {-1, 0, 0}, tilt.upInCamera(1_000_000_000L, 90, false), 1e-6);
    assertArrayEquals(new double[] {1, 0, 0}, tilt.upInCamera(1_000_000_000L, 270, false), 1e-6);
    assertArrayEquals(new double[] {0, -1, 0}, tilt.upInCamera(1_000_000_000L, 0, true), 1e-6);
    // Flat on a table, the screen up: the camera in the back looks down.
    tilt.add(2_000_000_000L, 0, 0, 0, 1);
    assertArrayEquals(new double[] {0, 0, -1}, tilt.upInCamera(2_000_000_000L, 90, false), 1e-6);
    assertArrayEquals(new double[] {0, 0, 1}, tilt.upInCamera(2_000_000_000L, 90, true), 1e-6);
    assertNull(tilt.upInCamera(3_000_000_000L, 90, false));
  }

  /** The vector turned by a quaternion w, x, y, z. */
  private static double[] turned(double[] q, double... v) {
    double[] t = new double[3];
    double[] out = new double[3];
    for (int i = 0; i < 3; ++i) {
      int j = (i + 1) % 3;
      int k = (i + 2) % 3;
      t[i] = 2 * (q[1 + j] * v[k] - q[1 + k] * v[j]);
    }
    for (int i = 0; i < 3; ++i) {
      int j = (i + 1) % 3;
      int k = (i + 2) % 3;
      out[i] = v[i] + q[0] * t[i] + q[1 + j] * t[k] - q[1 + k] * t[j];
    }
    return out;
  }

  private static double[] axes(CameraCharacteristics camera) {
    Photo photo = Photo.copy(image(3, 1, Phone.TAKEN), Phone.capture(Phone.TAKEN), camera, null);
    return photo.cameraFromDevice;
  }

  @Test
  public void aBackCameraLooksOutOfThePhonesBack() {
    double[] back = axes(CAMERA); // a phone's usual: turned by 90
    assertArrayEquals(new double[] {0, 0, -1}, turned(back, 0, 0, 1), 1e-9);
    // Up along the screen is at the left of such a photograph; to the right on it is up.
    assertArrayEquals(new double[] {-1, 0, 0}, turned(back, 0, 1, 0), 1e-9);
    assertArrayEquals(new double[] {0, -1, 0}, turned(back, 1, 0, 0), 1e-9);
  }

  @Test
  public void theAxesAndTheTiltSayTheSame() {
    Tilt tilt = new Tilt();
    float norm = (float) Math.sqrt(0.1 * 0.1 + 0.5 * 0.5 + 0.3 * 0.3 + 0.8 * 0.8);
    double[] q = {0.8 / norm, -0.1 / norm, 0.5 / norm, 0.3 / norm};
    tilt.add(1_000_000_000L, (float) q[1], (float) q[2], (float) q[3], (float) q[0]);
    double[] up = turned(new double[] {q[0], -q[1], -q[2], -q[3]}, 0, 0, 1); // in the phone
    for (boolean front : new boolean[] {false, true}) {
      for (int orientation = 0; orientation < 360; orientation += 90) {
        assertArrayEquals(tilt.upInCamera(1_000_000_000L, orientation, front),
            turned(CameraAxes.mounted(orientation, front), up[0], up[1], up[2]), 1e-6);
      }
    }
  }

  @Test
  public void aStatedRotationIsBelievedIfItFits() {
    CameraCharacteristics camera = Phone.camera(true, true);
    double tilted = Math.toRadians(2); // about the camera's x axis
    double half = Math.sqrt(0.5);
    float[] stated = {(float) (half * Math.cos(tilted / 2)), (float) (-half * Math.cos(tilted / 2)),
        (float) (-half * Math.sin(tilted / 2)), (float) (-half * Math.sin(tilted / 2))};
    Shadows.shadowOf(camera).set(CameraCharacteristics.LENS_POSE_ROTATION, stated);
    double[] axis = turned(axes(camera), 0, 0, -1);
    assertEquals(Math.cos(tilted), axis[2], 1e-6);
    assertEquals(Math.sin(tilted), Math.hypot(axis[0], axis[1]), 1e-6);
    // Of axes that are not the sensors', nonsense, or none at all: as the sensor is mounted.
    Shadows.shadowOf(camera).set(
        CameraCharacteristics.LENS_POSE_REFERENCE, CameraMetadata.LENS_POSE_REFERENCE_UNDEFINED);
    assertArrayEquals(axes(CAMERA), axes(camera), 0);
    for (float[] nonsense :
        new float[][] {{0, 0, 0, 1}, {0, 0, 0, 0}, {Float.NaN, 0, 0, 1}, {1, 0}}) {
      CameraCharacteristics other = Phone.camera(true, true);
      Shadows.shadowOf(other).set(CameraCharacteristics.LENS_POSE_ROTATION, nonsense);
      assertArrayEquals(axes(CAMERA), axes(other), 0);
    }
  }

  @Test
  public void anExternalCameraMayBeHeldAnywhere() {
    CameraCharacteristics camera = ShadowCameraCharacteristics.newCameraCharacteristics();
    CaptureResult capture = Phone.capture(Phone.TAKEN);
    assertNull(CameraAxes.fromDevice(camera, capture)); // nor one that says nothing
    Shadows.shadowOf(camera).set(CameraCharacteristics.SENSOR_ORIENTATION, 0);
    assertNull(CameraAxes.fromDevice(camera, capture));
    Shadows.shadowOf(camera).set(
        CameraCharacteristics.LENS_FACING, CameraMetadata.LENS_FACING_EXTERNAL);
    assertNull(CameraAxes.fromDevice(camera, capture));
  }

  @Test
  public void aJpegIsDecodedToGrey() throws Exception {
    Path file = Recorded.ROOT.resolve("sample_logs/square/cam0/0001.jpg");
    ByteBuffer jpeg = ByteBuffer.wrap(Files.readAllBytes(file));
    Image image = new FakeImage(ImageFormat.JPEG, 1280, 960, Phone.TAKEN, jpeg, 0, 0);
    Photo photo = Photo.copy(image, Phone.capture(Phone.TAKEN), CAMERA, null);
    assertEquals(1280, photo.width);
    assertEquals(960, photo.lens.getHeightPixels());
    // Another decoder's colours, weighed alike: at most rounding apart.
    BufferedImage other = ImageIO.read(file.toFile());
    for (int i = 0; i < 1280 * 960; i += 997) {
      int argb = other.getRGB(i % 1280, i / 1280);
      double grey =
          0.299 * (argb >> 16 & 0xFF) + 0.587 * (argb >> 8 & 0xFF) + 0.114 * (argb & 0xFF);
      assertEquals("pixel " + i, grey, photo.pixels.get(i) & 0xFF, 6.0);
    }
    ByteBuffer noise = ByteBuffer.wrap(new byte[1000]);
    Image garbage = new FakeImage(ImageFormat.JPEG, 1280, 960, Phone.TAKEN, noise, 0, 0);
    assertNull(Photo.copy(garbage, Phone.capture(Phone.TAKEN), CAMERA, null));
  }
}
