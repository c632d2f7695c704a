package io.lodemark.android;

import android.hardware.Sensor;
import android.location.GnssClock;
import android.location.GnssMeasurement;
import android.location.GnssMeasurementsEvent;
import android.location.GnssNavigationMessage;
import java.io.BufferedReader;
import java.io.IOException;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import java.util.function.Consumer;

/** The framework's objects, with the values of a log's rows, in the order of the log. */
final class LoggedEvents {
  private static final int MILLION = 1_000_000;

  private final Consumer<GnssMeasurementsEvent> epochs;
  private final Consumer<GnssNavigationMessage> messages;
  private final Samples samples;
  private List<String> columns = new ArrayList<>();
  private String[] row;
  private GnssClock clock;
  private final List<GnssMeasurement> measurements = new ArrayList<>();

  /** Of inertial rows. */
  interface Samples {
    void take(int sensorType, long timestamp, float[] values);
  }

  private LoggedEvents(Consumer<GnssMeasurementsEvent> epochs,
      Consumer<GnssNavigationMessage> messages, Samples samples) {
    this.samples = samples;
    this.epochs = epochs;
    this.messages = messages;
  }

  static void read(Path log, Consumer<GnssMeasurementsEvent> epochs,
      Consumer<GnssNavigationMessage> messages) throws IOException {
    read(log, epochs, messages, (type, timestamp, values) -> {});
  }

  static void read(Path log, Consumer<GnssMeasurementsEvent> epochs,
      Consumer<GnssNavigationMessage> messages, Samples samples) throws IOException {
    LoggedEvents events = new LoggedEvents(epochs, messages, samples);
    try (BufferedReader lines = Recorded.open(log)) {
      for (String line = lines.readLine(); line != null; line = lines.readLine()) events.take(line);
    }
    events.finishEpoch();
  }

  private void take(String line) {
    if (line.startsWith("#") && line.contains("Raw,")) {
      columns = Arrays.asList(line.replaceAll("[# ]", "").split(","));
    } else if (line.startsWith("Raw,")) {
      row = line.split(",", -1);
      GnssClock next = clock();
      if (clock != null
          && (next.getTimeNanos() != clock.getTimeNanos()
              || next.getFullBiasNanos() != clock.getFullBiasNanos()))
        finishEpoch();
      if (clock == null)
        clock = next;
      measurements.add(measurement());
    } else if (line.startsWith("Nav,")) {
      messages.accept(message(line.trim().split(",")));
    } else if (line.startsWith("UncalAccel,")) {
      sample(Sensor.TYPE_ACCELEROMETER_UNCALIBRATED, line.trim().split(","));
    } else if (line.startsWith("UncalGyro,")) {
      sample(Sensor.TYPE_GYROSCOPE_UNCALIBRATED, line.trim().split(","));
    }
  }

  private void sample(int type, String[] cells) {
    float[] values = new float[cells.length - 3];
    for (int i = 0; i < values.length; ++i) values[i] = Float.parseFloat(cells[3 + i]);
    samples.take(type, Long.parseLong(cells[2]), values);
  }

  private void finishEpoch() {
    if (clock == null)
      return;
    epochs.accept(
        new GnssMeasurementsEvent.Builder().setClock(clock).setMeasurements(measurements).build());
    clock = null;
    measurements.clear();
  }

  private String text(String column) {
    int at = columns.indexOf(column);
    return at < 0 || at >= row.length ? "" : row[at].trim();
  }

  private boolean has(String column) {
    return !text(column).isEmpty() && !text(column).equals("NaN");
  }

  private double number(String column) {
    return has(column) ? Double.parseDouble(text(column)) : 0;
  }

  private long whole(String column) {
    return has(column) ? Long.parseLong(text(column)) : 0;
  }

  private GnssClock clock() {
    GnssClock to = new GnssClock();
    to.setTimeNanos(whole("TimeNanos"));
    to.setHardwareClockDiscontinuityCount((int) whole("HardwareClockDiscontinuityCount"));
    if (has("LeapSecond"))
      to.setLeapSecond((int) whole("LeapSecond"));
    if (has("TimeUncertaintyNanos"))
      to.setTimeUncertaintyNanos(number("TimeUncertaintyNanos"));
    if (has("FullBiasNanos"))
      to.setFullBiasNanos(whole("FullBiasNanos"));
    if (has("BiasNanos"))
      to.setBiasNanos(number("BiasNanos"));
    if (has("BiasUncertaintyNanos"))
      to.setBiasUncertaintyNanos(number("BiasUncertaintyNanos"));
    if (has("DriftNanosPerSecond"))
      to.setDriftNanosPerSecond(number("DriftNanosPerSecond"));
    if (has("DriftUncertaintyNanosPerSecond"))
      to.setDriftUncertaintyNanosPerSecond(number("DriftUncertaintyNanosPerSecond"));
    if (has("ChipsetElapsedRealtimeNanos")) {
      to.setElapsedRealtimeNanos(whole("ChipsetElapsedRealtimeNanos"));
    } else if (has("ElapsedRealtimeMillis")) {
      to.setElapsedRealtimeNanos(whole("ElapsedRealtimeMillis") * MILLION);
    }
    return to;
  }

  @SuppressWarnings("deprecation")
  private GnssMeasurement measurement() {
    GnssMeasurement to = new GnssMeasurement();
    to.setSvid((int) whole("Svid"));
    to.setConstellationType((int) whole("ConstellationType"));
    to.setTimeOffsetNanos(number("TimeOffsetNanos"));
    to.setState((int) whole("State"));
    to.setReceivedSvTimeNanos(whole("ReceivedSvTimeNanos"));
    to.setReceivedSvTimeUncertaintyNanos(whole("ReceivedSvTimeUncertaintyNanos"));
    to.setCn0DbHz(number("Cn0DbHz"));
    to.setPseudorangeRateMetersPerSecond(number("PseudorangeRateMetersPerSecond"));
    to.setPseudorangeRateUncertaintyMetersPerSecond(
        number("PseudorangeRateUncertaintyMetersPerSecond"));
    to.setAccumulatedDeltaRangeState((int) whole("AccumulatedDeltaRangeState"));
    to.setAccumulatedDeltaRangeMeters(number("AccumulatedDeltaRangeMeters"));
    to.setAccumulatedDeltaRangeUncertaintyMeters(number("AccumulatedDeltaRangeUncertaintyMeters"));
    to.setMultipathIndicator((int) whole("MultipathIndicator"));
    if (has("CarrierFrequencyHz"))
      to.setCarrierFrequencyHz((float) number("CarrierFrequencyHz"));
    if (has("SnrInDb"))
      to.setSnrInDb(number("SnrInDb"));
    if (has("AgcDb"))
      to.setAutomaticGainControlLevelInDb(number("AgcDb"));
    if (has("BasebandCn0DbHz"))
      to.setBasebandCn0DbHz(number("BasebandCn0DbHz"));
    if (has("FullInterSignalBiasNanos"))
      to.setFullInterSignalBiasNanos(number("FullInterSignalBiasNanos"));
    if (has("SatelliteInterSignalBiasNanos"))
      to.setSatelliteInterSignalBiasNanos(number("SatelliteInterSignalBiasNanos"));
    if (has("CodeType"))
      to.setCodeType(text("CodeType"));
    return to;
  }

  private static GnssNavigationMessage message(String[] cells) {
    GnssNavigationMessage to = new GnssNavigationMessage();
    to.setSvid(Integer.parseInt(cells[1]));
    to.setType(Integer.parseInt(cells[2]));
    to.setStatus(Integer.parseInt(cells[3]));
    to.setMessageId(Integer.parseInt(cells[4]));
    to.setSubmessageId(Integer.parseInt(cells[5]));
    byte[] data = new byte[cells.length - 6];
    for (int i = 0; i < data.length; ++i) data[i] = (byte) Integer.parseInt(cells[6 + i].trim());
    to.setData(data);
    return to;
  }
}
