package io.lodemark.android;

import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CameraMetadata;
import android.hardware.camera2.CaptureResult;

/**
 * How a camera sits in the phone: the turn from axes of the phone's sensors (x to the right and y
 * up along the screen, z out of it) to those of the camera (x right and y down in the photograph, z
 * forward).
 */
final class CameraAxes {
  /** A camera is mounted within this of SENSOR_ORIENTATION, or what it states is not believed. */
  private static final double MOST_DEGREES = 15.0;

  private CameraAxes() {}

  /** Quaternion w, x, y, z; null where the camera does not say how it is mounted. */
  static double[] fromDevice(CameraCharacteristics camera, CaptureResult capture) {
    Integer orientation = camera.get(CameraCharacteristics.SENSOR_ORIENTATION);
    Integer facing = camera.get(CameraCharacteristics.LENS_FACING);
    // An external one can be held anywhere.
    if (orientation == null || facing == null || facing == CameraMetadata.LENS_FACING_EXTERNAL)
      return null;
    double[] mounted = mounted(orientation, facing == CameraMetadata.LENS_FACING_FRONT);
    double[] stated = stated(camera, capture);
    return stated != null && degreesBetween(mounted, stated) < MOST_DEGREES ? stated : mounted;
  }

  /** By quarters of a turn, as SENSOR_ORIENTATION counts: clockwise until the photograph stands. */
  static double[] mounted(int orientation, boolean front) {
    double half = Math.toRadians(0.5 * orientation);
    return front ? new double[] {Math.sin(half), 0, 0, Math.cos(half)}
                 : new double[] {0, Math.cos(half), -Math.sin(half), 0};
  }

  /** LENS_POSE_ROTATION, which turns the same axes; null where it means nothing. */
  private static double[] stated(CameraCharacteristics camera, CaptureResult capture) {
    Integer reference = camera.get(CameraCharacteristics.LENS_POSE_REFERENCE);
    if (reference != null && reference != CameraMetadata.LENS_POSE_REFERENCE_PRIMARY_CAMERA
        && reference != CameraMetadata.LENS_POSE_REFERENCE_GYROSCOPE)
      return null;
    float[] xyzw = capture.get(CaptureResult.LENS_POSE_ROTATION);
    if (xyzw == null)
      xyzw = camera.get(CameraCharacteristics.LENS_POSE_ROTATION);
    if (xyzw == null || xyzw.length < 4)
      return null;
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += (double) xyzw[i] * xyzw[i];
    double norm = Math.sqrt(sum);
    if (!(Math.abs(norm - 1) < 0.01)) // not of a number, either
      return null;
    return new double[] {xyzw[3] / norm, xyzw[0] / norm, xyzw[1] / norm, xyzw[2] / norm};
  }

  private static double degreesBetween(double[] one, double[] other) {
    double dot = 0;
    for (int i = 0; i < 4; ++i) dot += one[i] * other[i];
    return Math.toDegrees(2 * Math.acos(Math.min(1, Math.abs(dot))));
  }
}
