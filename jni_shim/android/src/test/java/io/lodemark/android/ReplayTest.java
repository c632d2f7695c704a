package io.lodemark.android;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertTrue;

import android.content.Context;
import io.lodemark.PositioningSession;
import io.lodemark.TimeBase;
import java.io.File;
import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
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
  private void feed(Path log, Path navigation, Path recording) throws IOException {
    Context context = RuntimeEnvironment.getApplication();
    byte[] orbits = navigation == null ? null : Files.readAllBytes(navigation);
    try (PositioningSession session = PositioningSession.builder().timeBase(TimeBase.BOOT).open();
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
      }, feed::onNavigationMessage);
      feed.stop();
      FeedCounts counts = feed.getCounts();
      assertEquals(
          counts.toString(), counts.getGiven(FeedKind.EPOCH), counts.getUsed(FeedKind.EPOCH));
      assertEquals(0, counts.getDropped(FeedKind.EPOCH));
      assertEquals(0, counts.getDropped(FeedKind.MESSAGE));
    }
  }

  private void checkAgainstReplay(Path log, Path navigation) throws Exception {
    File folder = this.folder.newFolder();
    Path again = folder.toPath().resolve("again");
    feed(log, navigation, again);
    List<String[]> rows = navigation == null
        ? Recorded.replay(folder.toPath().resolve("run"), "--log", log.toString())
        : Recorded.replay(folder.toPath().resolve("run"), "--log", log.toString(), "--nav",
              navigation.toString());
    fixes.assertAre(rows);
    List<String[]> rowsAgain =
        Recorded.replay(folder.toPath().resolve("run_again"), again.toString());
    fixes.assertAre(rowsAgain);
    assertTrue(rows.size() > 10);
  }

  @Test
  public void theSimulatedWalk() throws Exception {
    Path walk = Recorded.ROOT.resolve("sample_logs/walk");
    checkAgainstReplay(walk.resolve("gnss_log.txt"), walk.resolve("navigation.rnx"));
  }

  @Test
  public void anEarlyPhoneOnASurveyedPoint() throws Exception {
    Path demo = Recorded.recording("gnss/google_demo_20160822");
    checkAgainstReplay(
        demo.resolve("pseudoranges_log_2016_08_22_14_45_50.txt.gz"), demo.resolve("hour2350.16n"));
  }

  @Test
  public void aPhoneThatHeardItsOrbitsItself() throws Exception {
    Path perth = Recorded.recording("gnss/s8_perth_20171005");
    checkAgainstReplay(perth.resolve("SensorLog20171005.txt.gz"), null);
  }
}
