package io.lodemark.android;

import android.graphics.Rect;
import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CameraMetadata;
import android.hardware.camera2.CaptureResult;
import android.util.SizeF;
import io.lodemark.Lens;

/**
 * The lens of one photograph, from what Android says of the camera and of the capture. Android's
 * intrinsics count pixels of the sensor from the corner of its array (CameraCharacteristics,
 * LENS_INTRINSIC_CALIBRATION and LENS_DISTORTION); a lens of Lodemark counts those of the
 * photograph from the centre of the first one.
 */
final class CameraLens {
  private CameraLens() {}

  /** Whether the camera states its intrinsics, rather than its focal length only. */
  static boolean isCalibrated(CameraCharacteristics camera, CaptureResult capture) {
    return intrinsics(camera, capture) != null;
  }

  /** Null if not even the focal length is known. */
  static Lens of(CameraCharacteristics camera, CaptureResult capture, int width, int height) {
    Rect before = camera.get(CameraCharacteristics.SENSOR_INFO_PRE_CORRECTION_ACTIVE_ARRAY_SIZE);
    Rect after = camera.get(CameraCharacteristics.SENSOR_INFO_ACTIVE_ARRAY_SIZE);
    if (after == null || after.isEmpty() || width <= 0 || height <= 0)
      return null;
    if (before == null || before.isEmpty())
      before = after;
    Integer mode = capture.get(CaptureResult.DISTORTION_CORRECTION_MODE);
    boolean corrected = mode != null && mode != CameraMetadata.DISTORTION_CORRECTION_MODE_OFF;
    float[] stated = intrinsics(camera, capture);
    double[] k = stated == null ? fromFocalLength(camera, capture, before)
                                : new double[] {stated[0], stated[1], stated[2], stated[3]};
    if (k == null)
      return null;

    // What is cropped counts from the corner of the array before or after correction.
    Rect array = corrected ? after : before;
    double cx = k[2] + before.left - array.left;
    double cy = k[3] + before.top - array.top;
    Rect crop = capture.get(CaptureResult.SCALER_CROP_REGION);
    if (crop == null || crop.isEmpty())
      crop = new Rect(0, 0, array.width(), array.height());

    // A photograph of other proportions shows the middle of what is cropped.
    double scale = Math.max((double) width / crop.width(), (double) height / crop.height());
    double left = crop.left + 0.5 * (crop.width() - width / scale);
    double top = crop.top + 0.5 * (crop.height() - height / scale);
    double[] values = {scale * k[0], scale * k[1], scale * (cx - left) - 0.5,
        scale * (cy - top) - 0.5, 0, 0, 0, 0, 0};
    float[] distortion = corrected ? null : distortion(camera, capture);
    if (distortion == null)
      return Lens.pinhole(width, height, values[0], values[1], values[2], values[3]);
    values[4] = distortion[0]; // Android's radial three come first, OpenCV's third one last.
    values[5] = distortion[1];
    values[6] = distortion[3];
    values[7] = distortion[4];
    values[8] = distortion[2];
    return Lens.brown(width, height, values);
  }

  /** fx, fy, cx, cy, skew; null where the camera does not know or says nonsense. */
  private static float[] intrinsics(CameraCharacteristics camera, CaptureResult capture) {
    float[] stated = capture.get(CaptureResult.LENS_INTRINSIC_CALIBRATION);
    if (stated == null)
      stated = camera.get(CameraCharacteristics.LENS_INTRINSIC_CALIBRATION);
    return stated != null && stated.length >= 4 && stated[0] > 0 && stated[1] > 0 ? stated : null;
  }

  private static float[] distortion(CameraCharacteristics camera, CaptureResult capture) {
    float[] stated = capture.get(CaptureResult.LENS_DISTORTION);
    if (stated == null)
      stated = camera.get(CameraCharacteristics.LENS_DISTORTION);
    return stated != null && stated.length >= 5 ? stated : null;
  }

  /** From millimetres; the principal point is taken to be in the middle. */
  private static double[] fromFocalLength(
      CameraCharacteristics camera, CaptureResult capture, Rect array) {
    Float focal = capture.get(CaptureResult.LENS_FOCAL_LENGTH);
    SizeF sensor = camera.get(CameraCharacteristics.SENSOR_INFO_PHYSICAL_SIZE);
    android.util.Size pixels = camera.get(CameraCharacteristics.SENSOR_INFO_PIXEL_ARRAY_SIZE);
    if (focal == null || sensor == null || pixels == null || focal <= 0 || sensor.getWidth() <= 0
        || sensor.getHeight() <= 0)
      return null;
    return new double[] {focal * (double) pixels.getWidth() / sensor.getWidth(),
        focal * (double) pixels.getHeight() / sensor.getHeight(), 0.5 * array.width(),
        0.5 * array.height()};
  }
}
