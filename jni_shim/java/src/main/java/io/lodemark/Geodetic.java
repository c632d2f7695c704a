package io.lodemark;

import java.util.Locale;

/** A place as latitude, longitude and height, and conversions of places and times. */
public final class Geodetic {
  private final double latitudeDegrees;
  private final double longitudeDegrees;
  private final double heightMeters;

  /**
   * A place.
   *
   * @param latitudeDegrees WGS 84, -90 to 90
   * @param longitudeDegrees WGS 84, -360 to 360
   * @param heightMeters above the ellipsoid
   */
  public Geodetic(double latitudeDegrees, double longitudeDegrees, double heightMeters) {
    this.latitudeDegrees = latitudeDegrees;
    this.longitudeDegrees = longitudeDegrees;
    this.heightMeters = heightMeters;
  }

  /**
   * The place of earth-centred, earth-fixed coordinates.
   *
   * @param ecefMeters x, y, z
   * @return the place, with a longitude of -180 to 180
   */
  public static Geodetic fromEcef(double[] ecefMeters) {
    double[] values = Struct.checked(ecefMeters, 3, "ecefMeters").clone();
    Native.check(Native.geodeticFromEcef(values));
    return new Geodetic(values[0], values[1], values[2]);
  }

  /**
   * Its earth-centred, earth-fixed coordinates.
   *
   * @return x, y, z
   */
  public double[] toEcef() {
    double[] values = values();
    Native.check(Native.ecefFromGeodetic(values));
    return values;
  }

  /**
   * A point in the local frame of this place.
   *
   * @param ecefMeters x, y, z of the point
   * @return metres to the east, north and up
   */
  public double[] enuFromEcef(double[] ecefMeters) {
    double[] values = Struct.checked(ecefMeters, 3, "ecefMeters").clone();
    Native.check(Native.enuFromEcef(values(), values));
    return values;
  }

  /**
   * The earth-centred, earth-fixed coordinates of a point of the local frame of this place.
   *
   * @param enuMeters metres to the east, north and up
   * @return x, y, z
   */
  public double[] ecefFromEnu(double[] enuMeters) {
    double[] values = Struct.checked(enuMeters, 3, "enuMeters").clone();
    Native.check(Native.ecefFromEnu(values(), values));
    return values;
  }

  /**
   * UTC as Unix time of a GPS time.
   *
   * @param timeGpsNanos since 1980-01-06 without leap seconds; years 1980 to 2099
   * @return nanoseconds since 1970-01-01, days of 86,400 s
   */
  public static long unixFromGps(long timeGpsNanos) {
    long[] out = new long[1];
    Native.check(Native.unixFromGps(timeGpsNanos, out));
    return out[0];
  }

  /**
   * GPS time of UTC as Unix time.
   *
   * @param timeUnixNanos since 1970-01-01, days of 86,400 s; years 1980 to 2099
   * @return nanoseconds since 1980-01-06 without leap seconds
   */
  public static long gpsFromUnix(long timeUnixNanos) {
    long[] out = new long[1];
    Native.check(Native.gpsFromUnix(timeUnixNanos, out));
    return out[0];
  }

  /**
   * WGS 84 latitude.
   *
   * @return degrees
   */
  public double getLatitudeDegrees() {
    return latitudeDegrees;
  }

  /**
   * WGS 84 longitude.
   *
   * @return degrees
   */
  public double getLongitudeDegrees() {
    return longitudeDegrees;
  }

  /**
   * Height above the ellipsoid.
   *
   * @return metres
   */
  public double getHeightMeters() {
    return heightMeters;
  }

  /**
   * For people: such as "48.2000000, 16.3700000, 180.0 m".
   *
   * @return a line; its form may change
   */
  @Override
  public String toString() {
    return String.format(
        Locale.ROOT, "%.7f, %.7f, %.1f m", latitudeDegrees, longitudeDegrees, heightMeters);
  }

  private double[] values() {
    return new double[] {latitudeDegrees, longitudeDegrees, heightMeters};
  }
}
