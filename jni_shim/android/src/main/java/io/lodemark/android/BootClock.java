package io.lodemark.android;

import android.location.GnssClock;

/**
 * GPS time of moments that are told by the time since boot, from the latest epoch of satellites.
 */
final class BootClock {
  private long gpsMinusBootNanos;
  private boolean known;

  /** Learns from a receiver's clock that was read at a time since boot. */
  void learn(GnssClock clock, long bootNanos) {
    if (!clock.hasFullBiasNanos())
      return;
    double biasNanos = clock.hasBiasNanos() ? clock.getBiasNanos() : 0.0;
    long gpsNanos = clock.getTimeNanos() - clock.getFullBiasNanos() - Math.round(biasNanos);
    gpsMinusBootNanos = gpsNanos - bootNanos;
    known = true;
  }

  boolean isKnown() {
    return known;
  }

  long gpsNanos(long bootNanos) {
    return bootNanos + gpsMinusBootNanos;
  }
}
