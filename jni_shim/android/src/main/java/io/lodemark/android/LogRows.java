package io.lodemark.android;

import android.hardware.Sensor;
import android.location.GnssClock;
import android.location.GnssMeasurement;
import android.location.GnssMeasurementsEvent;
import android.location.GnssNavigationMessage;
import android.os.Build;

/**
 * Rows of GnssLogger's text. Numbers have all their digits, so that they are read as what they
 * were; what the receiver does not know is an empty field.
 */
final class LogRows {
  private static final String RAW = "Raw,utcTimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,"
      + "FullBiasNanos,BiasNanos,BiasUncertaintyNanos,DriftNanosPerSecond,"
      + "DriftUncertaintyNanosPerSecond,HardwareClockDiscontinuityCount,Svid,TimeOffsetNanos,"
      + "State,ReceivedSvTimeNanos,ReceivedSvTimeUncertaintyNanos,Cn0DbHz,"
      + "PseudorangeRateMetersPerSecond,PseudorangeRateUncertaintyMetersPerSecond,"
      + "AccumulatedDeltaRangeState,AccumulatedDeltaRangeMeters,"
      + "AccumulatedDeltaRangeUncertaintyMeters,CarrierFrequencyHz,CarrierCycles,CarrierPhase,"
      + "CarrierPhaseUncertainty,MultipathIndicator,SnrInDb,ConstellationType,AgcDb,"
      + "BasebandCn0DbHz,FullInterSignalBiasNanos,FullInterSignalBiasUncertaintyNanos,"
      + "SatelliteInterSignalBiasNanos,SatelliteInterSignalBiasUncertaintyNanos,CodeType,"
      + "ChipsetElapsedRealtimeNanos";
  private static final String[] HEADERS = {RAW,
      "Nav,Svid,Type,Status,MessageId,Sub-messageId,Data(Bytes)",
      "UncalAccel,utcTimeMillis,elapsedRealtimeNanos,UncalAccelXMps2,UncalAccelYMps2,"
          + "UncalAccelZMps2,BiasXMps2,BiasYMps2,BiasZMps2",
      "UncalGyro,utcTimeMillis,elapsedRealtimeNanos,UncalGyroXRadPerSec,UncalGyroYRadPerSec,"
          + "UncalGyroZRadPerSec,DriftXRadPerSec,DriftYRadPerSec,DriftZRadPerSec",
      "Pressure,utcTimeMillis,elapsedRealtimeNanos,PressureHpa",
      "GameRotationVector,utcTimeMillis,elapsedRealtimeNanos,x,y,z,w"};

  private final StringBuilder row = new StringBuilder(512);
  private final StringBuilder clockCells = new StringBuilder(192);

  static String header() {
    StringBuilder text = new StringBuilder("# \n# Header Description:\n# \n# Version: v3.1.0.0");
    text.append(" Platform: ").append(Build.VERSION.RELEASE);
    text.append(" Manufacturer: ").append(Build.MANUFACTURER);
    text.append(" Model: ").append(Build.MODEL).append("\n# \n");
    text.append("# Written by lodemark\n# \n");
    for (String header : HEADERS) text.append("# ").append(header).append("\n# \n");
    return text.toString();
  }

  /** A row for each measurement. */
  String epoch(GnssMeasurementsEvent event, long bootNanos, long unixMillis) {
    row.setLength(0);
    fillClock(event.getClock());
    for (GnssMeasurement measurement : event.getMeasurements()) {
      if (!GnssEvents.finite(measurement.getTimeOffsetNanos()))
        continue; // not fed either
      row.append("Raw,").append(unixMillis).append(',').append(clockCells);
      measurement(measurement);
      row.append(bootNanos).append('\n');
    }
    return row.toString();
  }

  String message(GnssNavigationMessage message) {
    row.setLength(0);
    row.append("Nav,").append(message.getSvid()).append(',').append(message.getType());
    row.append(',').append(message.getStatus()).append(',').append(message.getMessageId());
    row.append(',').append(message.getSubmessageId());
    for (byte value : message.getData()) row.append(',').append(value);
    return row.append('\n').toString();
  }

  /** Null for a sensor that has no row. */
  String sample(Sample sample, long unixMillis) {
    row.setLength(0);
    int count;
    switch (sample.sensorType) {
      case Sensor.TYPE_ACCELEROMETER_UNCALIBRATED:
        row.append("UncalAccel");
        count = 6;
        break;
      case Sensor.TYPE_GYROSCOPE_UNCALIBRATED:
        row.append("UncalGyro");
        count = 6;
        break;
      case Sensor.TYPE_PRESSURE:
        row.append("Pressure");
        count = 1;
        break;
      case Sensor.TYPE_GAME_ROTATION_VECTOR:
        row.append("GameRotationVector");
        count = 4;
        break;
      default:
        return null;
    }
    row.append(',').append(unixMillis).append(',').append(sample.bootNanos);
    for (int i = 0; i < count; ++i) {
      row.append(',');
      if (i < sample.count)
        row.append((double) sample.values[i]);
    }
    return row.append('\n').toString();
  }

  private void fillClock(GnssClock clock) {
    StringBuilder to = clockCells;
    to.setLength(0);
    to.append(clock.getTimeNanos()).append(',');
    if (clock.hasLeapSecond())
      to.append(clock.getLeapSecond());
    to.append(',');
    cell(to, clock.hasTimeUncertaintyNanos(), clock.getTimeUncertaintyNanos());
    if (clock.hasFullBiasNanos())
      to.append(clock.getFullBiasNanos());
    to.append(',');
    cell(to, clock.hasBiasNanos(), clock.getBiasNanos());
    cell(to, clock.hasBiasUncertaintyNanos(), clock.getBiasUncertaintyNanos());
    cell(to, clock.hasDriftNanosPerSecond(), clock.getDriftNanosPerSecond());
    cell(to, clock.hasDriftUncertaintyNanosPerSecond(), clock.getDriftUncertaintyNanosPerSecond());
    to.append(clock.getHardwareClockDiscontinuityCount()).append(',');
  }

  // Android's deprecated measurements are those that older receivers give.
  @SuppressWarnings("deprecation")
  private void measurement(GnssMeasurement m) {
    boolean newer = Build.VERSION.SDK_INT >= Build.VERSION_CODES.R;
    row.append(m.getSvid()).append(',');
    cell(row, true, m.getTimeOffsetNanos());
    row.append(m.getState()).append(',').append(m.getReceivedSvTimeNanos()).append(',');
    row.append(m.getReceivedSvTimeUncertaintyNanos()).append(',');
    cell(row, true, m.getCn0DbHz());
    cell(row, true, m.getPseudorangeRateMetersPerSecond());
    cell(row, true, m.getPseudorangeRateUncertaintyMetersPerSecond());
    row.append(m.getAccumulatedDeltaRangeState()).append(',');
    cell(row, true, m.getAccumulatedDeltaRangeMeters());
    cell(row, true, m.getAccumulatedDeltaRangeUncertaintyMeters());
    cell(row, m.hasCarrierFrequencyHz(), m.getCarrierFrequencyHz());
    if (m.hasCarrierCycles())
      row.append(m.getCarrierCycles());
    row.append(',');
    cell(row, m.hasCarrierPhase(), m.getCarrierPhase());
    cell(row, m.hasCarrierPhaseUncertainty(), m.getCarrierPhaseUncertainty());
    row.append(m.getMultipathIndicator()).append(',');
    cell(row, m.hasSnrInDb(), m.getSnrInDb());
    row.append(m.getConstellationType()).append(',');
    cell(row, m.hasAutomaticGainControlLevelDb(), m.getAutomaticGainControlLevelDb());
    cell(row, newer && m.hasBasebandCn0DbHz(), newer ? m.getBasebandCn0DbHz() : 0);
    cell(
        row, newer && m.hasFullInterSignalBiasNanos(), newer ? m.getFullInterSignalBiasNanos() : 0);
    cell(row, newer && m.hasFullInterSignalBiasUncertaintyNanos(),
        newer ? m.getFullInterSignalBiasUncertaintyNanos() : 0);
    cell(row, newer && m.hasSatelliteInterSignalBiasNanos(),
        newer ? m.getSatelliteInterSignalBiasNanos() : 0);
    cell(row, newer && m.hasSatelliteInterSignalBiasUncertaintyNanos(),
        newer ? m.getSatelliteInterSignalBiasUncertaintyNanos() : 0);
    if (m.hasCodeType())
      row.append(m.getCodeType());
    row.append(',');
  }

  /** A float is written as the double it is, not as the shortest text that a float is read from. */
  private static void cell(StringBuilder to, boolean known, double value) {
    if (known && GnssEvents.finite(value))
      to.append(value);
    to.append(',');
  }
}
