package io.lodemark;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.nio.ByteBuffer;
import java.nio.file.Paths;
import java.util.List;
import org.junit.jupiter.api.Test;

/** Sessions, used well and badly. */
class SessionTest {
  private static LodemarkException.Status refusal(Runnable call) {
    LodemarkException refused = assertThrows(LodemarkException.class, call::run);
    assertFalse(refused.getMessage().isEmpty());
    return refused.getStatus();
  }

  @Test
  void anEpochGivesAFix() {
    try (PositioningSession session = Recorded.session()) {
      assertEquals(Outcome.NO_DATA, session.estimate().getOutcome());
      assertFalse(session.process());
      session.pushGnss(Recorded.fill(new GnssEpoch()));
      assertEquals(1, session.queued());
      assertTrue(session.process());
      assertFalse(session.process());

      Estimate estimate = session.estimate();
      assertTrue(estimate.hasPosition());
      assertEquals(Outcome.FIX, estimate.getOutcome());
      assertEquals(Recorded.LATITUDE, estimate.getLatitudeDegrees(), 1e-5);
      assertEquals(Recorded.LONGITUDE, estimate.getLongitudeDegrees(), 1e-5);
      assertEquals(180.0, estimate.getHeightMeters(), 1.0);
      assertEquals(7, estimate.getSatellitesUsed());
      assertTrue(estimate.hasVelocity());
      assertEquals(9, estimate.getCovarianceEnu().length);
      assertTrue(estimate.isFromSatellites());
      assertFalse(estimate.isFromLandmarks());
      assertEquals(PhotoOutcome.NONE, estimate.getPhoto());
      assertTrue(estimate.toString().startsWith("48.200"));

      List<SatelliteStatus> satellites = session.satellites();
      assertEquals(7, satellites.size());
      assertEquals(SatelliteSystem.GPS, satellites.get(0).getSystem());
      assertEquals('G', satellites.get(0).getSystem().getLetter());
      assertEquals("1C", satellites.get(0).getSignal());
      assertEquals(Verdict.USED, satellites.get(0).getVerdict());
      assertEquals(45.0, satellites.get(0).getCn0DbHz());
      assertTrue(session.landmarks().isEmpty());

      List<SessionEvent> events = session.takeEvents();
      assertEquals(SessionEvent.Kind.FIRST_FIX, events.get(0).getKind());
      assertFalse(events.get(0).getText().isEmpty());
      assertTrue(session.takeEvents().isEmpty());

      session.reset();
      assertEquals(Outcome.NO_DATA, session.estimate().getOutcome());
    }
  }

  @Test
  void aSessionOnBootTimeTellsItsTimes() {
    try (PositioningSession session =
             Recorded.builder().timeBase(TimeBase.BOOT).systems(SatelliteSystem.GPS).open()) {
      assertEquals(TimeBase.BOOT, session.getTimeBase());
      ReadReport report = session.pushNavigation("first_fix.rnx", Recorded.orbits());
      assertTrue(report.getRowsRead() >= 7);
      assertEquals("", report.getFirstProblem());
      GnssEpoch epoch = new GnssEpoch();
      session.pushGnss(Recorded.fill(epoch));
      assertTrue(session.process());
      assertEquals(7000000000L, session.estimate().getTimeNanos());
      assertTrue(session.estimate().hasGpsTime());
      assertEquals(1402229400e9, session.estimate().getTimeGpsNanos(), 1e9);
      session.pushGnss(9000000000L, Recorded.fill(epoch)); // reused
      assertTrue(session.process());
      assertEquals(9000000000L, session.estimate().getTimeNanos());
    }
  }

  @Test
  void aSmootherTellsEveryEstimateAgain() {
    try (PositioningSession session = Recorded.builder().estimator(Estimator.SMOOTHER).open();
        GnssLog log = GnssLog.open(Recorded.WALK.resolve("gnss_log.txt"))) {
      session.pushNavigation(
          "navigation.rnx", Recorded.read(Recorded.WALK.resolve("navigation.rnx")));
      assertTrue(session.smoothed().isEmpty());
      int estimates = 0;
      for (; estimates < 20 && log.pushNext(session); ++estimates) session.process();
      List<Estimate> smoothed = session.smoothed();
      assertEquals(estimates, smoothed.size());
      assertEquals(
          session.estimate().getTimeGpsNanos(), smoothed.get(estimates - 1).getTimeGpsNanos());
      assertTrue(smoothed.get(0).hasPosition());
    }
  }

  @Test
  void anEpochKeepsItsValuesAsItGrows() {
    GnssEpoch epoch = new GnssEpoch();
    for (int i = 0; i < 4096; ++i) epoch.add().setSvid(i).setCodeType("C");
    assertThrows(IllegalStateException.class, epoch::add);
    assertEquals(4096, epoch.size());
    for (int i = 0; i < 4096; ++i) {
      int at = i * Layout.GnssMeasurement.SIZE;
      assertEquals(Layout.GnssMeasurement.SIZE, epoch.rows().getInt(at));
      assertEquals(i, epoch.rows().getInt(at + Layout.GnssMeasurement.SVID));
    }
    GnssMeasurement first = epoch.clear().add();
    assertEquals(0, epoch.rows().getInt(Layout.GnssMeasurement.PRESENT));
    assertThrows(IllegalArgumentException.class, () -> first.setCodeType("12345678"));
    assertThrows(NullPointerException.class, () -> first.setCodeType(null));
    try (PositioningSession session = Recorded.session()) {
      session.pushGnss(epoch);
      session.process();
      assertFalse(session.estimate().hasPosition());
    }
  }

  @Test
  void garbageIsRefusedAndNamed() {
    try (PositioningSession session = PositioningSession.open()) {
      GnssEpoch epoch = Recorded.fill(new GnssEpoch());
      epoch.add().setCn0DbHz(Double.NaN);
      LodemarkException refused =
          assertThrows(LodemarkException.class, () -> session.pushGnss(epoch));
      assertTrue(refused.getMessage().contains("measurements[7].cn0_dbhz"), refused.getMessage());
      epoch.clear().setTimeNanos(Long.MAX_VALUE);
      assertEquals(
          LodemarkException.Status.INVALID_ARGUMENT, refusal(() -> session.pushGnss(epoch)));
      byte[] garbage = new byte[1000];
      assertEquals(LodemarkException.Status.BAD_DATA,
          refusal(() -> session.pushNavigation("noise", garbage)));
      assertEquals(LodemarkException.Status.BAD_DATA,
          refusal(() -> session.pushPreciseOrbits("noise", garbage)));
      refusal(() -> session.pushNavigation("nothing", new byte[0]));
      assertEquals(LodemarkException.Status.OUT_OF_ORDER,
          refusal(() -> session.pushBroadcast(257, 1, 1, 1, new byte[40])));
      refusal(() -> session.pushBroadcast(257, 1, 1, 1, new byte[0]));
      refusal(() -> session.pushBroadcast(257, 1, 1, 1, new byte[5000]));
    }
  }

  @Test
  void samplesOfSensorsAreTaken() {
    ImuBatch batch = new ImuBatch();
    for (int i = 0; i < 1000; ++i) {
      long timeNanos = 7_000_000_000L + i * 10_000_000L;
      batch.addAccelerometer(timeNanos, 0.1, 9.8, 0.2).addGyroscope(timeNanos, 0, 0, 0.1);
    }
    batch.addBarometer(7_000_000_000L, 1013.25).addVehicle(7_000_000_000L, 1.5, 0);
    assertEquals(2002, batch.size());
    for (int i = 0; i < batch.size(); ++i) {
      int at = i * Layout.SensorSample.SIZE;
      assertEquals(Layout.SensorSample.SIZE, batch.rows().getInt(at));
    }
    int last = 2001 * Layout.SensorSample.SIZE;
    assertEquals(Values.SENSOR_VEHICLE, batch.rows().getInt(last + Layout.SensorSample.SENSOR));
    assertEquals(1.5, batch.rows().getDouble(last + Layout.SensorSample.VALUE));
    try (PositioningSession session = Recorded.builder().timeBase(TimeBase.BOOT).open()) {
      session.pushImu(batch);
      assertTrue(session.takeEvents().isEmpty());
      session.pushImu(batch); // nothing of it is new
      assertEquals(SessionEvent.Kind.SENSOR_DROPPED, session.takeEvents().get(0).getKind());
      session.pushImu(batch.clear());
      batch.addGyroscope(20_000_000_000L, Double.NaN, 0, 0);
      assertEquals(
          LodemarkException.Status.INVALID_ARGUMENT, refusal(() -> session.pushImu(batch)));
      assertThrows(NullPointerException.class, () -> session.pushImu(null));
    }
    batch.clear();
    for (int i = 0; i < ImuBatch.LARGEST_SIZE; ++i) batch.addBarometer(i, 1000);
    assertThrows(IllegalStateException.class, () -> batch.addBarometer(0, 1000));
  }

  @Test
  void aFullQueueSaysSo() {
    try (PositioningSession session = Recorded.builder().queueCapacity(1).open()) {
      GnssEpoch epoch = Recorded.fill(new GnssEpoch());
      session.pushGnss(epoch);
      assertEquals(LodemarkException.Status.QUEUE_FULL, refusal(() -> session.pushGnss(epoch)));
    }
  }

  @Test
  void everyOptionIsTaken() {
    SessionBuilder builder = PositioningSession.builder()
                                 .systems(SatelliteSystem.GPS, SatelliteSystem.GALILEO)
                                 .scheme(Scheme.TIGHT)
                                 .estimator(Estimator.FILTER)
                                 .ionosphere(Ionosphere.CLIMATOLOGY)
                                 .troposphere(Troposphere.HOPFIELD)
                                 .weighting(Weighting.ELEVATION)
                                 .queueCapacity(7)
                                 .elevationMask(0)
                                 .smallestCn0(-5)
                                 .elevationModel(0.5, 0.7)
                                 .seed(9)
                                 .varianceComponents()
                                 .zenithDelay()
                                 .heightMemory()
                                 .fixedBiases()
                                 .acceptUnhealthy();
    builder.open().close();
    assertEquals(LodemarkException.Status.INVALID_ARGUMENT,
        refusal(() -> PositioningSession.builder().queueCapacity(-1).open()));
    assertEquals(LodemarkException.Status.INVALID_ARGUMENT,
        refusal(() -> PositioningSession.builder().elevationMask(Double.NaN).open()));
    assertEquals(LodemarkException.Status.UNSUPPORTED,
        refusal(() -> PositioningSession.builder().systems(SatelliteSystem.UNKNOWN).open()));
    assertThrows(IllegalArgumentException.class, () -> PositioningSession.builder().systems());
    assertThrows(NullPointerException.class, () -> PositioningSession.builder().scheme(null));
  }

  @Test
  void nullIsRefusedInJava() {
    try (PositioningSession session = PositioningSession.open()) {
      assertThrows(NullPointerException.class, () -> session.pushGnss(null));
      assertThrows(NullPointerException.class, () -> session.pushImage(null));
      assertThrows(NullPointerException.class, () -> session.pushNavigation(null, new byte[1]));
      assertThrows(
          NullPointerException.class, () -> session.pushNavigation("a", (ByteBuffer) null));
      assertThrows(NullPointerException.class, () -> session.pushBroadcast(1, 1, 1, 1, null));
      assertThrows(
          IllegalArgumentException.class, () -> session.pushNavigation("a\0b", new byte[1]));
      assertThrows(IllegalArgumentException.class,
          () -> session.pushNavigation("heap", ByteBuffer.allocate(9)));
      session.useMap(null);
    }
    assertThrows(NullPointerException.class, () -> FeatureMap.open(null));
    assertThrows(NullPointerException.class, () -> GnssLog.open(null));
  }

  @Test
  void nothingWorksAfterCloseAndClosingTwiceIsHarmless() {
    PositioningSession session = PositioningSession.open();
    session.close();
    session.close();
    GnssEpoch epoch = new GnssEpoch();
    CameraImage image =
        new CameraImage(Lens.pinhole(8, 8, 8, 8, 4, 4), ByteBuffer.allocateDirect(64), 8);
    Runnable[] calls = {
        ()
            -> session.pushGnss(epoch),
        ()
            -> session.pushNavigation("a", new byte[1]),
        ()
            -> session.pushPreciseOrbits("a", new byte[1]),
        ()
            -> session.pushBroadcast(1, 1, 1, 1, new byte[1]),
        ()
            -> session.pushImage(image),
        ()
            -> session.useMap(null),
        session::process,
        session::queued,
        session::estimate,
        session::satellites,
        session::landmarks,
        session::smoothed,
        session::takeEvents,
        session::reset,
    };
    for (Runnable call : calls) assertThrows(IllegalStateException.class, call::run);

    GnssLog log = GnssLog.open(Recorded.WALK.resolve("gnss_log.txt"));
    assertThrows(IllegalStateException.class, () -> log.pushNext(session));
    log.close();
    log.close();
    try (PositioningSession open = PositioningSession.open()) {
      assertThrows(IllegalStateException.class, () -> log.pushNext(open));
    }
  }

  @Test
  void filesThatAreNoneAreNamed() {
    LodemarkException refused =
        assertThrows(LodemarkException.class, () -> FeatureMap.open(Paths.get("no", "such.map")));
    assertTrue(refused.getMessage().contains("such.map"), refused.getMessage());
    assertThrows(
        LodemarkException.class, () -> FeatureMap.open(Recorded.WALK.resolve("gnss_log.txt")));
    assertEquals(
        LodemarkException.Status.IO, refusal(() -> GnssLog.open(Paths.get("n\u00f6 such log"))));
    try (PositioningSession session = PositioningSession.open();
        GnssLog log = GnssLog.open(Recorded.WALK.resolve("truth.csv"))) {
      assertEquals(LodemarkException.Status.BAD_DATA, refusal(() -> log.pushNext(session)));
    }
  }

  @Test
  void imagesAreCheckedForTheirSize() {
    Lens lens = Lens.pinhole(64, 48, 60, 60, 31.5, 23.5);
    ByteBuffer pixels = ByteBuffer.allocateDirect(64 * 48);
    assertThrows(IllegalArgumentException.class,
        () -> new CameraImage(lens, ByteBuffer.allocateDirect(64 * 48 - 1), 64));
    assertThrows(
        IllegalArgumentException.class, () -> new CameraImage(lens, ByteBuffer.allocate(3072), 64));
    assertThrows(IllegalArgumentException.class, () -> new CameraImage(lens, pixels, 65));
    assertThrows(
        IllegalArgumentException.class, () -> new CameraImage(lens, pixels, Long.MAX_VALUE));
    assertThrows(NullPointerException.class, () -> new CameraImage(null, pixels, 64));
    assertThrows(NullPointerException.class, () -> new CameraImage(lens, null, 64));
    CameraImage image = new CameraImage(lens, pixels, 64)
                            .setTimeNanos(5)
                            .setGravity(new double[] {0, -9.8, 0}, 2)
                            .setHeading(90, 10);
    assertThrows(IllegalArgumentException.class, () -> image.setGravity(new double[2], 2));
    assertThrows(
        IllegalArgumentException.class, () -> image.setCameraFromDevice(new double[] {0, 0, 1}));
    assertThrows(NullPointerException.class, () -> image.setCameraFromDevice(null));
    try (PositioningSession session = PositioningSession.open()) {
      assertEquals(LodemarkException.Status.OUT_OF_ORDER, refusal(() -> session.pushImage(image)));
      image.setCameraFromDevice(new double[] {0, 1, -1, 0}); // no unit quaternion
      assertEquals(
          LodemarkException.Status.INVALID_ARGUMENT, refusal(() -> session.pushImage(image)));
      image.setCameraFromDevice(new double[] {0, Math.sqrt(0.5), -Math.sqrt(0.5), 0});
      assertEquals(LodemarkException.Status.OUT_OF_ORDER, refusal(() -> session.pushImage(image)));
    }
  }

  @Test
  void theLibraryTellsItsVersion() {
    assertTrue(Lodemark.version().matches("\\d+\\.\\d+\\.\\d+"));
  }
}
