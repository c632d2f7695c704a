package io.lodemark;

import java.nio.ByteBuffer;
import java.util.Arrays;

/**
 * A lens. Camera axes: x to the right, y down, z forward. Pixel (0, 0) is the centre of the upper
 * left pixel; x counts to the right, y down. Points that a lens converts come and go one after the
 * other in one array; where the lens model has no answer for a point, its values are NaN.
 */
public final class Lens {
  private static final int PINHOLE = 0;
  private static final int BROWN = 1;
  private static final int FISHEYE = 2;
  private static final int THIN_PRISM_FISHEYE = 3;

  // Of the models above, in camera.json, and how many coefficients each has.
  private static final String[] NAMES = {
      "PINHOLE", "OPENCV", "OPENCV_FISHEYE", "THIN_PRISM_FISHEYE"};
  private static final int[] COEFFICIENTS = {0, 14, 4, 8};

  private final ByteBuffer struct;

  private Lens(ByteBuffer struct) {
    this.struct = struct;
  }

  /**
   * A lens without distortion.
   *
   * @param widthPixels of its photographs
   * @param heightPixels of its photographs
   * @param fx focal length in columns
   * @param fy focal length in rows
   * @param cx column of the principal point
   * @param cy row of the principal point
   * @return the lens; what makes no sense is refused when it is used
   */
  public static Lens pinhole(
      int widthPixels, int heightPixels, double fx, double fy, double cx, double cy) {
    return of(PINHOLE, widthPixels, heightPixels, new double[] {fx, fy, cx, cy}, 0);
  }

  /**
   * A lens with Brown's distortion.
   *
   * @param widthPixels of its photographs
   * @param heightPixels of its photographs
   * @param intrinsics fx, fy, cx, cy, then k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y in the
   *     order of OpenCV, as many of these as are not 0
   * @return the lens; what makes no sense is refused when it is used
   */
  public static Lens brown(int widthPixels, int heightPixels, double... intrinsics) {
    return of(BROWN, widthPixels, heightPixels, intrinsics, 14);
  }

  /**
   * A fisheye lens after Kannala and Brandt.
   *
   * @param widthPixels of its photographs
   * @param heightPixels of its photographs
   * @param intrinsics fx, fy, cx, cy, then k1 k2 k3 k4, as many of these as are not 0
   * @return the lens; what makes no sense is refused when it is used
   */
  public static Lens fisheye(int widthPixels, int heightPixels, double... intrinsics) {
    return of(FISHEYE, widthPixels, heightPixels, intrinsics, 4);
  }

  /**
   * A fisheye lens with thin prism distortion.
   *
   * @param widthPixels of its photographs
   * @param heightPixels of its photographs
   * @param intrinsics fx, fy, cx, cy, then k1 k2 p1 p2 k3 k4 sx1 sy1, as many of these as are not 0
   * @return the lens; what makes no sense is refused when it is used
   */
  public static Lens thinPrismFisheye(int widthPixels, int heightPixels, double... intrinsics) {
    return of(THIN_PRISM_FISHEYE, widthPixels, heightPixels, intrinsics, 8);
  }

  private static Lens of(int model, int width, int height, double[] intrinsics, int coefficients) {
    if (intrinsics.length < 4 || intrinsics.length > 4 + coefficients) {
      throw new IllegalArgumentException("intrinsics has " + intrinsics.length + " values");
    }
    ByteBuffer struct = empty();
    struct.putInt(Layout.Lens.MODEL, model);
    struct.putInt(Layout.Lens.WIDTH_PX, width);
    struct.putInt(Layout.Lens.HEIGHT_PX, height);
    Struct.putDoubles(struct, Layout.Lens.FX_PX, intrinsics);
    return new Lens(struct);
  }

  static ByteBuffer empty() {
    return Struct.of(Layout.Lens.SIZE);
  }

  /** Of a struct that a native has filled and that nobody writes to any more. */
  static Lens of(ByteBuffer struct) {
    return new Lens(struct);
  }

  /**
   * The unit directions in camera axes that pixels look to.
   *
   * @param pixels x, y of each
   * @return x, y, z of each; NaN where the model images no single direction
   */
  public double[] unproject(double[] pixels) {
    return convert(pixels, 2, 3, Native::lensUnproject);
  }

  /**
   * The pixels at which points appear.
   *
   * @param points x, y, z of each in camera axes, of any length
   * @return x, y of each; NaN where the lens does not see it
   */
  public double[] project(double[] points) {
    return convert(points, 3, 2, Native::lensProject);
  }

  /**
   * Where pixels would be had the lens no distortion but the same fx, fy, cx, cy.
   *
   * @param pixels x, y of each
   * @return x, y of each; NaN where the model has no answer, and for what is not in front
   */
  public double[] undistort(double[] pixels) {
    return convert(pixels, 2, 2, Native::lensUndistortPoints);
  }

  /**
   * Width of its photographs.
   *
   * @return pixels
   */
  public int getWidthPixels() {
    return struct.getInt(Layout.Lens.WIDTH_PX);
  }

  /**
   * Height of its photographs.
   *
   * @return pixels
   */
  public int getHeightPixels() {
    return struct.getInt(Layout.Lens.HEIGHT_PX);
  }

  /**
   * fx, fy, cx, cy and the 14 coefficients, of which those that the model lacks are 0.
   *
   * @return 18 values
   */
  public double[] getIntrinsics() {
    return Struct.doubles(struct, Layout.Lens.FX_PX, 4 + Values.LENS_COEFFICIENTS);
  }

  /**
   * The content of a camera.json, as the command lodemark reads it.
   *
   * @return text in JSON
   */
  public String toJson() {
    int model = struct.getInt(Layout.Lens.MODEL);
    double[] values = getIntrinsics();
    StringBuilder json = new StringBuilder("{\n  \"model\": \"").append(NAMES[model]);
    json.append("\",\n  \"width_px\": ").append(getWidthPixels());
    json.append(",\n  \"height_px\": ").append(getHeightPixels());
    String[] names = {"fx_px", "fy_px", "cx_px", "cy_px"};
    for (int i = 0; i < names.length; ++i)
      json.append(",\n  \"").append(names[i]).append("\": ").append(values[i]);
    json.append(",\n  \"coefficients\": [");
    for (int i = 0; i < COEFFICIENTS[model]; ++i)
      json.append(i == 0 ? "" : ", ").append(values[names.length + i]);
    return json.append("]\n}\n").toString();
  }

  ByteBuffer struct() {
    return struct;
  }

  /**
   * Bytes from the first to the last pixel of a photograph, of which a buffer must hold as many.
   * At least 0, so that the library can say what is wrong with the lens.
   */
  long imageBytes(long strideBytes) {
    if (strideBytes < 0 || strideBytes > Integer.MAX_VALUE) {
      throw new IllegalArgumentException("strideBytes is that of no image: " + strideBytes);
    }
    long rows = Math.max(1, getHeightPixels());
    return (rows - 1) * strideBytes + Math.max(0, getWidthPixels());
  }

  /** A conversion of points, as the natives offer it. */
  private interface Conversion {
    int call(ByteBuffer lens, ByteBuffer from, int count, ByteBuffer to, ByteBuffer valid);
  }

  private double[] convert(double[] values, int from, int to, Conversion conversion) {
    if (values.length % from != 0) {
      throw new IllegalArgumentException(values.length + " values are not " + from + " for each");
    }
    int count = values.length / from;
    ByteBuffer in = Struct.bytes(8L * values.length);
    ByteBuffer out = Struct.bytes(8L * to * count);
    ByteBuffer valid = Struct.bytes(count);
    in.asDoubleBuffer().put(values);
    Native.check(conversion.call(struct, in, count, out, valid));
    double[] converted = new double[to * count];
    out.asDoubleBuffer().get(converted);
    for (int i = 0; i < count; ++i) {
      if (valid.get(i) == 0)
        Arrays.fill(converted, to * i, to * (i + 1), Double.NaN);
    }
    return converted;
  }
}
