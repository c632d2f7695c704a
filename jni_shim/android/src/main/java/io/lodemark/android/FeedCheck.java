package io.lodemark.android;

import android.Manifest;
import android.content.Context;
import android.content.pm.PackageManager;
import android.hardware.Sensor;
import android.hardware.SensorManager;
import android.location.GnssCapabilities;
import android.location.LocationManager;
import android.os.Build;
import java.util.ArrayList;
import java.util.Collections;
import java.util.List;

/** Whether this phone and this app can feed a session, in sentences that say what to do. */
public final class FeedCheck {
  /** Receivers built before 2016 give no raw measurements. */
  private static final int FIRST_YEAR = 2016;

  private final List<String> obstacles = new ArrayList<>();
  private final List<String> warnings = new ArrayList<>();

  private FeedCheck() {}

  /**
   * Looks at permissions, settings, receiver and sensors as they are now.
   *
   * @param context of the app
   * @return what was found
   */
  public static FeedCheck of(Context context) {
    FeedCheck check = new FeedCheck();
    check.lookAtPermission(context);
    check.lookAtReceiver(context);
    check.lookAtSensors(context);
    return check;
  }

  /**
   * What keeps the feed from starting.
   *
   * @return sentences to be shown; empty if it can start
   */
  public List<String> getObstacles() {
    return Collections.unmodifiableList(obstacles);
  }

  /**
   * What makes positions worse than they could be.
   *
   * @return sentences to be shown; empty if all is there
   */
  public List<String> getWarnings() {
    return Collections.unmodifiableList(warnings);
  }

  private void lookAtPermission(Context context) {
    if (context.checkSelfPermission(Manifest.permission.ACCESS_FINE_LOCATION)
        == PackageManager.PERMISSION_GRANTED)
      return;
    obstacles.add("The app may not use precise location: declare "
        + "android.permission.ACCESS_FINE_LOCATION in its manifest and ask for it with "
        + "requestPermissions() before the start. Approximate location is not enough.");
  }

  private void lookAtReceiver(Context context) {
    LocationManager location = context.getSystemService(LocationManager.class);
    if (location == null || !location.getAllProviders().contains(LocationManager.GPS_PROVIDER)) {
      obstacles.add("This device has no satellite receiver: use another one.");
      return;
    }
    if (!location.isProviderEnabled(LocationManager.GPS_PROVIDER)) {
      obstacles.add("Location is switched off: ask the user to switch it on, in "
          + "Settings.ACTION_LOCATION_SOURCE_SETTINGS.");
    }
    int year = location.getGnssYearOfHardware(); // 0: not known
    if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.S) {
      GnssCapabilities capabilities = location.getGnssCapabilities();
      if (capabilities == null) {
        return;
      } else if (!capabilities.hasMeasurements()) {
        warnings.add("The receiver does not say that it gives raw measurements: if no epoch "
            + "comes under open sky, this device cannot be used.");
      } else if (!capabilities.hasNavigationMessages()) {
        warnings.add("The receiver gives no navigation messages: push ephemerides from a server "
            + "with PositioningSession.pushNavigation().");
      }
    } else if (year > 0 && year < FIRST_YEAR) {
      warnings.add("The receiver is of " + year + ", before raw measurements: if no epoch comes "
          + "under open sky, this device cannot be used.");
    }
  }

  private void lookAtSensors(Context context) {
    SensorManager sensors = context.getSystemService(SensorManager.class);
    String[] names = {"uncalibrated accelerometer", "uncalibrated gyroscope", "barometer",
        "game rotation vector"};
    for (int i = 0; i < names.length; ++i) {
      Sensor sensor =
          sensors == null ? null : sensors.getDefaultSensor(FrameworkSources.SENSOR_TYPES[i]);
      if (sensor == null)
        warnings.add("This device has no " + names[i] + ": the feed goes on without it.");
    }
  }
}
