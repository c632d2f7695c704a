package io.lodemark.android;

import android.location.GnssMeasurementsEvent;
import android.location.GnssNavigationMessage;
import android.os.SystemClock;
import io.lodemark.Lens;
import java.io.BufferedOutputStream;
import java.io.BufferedWriter;
import java.io.Closeable;
import java.io.File;
import java.io.FileOutputStream;
import java.io.IOException;
import java.io.OutputStream;
import java.io.OutputStreamWriter;
import java.io.Writer;
import java.nio.ByteBuffer;
import java.nio.channels.FileChannel;
import java.nio.charset.StandardCharsets;
import java.util.Locale;

/**
 * Writes what a {@link SensorFeed} was given, as a recording: a folder with GnssLogger's text in
 * gnss_log.txt, photographs in cam0 and a manifest.json, to be copied to a desktop and given to
 * {@code lodemark replay FOLDER}, which then finds what the phone found. A recording says where its
 * user was: keep it where only the app can read it, and ask before it leaves the phone.
 *
 * <p>Photographs are written as plain grey pictures (PGM, a byte for each pixel) with the lens of
 * the first one; those of another size, or of a focal length that differs by more than a hundredth,
 * are left out, and so are those before the receiver knew the time. Used by one thread at a time.
 */
public final class GnssLogWriter implements Closeable {
  private static final double SAME_FOCAL_LENGTH = 0.01;
  private static final int MOST_WAITING = 1 << 16;

  private final File folder;
  private final Writer text;
  private final LogRows rows = new LogRows();
  private final BootClock clock = new BootClock();
  private final String navigationFile;
  private final StringBuilder messages = new StringBuilder();
  private Writer photographs;
  private Lens lens;
  private int photographCount;
  private int leftOut;

  private GnssLogWriter(File folder, Writer text, String navigationFile) {
    this.folder = folder;
    this.text = text;
    this.navigationFile = navigationFile;
  }

  /**
   * Begins a recording.
   *
   * @param folder is made; it must not hold a recording already
   * @return a writer, to be closed
   * @throws IOException if the folder cannot be written to, or holds a recording
   */
  public static GnssLogWriter create(File folder) throws IOException {
    return create(folder, null);
  }

  /**
   * Begins a recording that replays with ephemerides which the session got from elsewhere.
   *
   * @param folder is made; it must not hold a recording already
   * @param navigation the content of the RINEX file that was pushed; null if there was none
   * @return a writer, to be closed
   * @throws IOException if the folder cannot be written to, or holds a recording
   */
  public static GnssLogWriter create(File folder, byte[] navigation) throws IOException {
    File log = new File(folder, "gnss_log.txt");
    if (log.exists())
      throw new IOException(folder + " holds a recording already: choose another folder");
    if (!folder.isDirectory() && !folder.mkdirs())
      throw new IOException(folder + " cannot be made");
    String navigationFile = null;
    if (navigation != null) {
      navigationFile = "navigation.rnx";
      try (OutputStream out = new FileOutputStream(new File(folder, navigationFile))) {
        out.write(navigation);
      }
    }
    Writer text = open(log);
    text.write(LogRows.header());
    GnssLogWriter writer = new GnssLogWriter(folder, text, navigationFile);
    writer.writeManifest();
    return writer;
  }

  /**
   * An epoch, as rows Raw.
   *
   * @param event as the framework gave it
   * @param bootNanos its time since boot
   * @throws IOException if it cannot be written
   */
  public void write(GnssMeasurementsEvent event, long bootNanos) throws IOException {
    clock.learn(event.getClock(), bootNanos);
    text.write(rows.epoch(event, bootNanos, unixMillis(bootNanos)));
    writeMessages();
  }

  /**
   * A navigation message, as a row Nav, which comes after the rows of the next epoch: whoever reads
   * the log has an epoch when the next one begins, and the rows between them before it.
   *
   * @param message as the framework gave it
   * @throws IOException if it cannot be written
   */
  public void write(GnssNavigationMessage message) throws IOException {
    if (messages.length() > MOST_WAITING)
      writeMessages(); // no epoch comes
    messages.append(rows.message(message));
  }

  private void writeMessages() throws IOException {
    text.append(messages);
    messages.setLength(0);
  }

  /**
   * A sample, as a row UncalAccel, UncalGyro, Pressure or GameRotationVector; others are passed
   * over.
   *
   * @param sensorType Sensor.TYPE_...
   * @param bootNanos SensorEvent.timestamp
   * @param values SensorEvent.values
   * @throws IOException if it cannot be written
   */
  public void write(int sensorType, long bootNanos, float[] values) throws IOException {
    Sample sample = new Sample();
    sample.set(sensorType, bootNanos, values);
    write(sample);
  }

  void write(Sample sample) throws IOException {
    String row = rows.sample(sample, unixMillis(sample.bootNanos));
    if (row != null)
      text.write(row);
  }

  /**
   * A photograph, as a file in cam0 and a row of its list.
   *
   * @param pixels of the lens's size, a byte each, without gaps
   * @param lens that took it
   * @param bootNanos of the middle of its exposure
   * @param upInCamera what an accelerometer at rest measures, in camera axes; null if not known
   * @param upSigmaDegrees standard deviation of this direction
   * @return false if it was left out
   * @throws IOException if it cannot be written
   */
  public boolean write(ByteBuffer pixels, Lens lens, long bootNanos, double[] upInCamera,
      double upSigmaDegrees) throws IOException {
    if (!clock.isKnown() || (this.lens != null && !isAlike(lens))) {
      ++leftOut;
      return false;
    }
    if (this.lens == null)
      beginPhotographs(lens);
    String name = String.format(Locale.ROOT, "%06d.pgm", ++photographCount);
    File file = new File(new File(folder, "cam0/data"), name);
    String header = "P5\n" + lens.getWidthPixels() + " " + lens.getHeightPixels() + "\n255\n";
    try (FileOutputStream out = new FileOutputStream(file);
        FileChannel channel = out.getChannel()) {
      out.write(header.getBytes(StandardCharsets.US_ASCII));
      ByteBuffer rest = pixels.duplicate();
      while (rest.hasRemaining()) channel.write(rest);
    }
    StringBuilder row = new StringBuilder();
    row.append(clock.gpsNanos(bootNanos)).append(',').append(name);
    if (upInCamera != null) {
      for (double value : upInCamera) row.append(',').append(value);
      row.append(',').append(upSigmaDegrees);
    } else {
      row.append(",,,,");
    }
    photographs.write(row.append('\n').toString());
    return true;
  }

  /**
   * How many photographs were left out: of another lens than the first, or before the receiver knew
   * the time.
   *
   * @return their number
   */
  public int getPhotographsLeftOut() {
    return leftOut;
  }

  /**
   * A remark for people; replays pass it over.
   *
   * @param remark one line
   * @throws IOException if it cannot be written
   */
  public void writeRemark(String remark) throws IOException {
    text.write("# " + remark.replace('\n', ' ').replace('\r', ' ') + "\n");
  }

  /**
   * Hands all that was written to the system.
   *
   * @throws IOException if it cannot be written
   */
  public void flush() throws IOException {
    text.flush();
    if (photographs != null)
      photographs.flush();
  }

  @Override
  public void close() throws IOException {
    try {
      writeMessages();
    } finally {
      closeFiles();
    }
  }

  private void closeFiles() throws IOException {
    try {
      text.close();
    } finally {
      if (photographs != null)
        photographs.close();
    }
  }

  private void beginPhotographs(Lens first) throws IOException {
    File camera = new File(folder, "cam0");
    File data = new File(camera, "data");
    if (!data.isDirectory() && !data.mkdirs())
      throw new IOException(data + " cannot be made");
    try (Writer out = open(new File(camera, "camera.json"))) {
      out.write(first.toJson());
    }
    photographs = open(new File(camera, "data.csv"));
    photographs.write("time_gps_ns,filename,up_x,up_y,up_z,up_sigma_deg\n");
    lens = first;
    writeManifest();
  }

  private boolean isAlike(Lens other) {
    double focal = lens.getIntrinsics()[0];
    return other.getWidthPixels() == lens.getWidthPixels()
        && other.getHeightPixels() == lens.getHeightPixels()
        && Math.abs(other.getIntrinsics()[0] - focal) <= SAME_FOCAL_LENGTH * focal;
  }

  private void writeManifest() throws IOException {
    StringBuilder json = new StringBuilder("{\n  \"name\": \"");
    for (char c : folder.getName().toCharArray())
      json.append(c < ' ' || c == '"' || c == '\\' ? '_' : c);
    json.append("\",\n  \"files\": {\n    \"gnss_log\": \"gnss_log.txt\"");
    if (navigationFile != null)
      json.append(",\n    \"navigation\": \"").append(navigationFile).append('"');
    if (lens != null) {
      json.append(",\n    \"images\": \"cam0/data.csv\"");
      json.append(",\n    \"camera\": \"cam0/camera.json\"");
    }
    try (Writer out = open(new File(folder, "manifest.json"))) {
      out.write(json.append("\n  }\n}\n").toString());
    }
  }

  private static Writer open(File file) throws IOException {
    return new BufferedWriter(
        new OutputStreamWriter(
            new BufferedOutputStream(new FileOutputStream(file)), StandardCharsets.UTF_8),
        1 << 16);
  }

  private static long unixMillis(long bootNanos) {
    return System.currentTimeMillis()
        - (SystemClock.elapsedRealtimeNanos() - bootNanos) / 1_000_000;
  }
}
