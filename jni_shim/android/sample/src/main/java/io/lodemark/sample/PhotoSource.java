package io.lodemark.sample;

import android.content.Context;
import android.graphics.ImageFormat;
import android.hardware.camera2.CameraAccessException;
import android.hardware.camera2.CameraCaptureSession;
import android.hardware.camera2.CameraCharacteristics;
import android.hardware.camera2.CameraDevice;
import android.hardware.camera2.CameraManager;
import android.hardware.camera2.CameraMetadata;
import android.hardware.camera2.CaptureRequest;
import android.hardware.camera2.CaptureResult;
import android.hardware.camera2.TotalCaptureResult;
import android.hardware.camera2.params.OutputConfiguration;
import android.hardware.camera2.params.SessionConfiguration;
import android.media.Image;
import android.media.ImageReader;
import android.os.Handler;
import android.os.HandlerThread;
import io.lodemark.android.SensorFeed;
import java.util.Collections;
import java.util.function.Consumer;

/** A photograph of the camera in the back each second, beside the result of its capture. */
final class PhotoSource {
  private static final int WIDTH = 1280;
  private static final int HEIGHT = 960;
  private static final long PERIOD_MILLIS = 1000;

  private final CameraManager manager;
  private final SensorFeed feed;
  private final Consumer<String> problems;
  private HandlerThread thread;
  private Handler handler;
  private CameraCharacteristics characteristics;
  private ImageReader reader;
  private CameraDevice device;
  private CameraCaptureSession captures;
  private Image image; // the latest, whose result has not come
  private CaptureResult result; // or the other way round

  PhotoSource(Context context, SensorFeed feed, Consumer<String> problems) {
    manager = context.getSystemService(CameraManager.class);
    this.feed = feed;
    this.problems = problems;
  }

  /** With the permission for the camera. */
  @SuppressWarnings("MissingPermission")
  void start() {
    if (thread != null)
      return;
    thread = new HandlerThread("camera");
    thread.start();
    handler = new Handler(thread.getLooper());
    try {
      for (String id : manager.getCameraIdList()) {
        CameraCharacteristics known = manager.getCameraCharacteristics(id);
        Integer facing = known.get(CameraCharacteristics.LENS_FACING);
        if (facing == null || facing != CameraMetadata.LENS_FACING_BACK)
          continue;
        characteristics = known;
        reader = ImageReader.newInstance(WIDTH, HEIGHT, ImageFormat.YUV_420_888, 3);
        reader.setOnImageAvailableListener(from -> take(from.acquireLatestImage()), handler);
        manager.openCamera(id, opened, handler);
        return;
      }
    } catch (CameraAccessException refusal) {
      problems.accept("The camera cannot be opened: " + refusal.getMessage());
    }
  }

  void stop() {
    if (thread == null)
      return;
    handler.post(() -> {
      if (device != null)
        device.close();
      if (image != null)
        image.close();
      if (reader != null)
        reader.close();
      device = null;
      captures = null;
      image = null;
      result = null;
      reader = null;
    });
    thread.quitSafely();
    thread = null;
  }

  private final CameraDevice.StateCallback opened = new CameraDevice.StateCallback() {
    @Override
    public void onOpened(CameraDevice camera) {
      device = camera;
      try {
        OutputConfiguration output = new OutputConfiguration(reader.getSurface());
        camera.createCaptureSession(new SessionConfiguration(SessionConfiguration.SESSION_REGULAR,
            Collections.singletonList(output), handler::post, configured));
      } catch (CameraAccessException refusal) {
        problems.accept("The camera cannot be used: " + refusal.getMessage());
      }
    }

    @Override
    public void onDisconnected(CameraDevice camera) {
      camera.close();
    }

    @Override
    public void onError(CameraDevice camera, int error) {
      camera.close();
      problems.accept("The camera failed with error " + error + ".");
    }
  };

  private final CameraCaptureSession.StateCallback configured =
      new CameraCaptureSession.StateCallback() {
        @Override
        public void onConfigured(CameraCaptureSession session) {
          captures = session;
          shoot();
        }

        @Override
        public void onConfigureFailed(CameraCaptureSession session) {
          problems.accept("The camera does not give photographs of this size.");
        }
      };

  private void shoot() {
    if (captures == null)
      return;
    try {
      CaptureRequest.Builder request = device.createCaptureRequest(CameraDevice.TEMPLATE_PREVIEW);
      request.addTarget(reader.getSurface());
      captures.capture(request.build(), new CameraCaptureSession.CaptureCallback() {
        @Override
        public void onCaptureCompleted(
            CameraCaptureSession session, CaptureRequest done, TotalCaptureResult completed) {
          result = completed;
          pair();
        }
      }, handler);
      handler.postDelayed(this::shoot, PERIOD_MILLIS);
    } catch (CameraAccessException refusal) {
      problems.accept("The camera cannot be used: " + refusal.getMessage());
    }
  }

  private void take(Image next) {
    if (next == null)
      return;
    if (image != null)
      image.close();
    image = next;
    pair();
  }

  /** Image and result of one capture come in either order. */
  private void pair() {
    Long taken = result == null ? null : result.get(CaptureResult.SENSOR_TIMESTAMP);
    if (image == null || taken == null || taken != image.getTimestamp())
      return;
    feed.onImage(image, result, characteristics);
    image.close();
    image = null;
    result = null;
  }
}
