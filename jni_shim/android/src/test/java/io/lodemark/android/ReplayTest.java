package io.lodemark.android;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertTrue;

import android.content.Context;
import io.lodemark.Estimate;
import io.lodemark.Estimator;
import io.lodemark.PositioningSession;
import io.lodemark.TimeBase;
import java.io.File;
import java.io.IOException;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import org.junit.Rule;
import org.junit.Test;
import org.junit.rules.TemporaryFolder;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.RuntimeEnvironment;
import org.robolectric.annotation.Config;

/**
 * Epochs as the framework gives them lead where a replay of their log leads, and so does the log.
 */
@RunWith(RobolectricTestRunner.class)
@Config(sdk = 34, manifest = Config.NONE)
public class ReplayTest {
  @Rule public final TemporaryFolder folder = new TemporaryFolder();

  private final FedFixes fixes = new FedFixes();

  /** Feeds every row of a log, and records it again. */
  private void feed(Path log, Path navigation, Path recording, Estimator estimator)
      throws IOException {
    Context context = RuntimeEnvironment.getApplication();
    byte[] orbits = navigation == null ? null : Files.readAllBytes(navigation);
    try (PositioningSession session =
             PositioningSession.builder().timeBase(TimeBase.BOOT).estimator(estimator).open();
        GnssLogWriter writer = GnssLogWriter.create(recording.toFile(), orbits);
        SensorFeed feed = SensorFeed.builder(context, session)
            .withoutCallbacks()
            .listener(fixes)
            .log(writer)
            .build()) {
      if (orbits != null)
        session.pushNavigation("navigation", orbits);
      feed.start();
      LoggedEvents.read(log, event -> {
        feed.onGnssMeasurements(event);
        fixes.await();
      }, feed::onNavigationMessage, feed::onSample);
      feed.stop();
      FeedCounts counts = feed.getCounts();
      assertEquals(
          counts.toString(), counts.getGiven(FeedKind.EPOCH), counts.getUsed(FeedKind.EPOCH));
      assertEquals(0, counts.getDropped(FeedKind.EPOCH));
      assertEquals(0, counts.getDropped(FeedKind.MESSAGE));
      assertEquals(
          counts.toString(), counts.getGiven(FeedKind.SAMPLE), counts.getUsed(FeedKind.SAMPLE));
    }
  }

  private void checkAgainstReplay(Path log, Path navigation, Estimator estimator) throws Exception {
    File folder = this.folder.newFolder();
    Path again = folder.toPath().resolve("again");
    feed(log, navigation, again, estimator);
    List<String> words = new ArrayList<>();
    words.addAll(Arrays.asList(
        "--scheme", estimator == Estimator.FILTER ? "ekf-imu" : "gnss", "--log", log.toString()));
    if (navigation != null)
      words.addAll(Arrays.asList("--nav", navigation.toString()));
    List<String[]> rows =
        Recorded.replay(folder.toPath().resolve("run"), words.toArray(new String[0]));
    assertTrue(rows.size() > 10);
    fixes.assertAre(rows);
    fixes.assertAre(Recorded.replay(
        folder.toPath().resolve("run_again"), again.toString(), words.get(0), words.get(1)));
  }

  /** Round corners, by which it is found out how the inertial sensors are turned. */
  @Test
  public void aWalkWithInertialSensors() throws Exception {
    Path scenario = folder.getRoot().toPath().resolve("walk.json");
    Path walk = folder.getRoot().toPath().resolve("walk");
    String text = "{'name': 'walk', 'duration_s': 60, 'pause_s': 0, 'speed_mps': 1.6, 'seed': 5, "
        + "'sensor_rate_hz': 100, 'waypoints_m': [[0, 0], [30, 0], [30, 25], [60, 25], [60, 60]]}";
    Files.write(scenario, text.replace('\'', '"').getBytes(StandardCharsets.UTF_8));
    Recorded.command("simulate", scenario.toString(), "--out", walk.toString());
    checkAgainstReplay(
        walk.resolve("gnss_log.txt"), walk.resolve("navigation.rnx"), Estimator.FILTER);
    int carried = 0;
    for (Estimate position : fixes.positions()) carried += position.isFromInertialSensors() ? 1 : 0;
    assertTrue("inertial sensors carried " + carried, carried > 20);
  }

  @Test
  public void theSimulatedWalk() throws Exception {
    Path walk = Recorded.ROOT.resolve("sample_logs/walk");
    checkAgainstReplay(
        walk.resolve("gnss_log.txt"), walk.resolve("navigation.rnx"), Estimator.EPOCH);
  }

  @Test
  public void anEarlyPhoneOnASurveyedPoint() throws Exception {
    Path demo = Recorded.recording("gnss/google_demo_20160822");
    checkAgainstReplay(demo.resolve("pseudoranges_log_2016_08_22_14_45_50.txt.gz"),
        demo.resolve("hour2350.16n"), Estimator.EPOCH);
  }

  @Test
  public void aPhoneThatHeardItsOrbitsItself() throws Exception {
    Path perth = Recorded.recording("gnss/s8_perth_20171005");
    checkAgainstReplay(perth.resolve("SensorLog20171005.txt.gz"), null, Estimator.EPOCH);
  }
}
