package io.lodemark;

import java.io.IOException;
import java.io.UncheckedIOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;

/** What the tests feed: the epoch of docs/examples/first_fix.c, and the sample recording. */
final class Recorded {
  static final Path ROOT = Paths.get(System.getProperty("lodemark.root", "../.."));
  static final Path WALK = ROOT.resolve("sample_logs/walk");
  static final double LATITUDE = 48.2;
  static final double LONGITUDE = 16.37;

  private static final double[][] RECEIVED = {
      {2, 302999920235427L, 0.499, -400.373},
      {3, 302999921679493L, 0.454, 658.096},
      {6, 302999931899385L, 0.621, -164.564},
      {9, 302999923248862L, 0.769, -538.227},
      {10, 302999926202563L, 0.971, 478.888},
      {13, 302999931960432L, 0.807, -78.684},
      {17, 302999921365961L, 0.539, 102.413},
  };

  private Recorded() {}

  static byte[] read(Path path) {
    try {
      return Files.readAllBytes(path);
    } catch (IOException cause) {
      throw new UncheckedIOException(cause);
    }
  }

  static byte[] orbits() {
    return read(ROOT.resolve("docs/examples/first_fix.rnx"));
  }

  /** That of the example. */
  static GnssEpoch fill(GnssEpoch epoch) {
    epoch.clear()
        .setTimeNanos(605000000000L)
        .setFullBiasNanos(-1402228795000000000L)
        .setBiasNanos(0)
        .setElapsedRealtimeNanos(7000000000L);
    for (double[] row : RECEIVED) {
      epoch.add()
          .setSvid((int) row[0])
          .setConstellationType(1)
          .setState(1 | 2 | 4 | 8)
          .setReceivedSvTimeNanos((long) row[1])
          .setReceivedSvTimeUncertaintyNanos(10)
          .setTimeOffsetNanos(row[2])
          .setPseudorangeRateMetersPerSecond(row[3])
          .setPseudorangeRateUncertaintyMetersPerSecond(0.05)
          .setCn0DbHz(45);
    }
    return epoch;
  }

  /** A session for that epoch, which was simulated without an atmosphere. */
  static SessionBuilder builder() {
    return PositioningSession.builder().ionosphere(Ionosphere.NONE).troposphere(Troposphere.NONE);
  }

  static PositioningSession session() {
    PositioningSession session = builder().open();
    session.pushNavigation("first_fix.rnx", orbits());
    return session;
  }
}
