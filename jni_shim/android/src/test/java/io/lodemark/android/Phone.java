package io.lodemark.android;

import android.Manifest;
import android.app.Application;
import android.graphics.Rect;
import android.hardware.Sensor;
import android.hardware.SensorManager;
import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CameraMetadata;
import android.hardware.camera2.CaptureResult;
import android.location.LocationManager;
import org.robolectric.RuntimeEnvironment;
import org.robolectric.Shadows;
import org.robolectric.shadows.ShadowCameraCharacteristics;
import org.robolectric.shadows.ShadowCaptureResult;
import org.robolectric.shadows.ShadowSensor;

/** A phone on which everything is there and allowed, and its camera. */
final class Phone {
  static final long TAKEN = 184_300_000_000_000L;
  static final long EXPOSURE = 8_000_000L;
  static final long SKEW = 20_000_000L;

  private Phone() {}

  static Application app() {
    return RuntimeEnvironment.getApplication();
  }

  static LocationManager location() {
    return app().getSystemService(LocationManager.class);
  }

  static void allow() {
    Shadows.shadowOf(app()).grantPermissions(Manifest.permission.ACCESS_FINE_LOCATION);
    Shadows.shadowOf(location()).setProviderEnabled(LocationManager.GPS_PROVIDER, true);
    SensorManager sensors = app().getSystemService(SensorManager.class);
    for (int type : FrameworkSources.SENSOR_TYPES)
      Shadows.shadowOf(sensors).addSensor(ShadowSensor.newInstance(type));
  }

  static Sensor sensor(int type) {
    return ShadowSensor.newInstance(type);
  }

  /** 4000 x 3000 pixels that tell their calibration and the time since boot, upright at 90. */
  static CameraCharacteristics camera(boolean timed, boolean calibrated) {
    CameraCharacteristics camera = ShadowCameraCharacteristics.newCameraCharacteristics();
    ShadowCameraCharacteristics set = Shadows.shadowOf(camera);
    set.set(CameraCharacteristics.SENSOR_INFO_TIMESTAMP_SOURCE,
        timed ? CameraMetadata.SENSOR_INFO_TIMESTAMP_SOURCE_REALTIME
              : CameraMetadata.SENSOR_INFO_TIMESTAMP_SOURCE_UNKNOWN);
    set.set(CameraCharacteristics.SENSOR_INFO_ACTIVE_ARRAY_SIZE, new Rect(0, 0, 4000, 3000));
    set.set(CameraCharacteristics.SENSOR_INFO_PRE_CORRECTION_ACTIVE_ARRAY_SIZE,
        new Rect(0, 0, 4000, 3000));
    set.set(CameraCharacteristics.SENSOR_ORIENTATION, 90);
    set.set(CameraCharacteristics.LENS_FACING, CameraMetadata.LENS_FACING_BACK);
    set.set(CameraCharacteristics.SENSOR_INFO_PHYSICAL_SIZE, new android.util.SizeF(6.4f, 4.8f));
    set.set(CameraCharacteristics.SENSOR_INFO_PIXEL_ARRAY_SIZE, new android.util.Size(4000, 3000));
    if (calibrated) {
      set.set(CameraCharacteristics.LENS_INTRINSIC_CALIBRATION,
          new float[] {3000f, 3010f, 2000.5f, 1490.5f, 0f});
      set.set(
          CameraCharacteristics.LENS_DISTORTION, new float[] {0.1f, -0.2f, 0.03f, 0.001f, 0.002f});
    }
    return camera;
  }

  static CaptureResult capture(long timestamp) {
    return capture(timestamp, new Rect(0, 0, 4000, 3000));
  }

  static CaptureResult capture(long timestamp, Rect crop) {
    CaptureResult capture = ShadowCaptureResult.newCaptureResult();
    ShadowCaptureResult set = Shadows.shadowOf(capture);
    set.set(CaptureResult.SENSOR_TIMESTAMP, timestamp);
    set.set(CaptureResult.SENSOR_EXPOSURE_TIME, EXPOSURE);
    set.set(CaptureResult.SENSOR_ROLLING_SHUTTER_SKEW, SKEW);
    set.set(CaptureResult.SCALER_CROP_REGION, crop);
    set.set(CaptureResult.LENS_FOCAL_LENGTH, 4.8f);
    return capture;
  }
}
