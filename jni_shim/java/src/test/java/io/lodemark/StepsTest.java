package io.lodemark;

import static org.junit.jupiter.api.Assertions.assertArrayEquals;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.nio.ByteBuffer;
import java.util.ArrayList;
import java.util.List;
import org.junit.jupiter.api.Test;

/** The steps that need no session. */
class StepsTest {
  private static final Geodetic VIENNA = new Geodetic(48.2, 16.37, 180.0);

  @Test
  void placesGoToEcefAndBack() {
    // On the equator at longitude 0, the x axis leaves the ellipsoid at its semi-major axis.
    assertArrayEquals(new double[] {6378137.0, 0.0, 0.0}, new Geodetic(0, 0, 0).toEcef(), 1e-9);
    Geodetic back = Geodetic.fromEcef(VIENNA.toEcef());
    assertEquals(48.2, back.getLatitudeDegrees(), 1e-12);
    assertEquals(16.37, back.getLongitudeDegrees(), 1e-12);
    assertEquals(180.0, back.getHeightMeters(), 1e-8);
  }

  @Test
  void localFramesPointEastNorthUp() {
    double[] above = new Geodetic(48.2, 16.37, 190.0).toEcef();
    assertArrayEquals(new double[] {0, 0, 10}, VIENNA.enuFromEcef(above), 1e-8);
    double[] enu = {3, -4, 5};
    assertArrayEquals(enu, VIENNA.enuFromEcef(VIENNA.ecefFromEnu(enu)), 1e-8);
  }

  @Test
  void gpsTimeIsEighteenSecondsAheadOfUtc() {
    long epoch = 315964800000000000L; // 1980-01-06 as Unix time
    assertEquals(epoch, Geodetic.unixFromGps(0));
    long time = 1400000000000000000L;
    assertEquals(time + epoch - 18000000000L, Geodetic.unixFromGps(time));
    assertEquals(time, Geodetic.gpsFromUnix(Geodetic.unixFromGps(time)));
  }

  @Test
  void conversionsRefuseNonsense() {
    LodemarkException refused =
        assertThrows(LodemarkException.class, () -> new Geodetic(91, 0, 0).toEcef());
    assertEquals(LodemarkException.Status.INVALID_ARGUMENT, refused.getStatus());
    assertFalse(refused.getMessage().isEmpty());
    assertThrows(LodemarkException.class, () -> new Geodetic(Double.NaN, 0, 0).toEcef());
    assertThrows(LodemarkException.class, () -> Geodetic.unixFromGps(Long.MIN_VALUE));
    assertThrows(IllegalArgumentException.class, () -> Geodetic.fromEcef(new double[2]));
    assertThrows(IllegalArgumentException.class, () -> VIENNA.enuFromEcef(new double[4]));
    assertThrows(NullPointerException.class, () -> Geodetic.fromEcef(null));
    assertThrows(NullPointerException.class, () -> VIENNA.ecefFromEnu(null));
  }

  @Test
  void aPinholeLensIsPlainGeometry() {
    Lens lens = Lens.pinhole(640, 480, 500, 510, 320, 240);
    assertArrayEquals(new double[] {320 + 500 * 0.1, 240 - 510 * 0.2},
        lens.project(new double[] {1, -2, 10}), 1e-9);
    double[] directions = lens.unproject(new double[] {320, 240, 820, 240});
    assertArrayEquals(
        new double[] {0, 0, 1}, new double[] {directions[0], directions[1], directions[2]}, 1e-12);
    assertEquals(Math.sqrt(0.5), directions[3], 1e-12);
    assertTrue(Double.isNaN(lens.project(new double[] {0, 0, -1})[0]));
    assertEquals(0, lens.project(new double[0]).length);
  }

  @Test
  void undistortionUndoesDistortion() {
    Lens bent = Lens.brown(640, 480, 520, 520, 319.5, 239.5, 0.08, -0.05);
    Lens straight = Lens.pinhole(640, 480, 520, 520, 319.5, 239.5);
    double[] points = {0.3, 0.2, 1, -0.4, 0.1, 1};
    assertArrayEquals(straight.project(points), bent.undistort(bent.project(points)), 1e-6);
    assertEquals(18, bent.getIntrinsics().length);
    assertEquals(-0.05, bent.getIntrinsics()[5]);
  }

  @Test
  void lensesRefuseNonsense() {
    Lens none = Lens.pinhole(0, 480, 500, 500, 320, 240);
    assertThrows(LodemarkException.class, () -> none.unproject(new double[] {1, 1}));
    Lens nan = Lens.fisheye(640, 480, Double.NaN, 500, 320, 240, 0.1);
    assertThrows(LodemarkException.class, () -> nan.unproject(new double[] {1, 1}));
    Lens lens = Lens.thinPrismFisheye(640, 480, 500, 500, 320, 240);
    assertThrows(IllegalArgumentException.class, () -> lens.project(new double[4]));
    assertThrows(NullPointerException.class, () -> lens.project(null));
    assertThrows(IllegalArgumentException.class, () -> Lens.brown(640, 480, 500));
    assertThrows(IllegalArgumentException.class, () -> Lens.fisheye(640, 480, new double[9]));
  }

  @Test
  void photographsAreStraightened() {
    Lens lens = Lens.brown(64, 48, 60, 60, 31.5, 23.5, 0.1);
    Undistortion undistortion = Undistortion.open(lens);
    ByteBuffer photo = ByteBuffer.allocateDirect(64 * 48);
    for (int i = 0; i < photo.capacity(); ++i) photo.put(i, (byte) 77);
    ByteBuffer out = ByteBuffer.allocateDirect(64 * 48);
    undistortion.apply(photo, 64, out, 64);
    for (int i = 0; i < out.capacity(); ++i) assertEquals(77, out.get(i));
    assertEquals(64, undistortion.getTarget().getWidthPixels());

    ByteBuffer small = ByteBuffer.allocateDirect(64 * 48 - 1);
    ByteBuffer heap = ByteBuffer.allocate(64 * 48);
    assertThrows(IllegalArgumentException.class, () -> undistortion.apply(small, 64, out, 64));
    assertThrows(IllegalArgumentException.class, () -> undistortion.apply(photo, 64, small, 64));
    assertThrows(IllegalArgumentException.class, () -> undistortion.apply(heap, 64, out, 64));
    assertThrows(IllegalArgumentException.class,
        () -> undistortion.apply(photo, 64, out.asReadOnlyBuffer(), 64));
    assertThrows(IllegalArgumentException.class, () -> undistortion.apply(photo, -1, out, 64));
    assertThrows(LodemarkException.class, () -> undistortion.apply(photo, 1, out, 64));
    assertThrows(NullPointerException.class, () -> undistortion.apply(null, 64, out, 64));
    undistortion.close();
    undistortion.close();
    assertThrows(IllegalStateException.class, () -> undistortion.apply(photo, 64, out, 64));
    assertThrows(NullPointerException.class, () -> Undistortion.open(null));
    assertThrows(NullPointerException.class, () -> Undistortion.open(lens, null));
    assertThrows(LodemarkException.class, () -> Undistortion.open(lens, lens));
  }

  @Test
  void rangesToKnownPointsGiveAPosition() {
    double[][] points = {{20, 5, 1}, {-8, 30, 2}, {3, -25, 9}, {-30, -30, 12}, {40, 40, 20}};
    RangeSolver solver = new RangeSolver().setStart(VIENNA.ecefFromEnu(new double[] {2, 2, 2}));
    for (double[] enu : points) {
      double range = Math.sqrt(enu[0] * enu[0] + enu[1] * enu[1] + enu[2] * enu[2]);
      solver.add(VIENNA.ecefFromEnu(enu), range + 1234.5, 0.1, 3);
    }
    RangeSolver.Solution solution = solver.solve();
    assertEquals(Outcome.FIX, solution.getOutcome());
    assertEquals(48.2, solution.getPlace().getLatitudeDegrees(), 1e-8);
    assertEquals(1234.5, solution.getClockMeters(3), 1e-3);
    assertTrue(solution.isUsed(0));
    assertEquals(0.0, solution.getResidualMeters(4), 1e-3);
    assertThrows(IndexOutOfBoundsException.class, () -> solution.isUsed(5));
    assertThrows(IndexOutOfBoundsException.class, () -> solution.getClockMeters(0));
  }

  @Test
  void solversRefuseNonsense() {
    assertEquals(Outcome.TOO_FEW, new RangeSolver().solve().getOutcome());
    double[] point = VIENNA.toEcef();
    assertThrows(LodemarkException.class, () -> new RangeSolver().add(point, 1, -1, 0).solve());
    assertThrows(LodemarkException.class, () -> new RangeSolver().add(point, 1, 1, 17).solve());
    assertThrows(
        LodemarkException.class, () -> new RangeSolver().add(point, Double.NaN, 1, 0).solve());
    assertThrows(
        IllegalArgumentException.class, () -> new RangeSolver().add(new double[2], 1, 1, 0));
    RangeSolver full = new RangeSolver();
    for (int i = 0; i < 4096; ++i) full.add(point, 1, 1, 0);
    assertThrows(IllegalStateException.class, () -> full.add(point, 1, 1, 0));
  }

  @Test
  void sightsGiveAPose() {
    Lens lens = Lens.pinhole(640, 480, 500, 500, 320, 240);
    // A camera at the place that looks north: east is right, up is up, north is forward.
    List<Sight> sights = new ArrayList<>();
    for (int i = 0; i < 20; ++i) {
      double[] enu = {(i % 5) - 2, 10 + i % 3, (i / 5) - 1.5};
      double[] pixel = lens.project(new double[] {enu[0], -enu[2], enu[1]});
      sights.add(new Sight(pixel[0], pixel[1], VIENNA.ecefFromEnu(enu)));
    }
    Pose pose = Resection.resect(lens, sights, null);
    assertEquals(PoseVerdict.GOOD, pose.getVerdict());
    assertTrue(pose.hasPosition());
    assertEquals(48.2, pose.getLatitudeDegrees(), 1e-7);
    assertEquals(0.0, Math.IEEEremainder(pose.getHeadingDegrees(), 360.0), 1e-3);
    assertEquals(36, pose.getCovariance().length);
    Pose held =
        Resection.resect(lens, sights, new ViewPrior().setGravity(new double[] {0, -9.8, 0}, 1));
    assertTrue(held.hasPosition());

    assertEquals(
        PoseVerdict.TOO_FEW, Resection.resect(lens, sights.subList(0, 2), null).getVerdict());
    assertEquals(PoseVerdict.TOO_FEW, Resection.resect(lens, List.of(), null).getVerdict());
    assertThrows(LodemarkException.class,
        () -> Resection.resect(lens, sights, new ViewPrior().setHeading(400, -1)));
    assertThrows(NullPointerException.class, () -> Resection.resect(null, sights, null));
    assertThrows(NullPointerException.class, () -> Resection.resect(lens, null, null));
  }
}
