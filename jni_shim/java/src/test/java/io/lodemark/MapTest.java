package io.lodemark;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;
import static org.junit.jupiter.api.Assumptions.assumeTrue;

import java.awt.image.BufferedImage;
import java.awt.image.Raster;
import java.io.File;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;
import java.util.List;
import javax.imageio.ImageIO;
import org.junit.jupiter.api.BeforeAll;
import org.junit.jupiter.api.Test;
import org.junit.jupiter.api.io.TempDir;

/** Photographs of the simulated square, looked up in a map that the command makes of others. */
class MapTest {
  private static final Path SQUARE = Recorded.ROOT.resolve("sample_logs/square");
  private static final Geodetic ORIGIN = new Geodetic(30.5287, 114.3561, 24.0);
  private static final String PHOTO = "0003.jpg";
  private static final Lens LENS =
      Lens.brown(1280, 960, 1012.4, 1011.6, 643.2, 476.8, 0.112, -0.238, 0.0006, -0.0004, 0.121);

  @TempDir static Path folder;
  private static Path mapFile;
  private static ByteBuffer pixels;

  @BeforeAll
  static void makeMap() throws IOException, InterruptedException {
    Path command = Paths.get(System.getProperty("lodemark.command", "none"));
    assumeTrue(Files.isExecutable(command), "the command lodemark was not built");
    mapFile = folder.resolve("square.map");
    Process process = new ProcessBuilder(command.toString(), "map", "build", "--images",
        SQUARE.resolve("database").toString(), "--poses",
        SQUARE.resolve("database/poses.csv").toString(), "--camera",
        SQUARE.resolve("database/camera.json").toString(), "--buildings",
        SQUARE.resolve("buildings.geojson").toString(), "--origin", "30.5287,114.3561,24.0",
        "--out", mapFile.toString())
                          .redirectErrorStream(true)
                          .redirectOutput(new File(folder.toFile(), "map.log"))
                          .start();
    assertEquals(0, process.waitFor());
    pixels = gray(ImageIO.read(SQUARE.resolve("cam0").resolve(PHOTO).toFile()));
  }

  /** The luma of a photograph, which of these grey ones is any of its bands. */
  private static ByteBuffer gray(BufferedImage photo) {
    Raster raster = photo.getRaster();
    ByteBuffer pixels = ByteBuffer.allocateDirect(photo.getWidth() * photo.getHeight());
    for (int y = 0; y < photo.getHeight(); ++y) {
      for (int x = 0; x < photo.getWidth(); ++x) {
        pixels.put((byte) raster.getSample(x, y, raster.getNumBands() > 1 ? 1 : 0));
      }
    }
    pixels.rewind();
    return pixels;
  }

  private static CameraImage image() {
    return new CameraImage(LENS, pixels, 1280).setTimeNanos(1399860006000000000L);
  }

  /** How far a place is from where the simulated camera stood. */
  private static double distanceFromTruth(double[] ecef) throws IOException {
    for (String line : Files.readAllLines(SQUARE.resolve("cam0/poses.csv"))) {
      String[] cells = line.split(",");
      if (!cells[0].equals(PHOTO))
        continue;
      double[] enu = ORIGIN.enuFromEcef(ecef);
      double sum = 0;
      for (int i = 0; i < 3; ++i) sum += Math.pow(enu[i] - Double.parseDouble(cells[8 + i]), 2);
      return Math.sqrt(sum);
    }
    throw new AssertionError("no pose of " + PHOTO);
  }

  @Test
  void aPhotographIsLocated() throws IOException {
    try (FeatureMap map = FeatureMap.open(mapFile)) {
      assertTrue(map.getInfo().getLandmarks() > 1000);
      assertEquals(14, map.getInfo().getBuildingParts());
      assertEquals(32, map.getInfo().getId().length());
      Pose pose = map.locate(image(), null);
      assertTrue(pose.hasPosition());
      assertTrue(distanceFromTruth(pose.getEcefMeters()) < 0.5);

      List<Sight> sights = map.query(image(), null);
      assertTrue(sights.size() > 50);
      assertEquals(3, sights.get(0).getLandmarkInEcef().length);
      assertTrue(sights.get(0).getPixel()[0] > -1);
      Pose again = Resection.resect(LENS, sights, null);
      assertTrue(distanceFromTruth(again.getEcefMeters()) < 0.5);

      ViewPrior near =
          new ViewPrior()
              .setPosition(pose.getEcefMeters(), new double[] {9, 0, 0, 0, 9, 0, 0, 0, 9})
              .setHeading(pose.getHeadingDegrees(), 10);
      assertTrue(map.locate(image(), near).hasPosition());
      assertThrows(
          LodemarkException.class, () -> map.locate(image(), new ViewPrior().setHeading(1, 1)));
      assertThrows(NullPointerException.class, () -> map.locate(null, null));
    }
  }

  @Test
  void aPhotographOfNothingIsNotLocated() {
    try (FeatureMap map = FeatureMap.open(mapFile)) {
      CameraImage black = new CameraImage(LENS, ByteBuffer.allocateDirect(1280 * 960), 1280);
      assertFalse(map.locate(black, null).hasPosition());
      assertTrue(map.query(black, null).isEmpty());
    }
  }

  private static void fixFromPhotograph(PositioningSession session) {
    session.pushImage(image().setHeading(40, 20));
    assertTrue(session.process());
    Estimate estimate = session.estimate();
    assertTrue(estimate.hasPosition());
    assertTrue(estimate.isFromLandmarks());
    assertFalse(estimate.isFromSatellites());
    assertEquals(PhotoOutcome.USED, estimate.getPhoto());
    assertTrue(estimate.getLandmarksUsed() > 20);
    assertTrue(estimate.hasOrientation());
    List<LandmarkStatus> landmarks = session.landmarks();
    assertEquals(estimate.getLandmarksSeen(), landmarks.size());
    assertTrue(landmarks.stream().anyMatch(seen -> seen.getVerdict() == Verdict.USED));
  }

  @Test
  void aSessionKeepsTheMapThatItUses() throws IOException {
    FeatureMap map = FeatureMap.open(mapFile);
    PositioningSession session = PositioningSession.open();
    session.useMap(map);
    session.useMap(map);
    map.close();
    map.close();
    assertThrows(IllegalStateException.class, map::getInfo);
    assertThrows(IllegalStateException.class, () -> session.useMap(map));
    fixFromPhotograph(session);
    assertTrue(distanceFromTruth(session.estimate().getEcefMeters()) < 0.5);
    session.useMap(null);
    assertThrows(LodemarkException.class, () -> session.pushImage(image()));
    session.close();
  }

  @Test
  void sessionsInTwoThreadsShareAMap() throws InterruptedException {
    try (FeatureMap map = FeatureMap.open(mapFile); FeatureMap other = FeatureMap.open(mapFile)) {
      Runnable work = () -> {
        try (PositioningSession session = PositioningSession.open()) {
          for (int i = 0; i < 200; ++i) session.useMap(i % 2 == 0 ? other : map);
          fixFromPhotograph(session);
        }
      };
      ThreadsTest.run(List.of(work, work, () -> assertTrue(map.getInfo().getImages() > 0)));
    }
  }
}
