package io.lodemark.android;

import android.graphics.Bitmap;
import android.graphics.BitmapFactory;
import android.graphics.ImageFormat;
import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CameraMetadata;
import android.hardware.camera2.CaptureResult;
import android.media.Image;
import io.lodemark.Lens;
import java.nio.ByteBuffer;

/** A copy of a photograph in grey, row after row without gaps, and how it was taken. */
final class Photo {
  /** The library looks at no more: 1600 pixels along the longer side. */
  private static final int LONG_ENOUGH = 1600;

  final ByteBuffer pixels;
  final int width;
  final int height;
  final Lens lens;
  final long bootNanos; // of the middle of the exposure, in the middle row
  final int sensorOrientation;
  final boolean front;
  final double[] cameraFromDevice; // quaternion w, x, y, z; null if not known

  private Photo(ByteBuffer pixels, int width, int height, Lens lens, CaptureResult capture,
      CameraCharacteristics camera) {
    this.pixels = pixels;
    this.width = width;
    this.height = height;
    this.lens = lens;
    long start = orZero(capture.get(CaptureResult.SENSOR_TIMESTAMP)); // of the first row
    long exposure = orZero(capture.get(CaptureResult.SENSOR_EXPOSURE_TIME));
    long skew = orZero(capture.get(CaptureResult.SENSOR_ROLLING_SHUTTER_SKEW));
    bootNanos = start + (exposure + skew) / 2;
    Integer orientation = camera.get(CameraCharacteristics.SENSOR_ORIENTATION);
    sensorOrientation = orientation == null ? 0 : orientation;
    Integer facing = camera.get(CameraCharacteristics.LENS_FACING);
    front = facing != null && facing == CameraMetadata.LENS_FACING_FRONT;
    cameraFromDevice = CameraAxes.fromDevice(camera, capture);
  }

  /** Why it cannot be used, and what to do about it; null if it can. */
  static String problem(Image image, CaptureResult capture, CameraCharacteristics camera) {
    int format = image.getFormat();
    if (format != ImageFormat.YUV_420_888 && format != ImageFormat.JPEG) {
      return "Photographs of format " + format
          + " cannot be used: open the ImageReader with ImageFormat.YUV_420_888.";
    }
    Integer source = camera.get(CameraCharacteristics.SENSOR_INFO_TIMESTAMP_SOURCE);
    if (source == null || source != CameraMetadata.SENSOR_INFO_TIMESTAMP_SOURCE_REALTIME) {
      return "This camera's times are not those since boot (SENSOR_INFO_TIMESTAMP_SOURCE is not "
          + "REALTIME), so nobody knows where the phone was when its photographs were taken: use "
          + "another camera of the phone.";
    }
    Long taken = capture.get(CaptureResult.SENSOR_TIMESTAMP);
    if (taken == null || taken != image.getTimestamp()) {
      return "A CaptureResult belongs to another photograph: pair each Image with the "
          + "TotalCaptureResult whose SENSOR_TIMESTAMP is the Image's getTimestamp().";
    }
    return null;
  }

  /**
   * Null if it cannot be decoded or nothing is known of its lens.
   *
   * @param known the lens, or null to believe what the camera says
   */
  static Photo copy(Image image, CaptureResult capture, CameraCharacteristics camera, Lens known) {
    Grey grey = image.getFormat() == ImageFormat.JPEG ? decode(image.getPlanes()[0].getBuffer())
                                                      : luma(image);
    if (grey == null)
      return null;
    Lens lens = known != null ? known : CameraLens.of(camera, capture, grey.width, grey.height);
    if (lens == null || lens.getWidthPixels() != grey.width
        || lens.getHeightPixels() != grey.height)
      return null;
    return new Photo(grey.pixels, grey.width, grey.height, lens, capture, camera);
  }

  /** A picture without gaps. */
  private static final class Grey {
    final ByteBuffer pixels;
    final int width;
    final int height;

    Grey(int width, int height) {
      this.width = width;
      this.height = height;
      pixels = ByteBuffer.allocateDirect(width * height);
    }
  }

  private static Grey luma(Image image) {
    Image.Plane plane = image.getPlanes()[0];
    int rowStride = plane.getRowStride();
    int pixelStride = plane.getPixelStride();
    Grey grey = new Grey(image.getWidth(), image.getHeight());
    ByteBuffer from = plane.getBuffer().duplicate();
    int first = from.position();
    for (int y = 0; y < grey.height; ++y) {
      if (pixelStride == 1) {
        from.limit(first + y * rowStride + grey.width).position(first + y * rowStride);
        grey.pixels.put(from);
      } else {
        for (int x = 0; x < grey.width; ++x)
          grey.pixels.put(from.get(first + y * rowStride + x * pixelStride));
      }
    }
    grey.pixels.rewind();
    return grey;
  }

  private static Grey decode(ByteBuffer jpeg) {
    byte[] bytes = new byte[jpeg.remaining()];
    jpeg.duplicate().get(bytes);
    BitmapFactory.Options options = new BitmapFactory.Options();
    options.inJustDecodeBounds = true;
    BitmapFactory.decodeByteArray(bytes, 0, bytes.length, options);
    options.inJustDecodeBounds = false;
    options.inSampleSize = 1;
    int longest = Math.max(options.outWidth, options.outHeight);
    while (longest / (2 * options.inSampleSize) >= LONG_ENOUGH) options.inSampleSize *= 2;
    Bitmap bitmap = BitmapFactory.decodeByteArray(bytes, 0, bytes.length, options);
    if (bitmap == null)
      return null;
    Grey grey = new Grey(bitmap.getWidth(), bitmap.getHeight());
    int[] row = new int[grey.width];
    for (int y = 0; y < grey.height; ++y) {
      bitmap.getPixels(row, 0, grey.width, 0, y, grey.width, 1);
      for (int argb : row) {
        // ITU-R BT.601, in 256ths.
        int sum = 77 * (argb >> 16 & 0xFF) + 150 * (argb >> 8 & 0xFF) + 29 * (argb & 0xFF);
        grey.pixels.put((byte) (sum + 128 >> 8));
      }
    }
    grey.pixels.rewind();
    bitmap.recycle();
    return grey;
  }

  private static long orZero(Long value) {
    return value == null ? 0 : value;
  }
}
