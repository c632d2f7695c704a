package io.lodemark.android;

import android.location.GnssClock;
import android.location.GnssMeasurement;
import android.location.GnssMeasurementsEvent;
import android.os.Build;
import io.lodemark.GnssEpoch;

/**
 * GnssMeasurementsEvents, value by value into epochs. A value that is not finite is one that the
 * receiver does not know, whatever its has... method says.
 */
final class GnssEvents {
  private static final int LONGEST_CODE_TYPE = 7;

  private GnssEvents() {}

  /** The time since boot of an event that arrived at a time since boot. */
  static long bootNanos(GnssClock clock, long arrivalNanos) {
    return clock.hasElapsedRealtimeNanos() ? clock.getElapsedRealtimeNanos() : arrivalNanos;
  }

  /** Forgets what the epoch held. */
  static void fill(GnssMeasurementsEvent event, GnssEpoch epoch) {
    epoch.clear();
    fillClock(event.getClock(), epoch);
    for (GnssMeasurement measurement : event.getMeasurements()) {
      if (finite(measurement.getTimeOffsetNanos()))
        fillMeasurement(measurement, epoch.add());
    }
  }

  private static void fillClock(GnssClock clock, GnssEpoch epoch) {
    epoch.setTimeNanos(clock.getTimeNanos())
        .setHardwareClockDiscontinuityCount(clock.getHardwareClockDiscontinuityCount());
    if (clock.hasLeapSecond())
      epoch.setLeapSecond(clock.getLeapSecond());
    if (clock.hasTimeUncertaintyNanos() && finite(clock.getTimeUncertaintyNanos()))
      epoch.setTimeUncertaintyNanos(clock.getTimeUncertaintyNanos());
    if (clock.hasFullBiasNanos())
      epoch.setFullBiasNanos(clock.getFullBiasNanos());
    if (clock.hasBiasNanos() && finite(clock.getBiasNanos()))
      epoch.setBiasNanos(clock.getBiasNanos());
    if (clock.hasBiasUncertaintyNanos() && finite(clock.getBiasUncertaintyNanos()))
      epoch.setBiasUncertaintyNanos(clock.getBiasUncertaintyNanos());
    if (clock.hasDriftNanosPerSecond() && finite(clock.getDriftNanosPerSecond()))
      epoch.setDriftNanosPerSecond(clock.getDriftNanosPerSecond());
    if (clock.hasDriftUncertaintyNanosPerSecond()
        && finite(clock.getDriftUncertaintyNanosPerSecond()))
      epoch.setDriftUncertaintyNanosPerSecond(clock.getDriftUncertaintyNanosPerSecond());
    if (clock.hasElapsedRealtimeNanos())
      epoch.setElapsedRealtimeNanos(clock.getElapsedRealtimeNanos());
  }

  // Android's deprecated measurements are those that older receivers give.
  @SuppressWarnings("deprecation")
  private static void fillMeasurement(GnssMeasurement from, io.lodemark.GnssMeasurement to) {
    to.setSvid(from.getSvid())
        .setConstellationType(from.getConstellationType())
        .setState(from.getState())
        .setReceivedSvTimeNanos(from.getReceivedSvTimeNanos())
        .setReceivedSvTimeUncertaintyNanos(from.getReceivedSvTimeUncertaintyNanos())
        .setTimeOffsetNanos(from.getTimeOffsetNanos())
        .setAccumulatedDeltaRangeState(from.getAccumulatedDeltaRangeState())
        .setMultipathIndicator(from.getMultipathIndicator());
    if (finite(from.getCn0DbHz()))
      to.setCn0DbHz(from.getCn0DbHz());
    if (finite(from.getPseudorangeRateMetersPerSecond()))
      to.setPseudorangeRateMetersPerSecond(from.getPseudorangeRateMetersPerSecond());
    if (finite(from.getPseudorangeRateUncertaintyMetersPerSecond()))
      to.setPseudorangeRateUncertaintyMetersPerSecond(
          from.getPseudorangeRateUncertaintyMetersPerSecond());
    if (finite(from.getAccumulatedDeltaRangeMeters()))
      to.setAccumulatedDeltaRangeMeters(from.getAccumulatedDeltaRangeMeters());
    if (finite(from.getAccumulatedDeltaRangeUncertaintyMeters()))
      to.setAccumulatedDeltaRangeUncertaintyMeters(
          from.getAccumulatedDeltaRangeUncertaintyMeters());
    if (from.hasCarrierFrequencyHz() && finite(from.getCarrierFrequencyHz()))
      to.setCarrierFrequencyHz(from.getCarrierFrequencyHz());
    if (from.hasSnrInDb() && finite(from.getSnrInDb()))
      to.setSnrInDb(from.getSnrInDb());
    if (from.hasAutomaticGainControlLevelDb() && finite(from.getAutomaticGainControlLevelDb()))
      to.setAutomaticGainControlLevelDb(from.getAutomaticGainControlLevelDb());
    if (from.hasCodeType() && from.getCodeType().length() <= LONGEST_CODE_TYPE)
      to.setCodeType(from.getCodeType());
    if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.R)
      fillFromAndroid11(from, to);
  }

  private static void fillFromAndroid11(GnssMeasurement from, io.lodemark.GnssMeasurement to) {
    if (from.hasBasebandCn0DbHz() && finite(from.getBasebandCn0DbHz()))
      to.setBasebandCn0DbHz(from.getBasebandCn0DbHz());
    if (from.hasFullInterSignalBiasNanos() && finite(from.getFullInterSignalBiasNanos()))
      to.setFullInterSignalBiasNanos(from.getFullInterSignalBiasNanos());
    if (from.hasSatelliteInterSignalBiasNanos() && finite(from.getSatelliteInterSignalBiasNanos()))
      to.setSatelliteInterSignalBiasNanos(from.getSatelliteInterSignalBiasNanos());
  }

  static boolean finite(double value) {
    return !Double.isNaN(value) && !Double.isInfinite(value);
  }
}
