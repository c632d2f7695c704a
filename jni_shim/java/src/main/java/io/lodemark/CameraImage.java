package io.lodemark;

import java.nio.ByteBuffer;
import java.util.Objects;

/**
 * A photograph and how it was taken: grey, 8 bits a pixel, such as the first plane of YUV_420_888.
 * It refers to the pixels, which are copied when it is pushed.
 */
public final class CameraImage {
  private final Lens lens;
  private final ByteBuffer pixels;
  private final long size;
  private final long strideBytes;
  private final ByteBuffer frame = Struct.of(Layout.Frame.SIZE);

  /**
   * A photograph of which nothing is known but its lens.
   *
   * @param lens that took it; its size is the photograph's
   * @param pixels a direct buffer; the first row begins at its position
   * @param strideBytes from one row to the next
   */
  public CameraImage(Lens lens, ByteBuffer pixels, long strideBytes) {
    this.lens = Objects.requireNonNull(lens, "lens");
    this.strideBytes = strideBytes;
    size = lens.imageBytes(strideBytes);
    this.pixels = Pixels.direct(pixels, size, "pixels");
  }

  /**
   * When it was taken.
   *
   * @param timeNanos the middle of the exposure in the session's base
   * @return this
   */
  public CameraImage setTimeNanos(long timeNanos) {
    frame.putLong(Layout.Frame.TIME_NS, timeNanos);
    return this;
  }

  /**
   * How it was held.
   *
   * @param upInCamera what an accelerometer at rest measures, in camera axes, of any length
   * @param sigmaDegrees standard deviation of this direction
   * @return this
   */
  public CameraImage setGravity(double[] upInCamera, double sigmaDegrees) {
    Struct.putDoubles(
        frame, Layout.Frame.UP_IN_CAMERA, Struct.checked(upInCamera, 3, "upInCamera"));
    frame.putDouble(Layout.Frame.UP_SIGMA_DEG, sigmaDegrees);
    Struct.setBit(frame, Layout.Frame.PRESENT, Values.FRAME_HAS_GRAVITY);
    return this;
  }

  /**
   * Where it looks.
   *
   * @param headingDegrees of the optical axis, clockwise from north
   * @param sigmaDegrees standard deviation of the heading
   * @return this
   */
  public CameraImage setHeading(double headingDegrees, double sigmaDegrees) {
    frame.putDouble(Layout.Frame.HEADING_DEG, headingDegrees);
    frame.putDouble(Layout.Frame.HEADING_SIGMA_DEG, sigmaDegrees);
    Struct.setBit(frame, Layout.Frame.PRESENT, Values.FRAME_HAS_HEADING);
    return this;
  }

  /**
   * How the camera sits in the device whose inertial sensors the session is fed with. Where nothing
   * is set of how it was held ({@link #setGravity}), samples of the accelerometer around the
   * exposure then tell what is up.
   *
   * @param wxyz unit quaternion that turns axes of the sensors (of a phone: x to the right and y up
   *     along the screen, z out of it) into those of the camera (x right and y down in the
   *     photograph, z forward). Of a phone's back camera: 0, cos(a / 2), -sin(a / 2), 0 with a
   *     Android's SENSOR_ORIENTATION
   * @return this
   */
  public CameraImage setCameraFromDevice(double[] wxyz) {
    Struct.putDoubles(frame, Layout.Frame.CAMERA_FROM_DEVICE, Struct.checked(wxyz, 4, "wxyz"));
    Struct.setBit(frame, Layout.Frame.PRESENT, Values.FRAME_HAS_CAMERA_FROM_DEVICE);
    return this;
  }

  Lens lens() {
    return lens;
  }

  ByteBuffer pixels() {
    return pixels;
  }

  long size() {
    return size;
  }

  long strideBytes() {
    return strideBytes;
  }

  ByteBuffer frame() {
    return frame;
  }
}
