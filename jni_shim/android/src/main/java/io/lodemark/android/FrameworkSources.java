package io.lodemark.android;

import android.content.Context;
import android.hardware.Sensor;
import android.hardware.SensorEvent;
import android.hardware.SensorEventListener;
import android.hardware.SensorManager;
import android.location.GnssMeasurementRequest;
import android.location.GnssMeasurementsEvent;
import android.location.GnssNavigationMessage;
import android.location.Location;
import android.location.LocationListener;
import android.location.LocationManager;
import android.os.Build;
import android.os.Bundle;
import android.os.Handler;

/** The framework's callbacks, on one thread, passed on to a feed. */
final class FrameworkSources {
  static final int[] SENSOR_TYPES = {Sensor.TYPE_ACCELEROMETER_UNCALIBRATED,
      Sensor.TYPE_GYROSCOPE_UNCALIBRATED, Sensor.TYPE_PRESSURE, Sensor.TYPE_GAME_ROTATION_VECTOR};

  /** 100 Hz; from 200 Hz on an app needs a permission of its own. */
  private static final int SAMPLING_MICROS = 10_000;
  private static final long EPOCH_MILLIS = 1000;

  private final LocationManager location;
  private final SensorManager sensors;
  private final SensorFeed feed;

  private final GnssMeasurementsEvent.Callback measurements = new GnssMeasurementsEvent.Callback() {
    @Override
    public void onGnssMeasurementsReceived(GnssMeasurementsEvent event) {
      feed.onGnssMeasurements(event);
    }
  };

  private final GnssNavigationMessage.Callback messages = new GnssNavigationMessage.Callback() {
    @Override
    public void onGnssNavigationMessageReceived(GnssNavigationMessage message) {
      feed.onNavigationMessage(message);
    }
  };

  private final SensorEventListener samples = new SensorEventListener() {
    @Override
    public void onSensorChanged(SensorEvent event) {
      feed.onSensorChanged(event);
    }

    @Override
    public void onAccuracyChanged(Sensor sensor, int accuracy) {}
  };

  // Many receivers measure only while somebody asks for locations.
  private final LocationListener locations = new LocationListener() {
    @Override
    public void onLocationChanged(Location ignored) {}

    // Before Android 11 these had no defaults.
    @Override
    public void onProviderEnabled(String provider) {}

    @Override
    public void onProviderDisabled(String provider) {
      feed.tell("Location was switched off: ask the user to switch it on again.");
    }

    @Override
    @Deprecated
    public void onStatusChanged(String provider, int status, Bundle extras) {}
  };

  FrameworkSources(Context context, SensorFeed feed) {
    location = context.getSystemService(LocationManager.class);
    sensors = context.getSystemService(SensorManager.class);
    this.feed = feed;
  }

  /** After FeedCheck found no obstacle. */
  @SuppressWarnings("MissingPermission")
  void register(Handler handler, boolean withSensors) {
    location.requestLocationUpdates(
        LocationManager.GPS_PROVIDER, EPOCH_MILLIS, 0f, locations, handler.getLooper());
    boolean registered;
    if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.S) {
      // Without pauses, so that the carrier phase holds from epoch to epoch.
      GnssMeasurementRequest request =
          new GnssMeasurementRequest.Builder().setFullTracking(true).build();
      registered = location.registerGnssMeasurementsCallback(request, handler::post, measurements);
    } else {
      registered = location.registerGnssMeasurementsCallback(measurements, handler);
    }
    if (!registered)
      feed.tell("The receiver refuses to give raw measurements: this device cannot be used.");
    if (!location.registerGnssNavigationMessageCallback(messages, handler)) {
      feed.tell("The receiver gives no navigation messages: push ephemerides from a server with "
          + "PositioningSession.pushNavigation().");
    }
    if (!withSensors || sensors == null)
      return;
    for (int type : SENSOR_TYPES) {
      Sensor sensor = sensors.getDefaultSensor(type);
      if (sensor != null)
        sensors.registerListener(samples, sensor, SAMPLING_MICROS, handler);
    }
  }

  void unregister() {
    if (sensors != null)
      sensors.unregisterListener(samples);
    location.unregisterGnssNavigationMessageCallback(messages);
    location.unregisterGnssMeasurementsCallback(measurements);
    location.removeUpdates(locations);
  }
}
