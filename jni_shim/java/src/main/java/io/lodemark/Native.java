package io.lodemark;

import java.nio.ByteBuffer;
import java.nio.charset.StandardCharsets;

/**
 * The natives: each calls the one function of lodemark.h that it is named after. Structs and bulk
 * data cross in direct buffers, strings as UTF-8 bytes, results that are no struct in arrays of one
 * element.
 */
final class Native {
  static {
    NativeLibrary.load();
  }

  private Native() {}

  static native byte[] version();

  static native byte[] statusName(int status);

  static native byte[] lastError();

  static native byte[] layout();

  static native int ecefFromGeodetic(double[] values);

  static native int geodeticFromEcef(double[] values);

  static native int enuFromEcef(double[] originGeodetic, double[] values);

  static native int ecefFromEnu(double[] originGeodetic, double[] values);

  static native int unixFromGps(long timeGpsNs, long[] out);

  static native int gpsFromUnix(long timeUnixNs, long[] out);

  static native int positionSolve(
      ByteBuffer ranges, int count, ByteBuffer options, ByteBuffer solution, ByteBuffer residuals);

  static native int lensUnproject(
      ByteBuffer lens, ByteBuffer pixels, int count, ByteBuffer directions, ByteBuffer valid);

  static native int lensProject(
      ByteBuffer lens, ByteBuffer points, int count, ByteBuffer pixels, ByteBuffer valid);

  static native int lensUndistortPoints(
      ByteBuffer lens, ByteBuffer pixels, int count, ByteBuffer undistorted, ByteBuffer valid);

  static native int undistortionOpen(
      ByteBuffer lens, ByteBuffer target, ByteBuffer usedTarget, long[] out);

  static native void undistortionClose(long undistortion);

  static native int undistortionApply(long undistortion, ByteBuffer pixels, long size,
      long strideBytes, ByteBuffer out, long outSize, long outStrideBytes);

  static native int poseResect(ByteBuffer lens, ByteBuffer sights, int count, ByteBuffer prior,
      ByteBuffer pose, ByteBuffer residuals);

  static native int mapOpen(byte[] path, long[] out);

  static native void mapClose(long map);

  static native int mapReadInfo(long map, ByteBuffer info);

  static native int mapQuery(long map, ByteBuffer lens, ByteBuffer pixels, long size,
      long strideBytes, ByteBuffer prior, ByteBuffer out, int capacity, int[] total);

  static native int mapLocate(long map, ByteBuffer lens, ByteBuffer pixels, long size,
      long strideBytes, ByteBuffer prior, ByteBuffer pose);

  static native int sessionOpen(ByteBuffer options, long[] out);

  static native void sessionClose(long session);

  static native int sessionReset(long session);

  static native int sessionPushGnss(
      long session, long timeNs, ByteBuffer clock, ByteBuffer measurements, int count);

  static native int sessionPushNavigation(
      long session, byte[] name, ByteBuffer bytes, long size, ByteBuffer report);

  static native int sessionPushPreciseOrbits(
      long session, byte[] name, ByteBuffer bytes, long size, ByteBuffer report);

  static native int sessionPushBroadcast(
      long session, ByteBuffer message, ByteBuffer bytes, int size);

  static native int sessionUseMap(long session, long map);

  static native int sessionPushImage(long session, ByteBuffer frame, ByteBuffer lens,
      ByteBuffer pixels, long size, long strideBytes);

  static native int sessionPushSensors(long session, ByteBuffer samples, int count);

  static native int sessionProcess(long session);

  static native int sessionQueued(long session, int[] out);

  static native int sessionEstimate(long session, ByteBuffer estimate);

  static native int sessionSmoothed(long session, ByteBuffer out, int capacity, int[] total);

  static native int sessionSatellites(long session, ByteBuffer out, int capacity, int[] total);

  static native int sessionLandmarks(long session, ByteBuffer out, int capacity, int[] total);

  static native int sessionEvents(long session, ByteBuffer out, int capacity, int[] total);

  static native int sessionClearEvents(long session);

  static native int logOpen(byte[] path, long[] out);

  static native void logClose(long log);

  static native int logPushNext(long log, long session);

  /** Passes on a status that is none of an error, and throws what an error's says. */
  static int check(int status) {
    if (status < 0)
      throw failure(status);
    return status;
  }

  /** What the library says of the error that this thread has just met. */
  static LodemarkException failure(int status) {
    return new LodemarkException(status, text(lastError()));
  }

  static String text(byte[] utf8) {
    return new String(utf8, StandardCharsets.UTF_8);
  }

  /** A string for C, which ends it with a zero of its own: one within it would cut it short. */
  static byte[] bytes(String text, String what) {
    if (text.indexOf('\0') >= 0)
      throw new IllegalArgumentException(what + " contains a zero");
    return text.getBytes(StandardCharsets.UTF_8);
  }
}
